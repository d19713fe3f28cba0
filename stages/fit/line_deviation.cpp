#include "stages/fit/line_deviation.h"

#include <algorithm>
#include <map>
#include <span>

#include "common/geometry/poly_topology/face_shape.h"
#include "common/geometry/poly_topology/poly_edges.h"

namespace strake::fitting {
namespace {

/// Cells that an edge's distance from its line counts for: on boundaries, and on features, which
/// faces beside them see as well.
constexpr double kCellsOnBoundary = 3;
constexpr double kCellsOnFeature = 1;

}  // namespace

LineDeviation::LineDeviation(const PolyMesh& mesh, const VertexPlaces& places)
    : mesh_(mesh), places_(places) {
  const PolyEdges edges = collect_edges(mesh);
  std::map<std::array<Index, 2>, Index> edge_of;
  for (Index e = 0; e < edges.edge_count(); ++e) {
    const auto& [a, b] = edges.vertices[e];
    if (!places.is_free(a) && !places.is_free(b)) edge_of[{std::min(a, b), std::max(a, b)}] = e;
  }
  for (const std::array<Index, 2>& ends : places.line_steps()) {
    const auto edge = edge_of.find(ends);
    if (edge == edge_of.end()) continue;
    const std::span<const Index> sides = edges.sides_of(edge->second);
    edges_.push_back({ends, edges.corner_face[sides[0]],
                      sides.size() == 1 ? kCellsOnBoundary : kCellsOnFeature});
  }
}

/// Calls use(gap) for every vertex of the lines between those of the result, or some of them.
template <class Use>
void LineDeviation::for_gaps(const Use& use) const {
  const std::vector<Vec3>& p = places_.positions();
  for (const auto& [ends, face, cells] : edges_) {
    const std::vector<Vec3> line = places_.line_between(ends[0], ends[1]);
    const double area = newell_normal(p, mesh_.face(face)).norm() / 2;
    const Vec3 edge = p[ends[1]] - p[ends[0]];
    const double square = edge.squaredNorm();
    if (!(square > 0)) continue;
    for (const Vec3& vertex : line) {
      const Vec3 from_start = vertex - p[ends[0]];
      const double share = std::clamp(from_start.dot(edge) / square, 0.0, 1.0);
      use(Gap{ends,
              {1 - share, share},
              from_start - share * edge,
              cells * area / static_cast<double>(line.size())});
    }
  }
}

double LineDeviation::cost() const {
  double sum = 0;
  for_gaps([&](const Gap& gap) { sum += gap.weight * gap.way.squaredNorm(); });
  return sum;
}

void LineDeviation::add_to(BlockSystem& system) const {
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
