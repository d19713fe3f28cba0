#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "common/core/fields.h"
#include "common/core/tri_mesh.h"

namespace strake {

/// Which arms of the crosses at neighbouring wedges are the same direction.
///
/// Keys name the distances between lines at wedges: 2 w for the one measured along the cross of
/// wedge w, 2 w + 1 for the one across it.
class ArmBonds {
 public:
  ArmBonds(const TriMesh& mesh, const PrincipalField& field);

  /// The key of wedge w whose distance is measured along the arm that is closer to a direction.
  static Index key_along(const PrincipalField& field, Index w, const Vec3& direction);

  /// Bonds of wedge w, within its smooth piece of surface: first(w) .. first(w + 1) - 1.
  [[nodiscard]] Index first(Index w) const { return offsets_[w]; }
  [[nodiscard]] Index count() const { return static_cast<Index>(bonded_.size()); }
  /// The key at the other end of a bond of the key's wedge.
  [[nodiscard]] Index bonded(Index bond, Index key) const { return bonded_[bond] ^ (key & 1); }
  /// Length of a bond of wedge w on the surface. Computed when asked for: kept, they would be the
  /// largest part of this.
  [[nodiscard]] double length(Index bond, Index w) const {
    return (place_of(bonded_[bond] / 2) - place_of(w)).norm();
  }
  [[nodiscard]] double mean_length() const;

  /// Calls use(other key) for the keys of distances along the same feature line on its other side:
  /// they are the same, so that lines can cross it.
  template <class Use>
  void for_each_tied(Index key, const Use& use) const;

  /// The keys of one arm at the corners of a face; nothing where the crosses turn around in it.
  /// \param parity  key of the arm at the first corner: 0 along its cross, 1 across it
  [[nodiscard]] std::optional<std::array<Index, 3>> keys_in(Index face, Index parity) const;

 private:
  void find_turns(const PrincipalField& field);
  template <class Use>
  void for_each_bond(const Use& use) const;
  /// The half-edge of its edge, within a smooth piece of surface, that stands for both.
  [[nodiscard]] Index standing_for(Index h) const;

  [[nodiscard]] const Vec3& place_of(Index w) const {
    return mesh_.positions[mesh_.wedge_vertex[w]];
  }

  const TriMesh& mesh_;
  std::vector<char> turned_;    ///< [3F] whether the crosses at the ends of a half-edge are turned
                                ///< against each other; filled for those that stand for an edge
  std::vector<Index> offsets_;  ///< [W + 1] into the next
  std::vector<Index> bonded_;   ///< key of the other end for the first key of the wedge
  std::vector<std::pair<Index, Index>> ties_;  ///< ascending
};

template <class Use>
void ArmBonds::for_each_tied(Index key, const Use& use) const {
  auto tie = std::lower_bound(ties_.begin(), ties_.end(), std::pair{key, Index{0}});
  for (; tie != ties_.end() && tie->first == key; ++tie) use(tie->second);
}

}  // namespace strake
