#include "stages/size/closer_near.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>

#include "common/geometry/surface_distance/surface_distance.h"

namespace strake {
namespace {

constexpr double kReach = 2;  ///< in line distances

/// Collects faces around places.
class Neighbourhoods {
 public:
  explicit Neighbourhoods(const TriMesh& mesh) : mesh_(mesh), stamp_(mesh.face_count(), 0) {}

  /// The faces that are reached from one over edges within `reach` of a place.
  const std::vector<Index>& around(Index face, const Vec3& place, double reach) {
    ++current_;
    faces_.assign(1, face);
    stamp_[face] = current_;
    for (std::size_t at = 0; at < faces_.size(); ++at) {
      for (Index h = 3 * faces_[at]; h < 3 * faces_[at] + 3; ++h) {
        if (mesh_.twin[h] == kNone) continue;
        const Index other = TriMesh::face_of(mesh_.twin[h]);
        if (stamp_[other] == current_ || distance_to(other, place) > reach) continue;
        stamp_[other] = current_;
        faces_.push_back(other);
      }
    }
    return faces_;
  }

 private:
  [[nodiscard]] double distance_to(Index face, const Vec3& place) const {
    const auto& [a, b, c] = mesh_.faces[face];
    return closest_point_on_triangle(place, mesh_.positions[a], mesh_.positions[b],
                                     mesh_.positions[c])
        .distance;
  }

  const TriMesh& mesh_;
  std::vector<std::uint32_t> stamp_;  ///< [F] neighbourhood that the face was last part of
  std::uint32_t current_ = 0;
  std::vector<Index> faces_;
};

}  // namespace

SizeField used_distances(const LineSet& lines) {
  return {lines.mesh_id, lines.spacing_along_min, lines.spacing_along_max};
}

SizeField scaled_like(SizeField size, const SizeField& others) {
  double sum = 0;
  for (std::size_t w = 0; w < size.along.size(); ++w) {
    sum += std::log(others.along[w] / size.along[w]) + std::log(others.across[w] / size.across[w]);
  }
  const double scale = std::exp(sum / (2 * static_cast<double>(size.along.size())));
  for (auto* distances : {&size.along, &size.across}) {
    for (double& d : *distances) d *= scale;
  }
  return size;
}

SizeField closer_near(const TriMesh& mesh, const SizeField& wanted, const SizeField& used,
                      const std::vector<Vec3>& places, double factor) {
  const SurfaceDistance surface(mesh.positions, mesh.faces);
  Neighbourhoods neighbourhoods(mesh);
  std::vector<Index> wedges;
  for (const Vec3& place : places) {
    const Index face = surface.closest(place).triangle;
    double reach = 0;
    for (const Index w : mesh.face_wedges[face]) {
      reach = std::max({reach, kReach * used.along[w], kReach * used.across[w]});
    }
    const auto way = [&](Index w) { return (mesh.positions[mesh.wedge_vertex[w]] - place).norm(); };
    // Of large faces only what is near, but one corner at least: distances are those of corners.
    wedges.push_back(*std::ranges::min_element(mesh.face_wedges[face], {}, way));
    for (const Index f : neighbourhoods.around(face, place, reach)) {
      std::ranges::copy_if(mesh.face_wedges[f], std::back_inserter(wedges),
                           [&](Index w) { return way(w) <= reach; });
    }
  }
  std::sort(wedges.begin(), wedges.end());
  wedges.erase(std::unique(wedges.begin(), wedges.end()), wedges.end());
  SizeField size = wanted;
  for (const Index w : wedges) {
    size.along[w] = std::min(size.along[w], factor * used.along[w]);
    size.across[w] = std::min(size.across[w], factor * used.across[w]);
  }
  return size;
}

}  // namespace strake
