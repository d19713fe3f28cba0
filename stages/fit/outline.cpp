#include "stages/fit/outline.h"

#include <algorithm>

#include "common/geometry/poly_topology/face_shape.h"
#include "common/geometry/poly_topology/poly_edges.h"

namespace strake::fitting {
namespace {

/// Cells that an edge's distance counts for.
constexpr double kCells = 3;

}  // namespace

Outline::Outline(const PolyMesh& mesh, const VertexPlaces& places) : mesh_(mesh), places_(places) {
  const PolyEdges edges = collect_edges(mesh);
  for (Index e = 0; e < edges.edge_count(); ++e) {
    if (edges.sides_of(e).size() != 1) continue;
    const Index corner = edges.sides_of(e)[0];
    const Index face = edges.corner_face[corner];
    const Index next = mesh.next_corner(face, corner);
    edges_.push_back({{mesh.corners[corner], mesh.corners[next]}, face});
  }
}

/// Calls use(gap) for every vertex of the boundary between those of the result, or some of them.
template <class Use>
void Outline::for_gaps(const Use& use) const {
  const std::vector<Vec3>& p = places_.positions();
  for (const auto& [ends, face] : edges_) {
    const std::vector<Vec3> between = places_.boundary_between(ends[0], ends[1]);
    const double area = newell_normal(p, mesh_.face(face)).norm() / 2;
    const Vec3 edge = p[ends[1]] - p[ends[0]];
    const double square = edge.squaredNorm();
    if (!(square > 0)) continue;
    for (const Vec3& vertex : between) {
      const Vec3 from_start = vertex - p[ends[0]];
      const double share = std::clamp(from_start.dot(edge) / square, 0.0, 1.0);
      use(Gap{ends,
              {1 - share, share},
              from_start - share * edge,
              kCells * area / static_cast<double>(between.size())});
    }
  }
}

double Outline::cost() const {
  double sum = 0;
  for_gaps([&](const Gap& gap) { sum += gap.weight * gap.way.squaredNorm(); });
  return sum;
}

void Outline::add_to(BlockSystem& system) const {
  for_gaps([&](const Gap& gap) {
    const Vec3 along =
        (places_.positions()[gap.ends[1]] - places_.positions()[gap.ends[0]]).normalized();
    const Mat3 across = gap.weight * (Mat3::Identity() - along * along.transpose());
    for (int i = 0; i < 2; ++i) {
      system.add_right(gap.ends[i], gap.shares[i] * across * gap.way);
      for (int j = 0; j < 2; ++j) {
        system.add(gap.ends[i], gap.ends[j], gap.shares[i] * gap.shares[j] * across);
      }
    }
  });
}

}  // namespace strake::fitting
