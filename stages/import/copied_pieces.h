#pragma once

#include "stages/import/soup.h"

namespace strake::import {

/// Removes connected pieces that lie face on face in another one, all but the first of them: the
/// backs of double-sided sheets, which many exporters give vertices of their own. Joined along
/// their borders both sides would become a closed surface without thickness.
///
/// Pieces whose border is also that of a third one stay, as they are part of something larger, and
/// so do those of soups in which hardly any faces share vertices.
/// \pre no face repeats a corner
/// Cost O(F) where no two pieces are alike.
void drop_copied_pieces(Soup& soup, Repairs& repairs);

}  // namespace strake::import
