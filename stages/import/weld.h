#pragma once

#include "stages/import/soup.h"

namespace strake::import {

/// Joins pieces along border edges whose end points coincide, and closes holes of no extent.
///
/// Only edges with a single face take part, so what is closed already stays as it is, also where it
/// touches itself; points that merely touch are not joined. The tolerance is 1e-9 of the diagonal,
/// or 1e-6 where more than half of all edges have one face only (an unwelded soup).
/// Cost O(F + B log B) for B border edges.
void weld_borders(Soup& soup, double diagonal, Repairs& repairs);

}  // namespace strake::import
