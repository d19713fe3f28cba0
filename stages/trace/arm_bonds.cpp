#include "stages/trace/arm_bonds.h"

#include <tbb/parallel_for.h>

#include <cmath>

#include "common/geometry/frames.h"

namespace strake {

Index ArmBonds::key_along(const PrincipalField& field, Index w, const Vec3& direction) {
  const Vec3& n = field.normal[w];
  const Vec3 flat = direction - n * n.dot(direction);
  const double c = field.cross[w].dot(flat);
  return c * c >= 0.5 * flat.squaredNorm() ? 2 * w : 2 * w + 1;
}

ArmBonds::ArmBonds(const TriMesh& mesh, const PrincipalField& field) : mesh_(mesh) {
  find_turns(field);
  offsets_.assign(static_cast<std::size_t>(mesh.wedge_count()) + 1, 0);
  for_each_bond([&](Index w, Index, Index) { ++offsets_[w + 1]; });
  for (std::size_t w = 1; w < offsets_.size(); ++w) offsets_[w] += offsets_[w - 1];
  bonded_.resize(offsets_.back());
  std::vector<Index> fill(offsets_.begin(), offsets_.end() - 1);
  for_each_bond(
      [&](Index w, Index other, Index h) { bonded_[fill[w]++] = 2 * other + turned_[h]; });
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (mesh.is_feature[h] == 0) continue;
    const Vec3 edge = mesh.positions[mesh.to(h)] - mesh.positions[mesh.from(h)];
    const Index here = key_along(field, mesh.wedge_of(h), edge);
    const Index there = key_along(field, mesh.wedge_of(TriMesh::next(mesh.twin[h])), edge);
    ties_.emplace_back(here, there);
    ties_.emplace_back(there, here);
  }
  std::sort(ties_.begin(), ties_.end());
  // Inside a line both of its edges tie the same two.
  ties_.erase(std::unique(ties_.begin(), ties_.end()), ties_.end());
}

Index ArmBonds::standing_for(Index h) const {
  const Index twin = mesh_.twin[h];
  return twin != kNone && twin < h && mesh_.is_feature[h] == 0 ? twin : h;
}

void ArmBonds::find_turns(const PrincipalField& field) {
  turned_.resize(mesh_.halfedge_count());
  tbb::parallel_for(Index{0}, mesh_.halfedge_count(), [&](Index h) {
    if (standing_for(h) != h) return;
    const Index v = mesh_.wedge_of(h);
    const Index w = mesh_.wedge_of(TriMesh::next(h));
    const Vec3 arm = rotate_between(field.normal[v], field.normal[w], field.cross[v]);
    turned_[h] = std::abs(arm.dot(field.cross[w])) >= M_SQRT1_2 ? 0 : 1;
  });
}

/// Calls use(wedge, other wedge, half-edge) for all edges within a smooth piece of surface, once in
/// each direction.
template <class Use>
void ArmBonds::for_each_bond(const Use& use) const {
  for (Index h = 0; h < mesh_.halfedge_count(); ++h) {
    if (standing_for(h) != h) continue;
    const Index v = mesh_.wedge_of(h);
    const Index w = mesh_.wedge_of(TriMesh::next(h));
    use(v, w, h);
    use(w, v, h);
  }
}

double ArmBonds::mean_length() const {
  double sum = 0;
  for (Index w = 0; w + 1 < static_cast<Index>(offsets_.size()); ++w) {
    for (Index bond = first(w); bond < first(w + 1); ++bond) sum += length(bond, w);
  }
  return sum / std::max(1, count());
}

std::optional<std::array<Index, 3>> ArmBonds::keys_in(Index face, Index parity) const {
  const std::array<Index, 3>& w = mesh_.face_wedges[face];
  const auto turn = [&](Index corner) { return Index{turned_[standing_for(3 * face + corner)]}; };
  if ((turn(0) ^ turn(1) ^ turn(2)) != 0) return std::nullopt;
  return std::array{2 * w[0] + parity, 2 * w[1] + (parity ^ turn(0)),
                    2 * w[2] + (parity ^ turn(2))};
}

}  // namespace strake
