#pragma once

#include <cstdint>
#include <vector>

#include "stages/import/soup.h"

namespace strake::import {

/// Which faces look the same way once their sheets are oriented, and which must not be joined as
/// the surface would have one side only.
class SheetSides {
 public:
  /// Sheets are joined by edges of two faces. Cost O(F log F).
  explicit SheetSides(const Soup& soup);

  /// Two faces beside each other.
  struct Joint {
    Index face;
    Index other;
    bool is_alike;  ///< they look the same way as they are
  };
  /// Joins sheets, all or none: none to one that has one side only, which is to be cut, and the
  /// cut would go farther.
  /// \return whether they keep two sides
  bool join(const std::vector<Joint>& joints);

 private:
  struct Side {
    Index sheet;
    bool is_turned;
  };
  [[nodiscard]] Side side_of(Index face) const;
  /// \return the sheet that is a part of the other now; kNone where they were one already
  Index unite(const Joint& joint);
  [[nodiscard]] bool agrees(const Joint& joint) const;

  std::vector<Index> above_;  ///< [F] the face that it is compared with; itself at a sheet
  std::vector<Index> size_;   ///< [F] faces of a sheet
  std::vector<std::uint8_t> is_turned_;     ///< [F] against the one above
  std::vector<std::uint8_t> is_one_sided_;  ///< [F] a sheet as it was given
};

}  // namespace strake::import
