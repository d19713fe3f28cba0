#include "stages/mesh/cell_view.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "common/geometry/frames.h"

namespace strake {
namespace {

/// Whether the way from a corner to `to` lies between those to the corners before and after it.
bool lies_between(const Vec2& before, const Vec2& corner, const Vec2& after, const Vec2& to) {
  const bool left_of_after = turn(corner, after, to) > 0;
  const bool right_of_before = turn(corner, before, to) < 0;
  const bool convex = turn(before, corner, after) >= 0;
  return convex ? left_of_after && right_of_before : left_of_after || right_of_before;
}

/// Whether two edges that are no neighbours meet.
bool meets_itself(const std::vector<Vec2>& outline) {
  const std::size_t n = outline.size();
  for (std::size_t i = 0; i + 2 < n; ++i) {
    for (std::size_t k = i + 2; k < n; ++k) {
      const std::size_t l = (k + 1) % n;
      if (l != i && segments_meet(outline[i], outline[i + 1], outline[k], outline[l])) return true;
    }
  }
  return false;
}

}  // namespace

CellView::CellView(const PolygonGraph& graph, const DartLoop& cell, const Polygon& p)
    : corners_(p), normal_(vector_area(p).normalized()) {
  const TangentFrame frame = tangent_frame(normal_);
  for (const Vec3& v : p) flat_.push_back(frame.tangent_from_world(v));
  // Corners on features have the normal of either side: they do not tell.
  const bool turns_away = std::ranges::any_of(cell, [&](Index d) {
    const Index node = graph.graph().from(d);
    return graph.rank(node) == NodeRank::line && graph.surface_normal(node).dot(normal_) < 0;
  });
  if (turns_away && meets_itself(flat_)) look_along_surface(graph, cell);
}

/// Corners on features are seen as the next one inside of a line is, around the cell.
void CellView::look_along_surface(const PolygonGraph& graph, const DartLoop& cell) {
  const std::size_t n = cell.size();
  normals_.resize(n);
  Vec3 last = normal_;
  for (std::size_t k = 2 * n; k-- > 0;) {
    const Index node = graph.graph().from(cell[k % n]);
    if (graph.rank(node) == NodeRank::line) last = graph.surface_normal(node);
    normals_[k % n] = last;
  }
}

Vec3 CellView::normal_of(std::size_t i, std::size_t j) const {
  if (!is_folded()) return normal_;
  Vec3 sum = normals_[i];
  while (i != j) {
    i = (i + 1) % normals_.size();
    sum += normals_[i];
  }
  return sum.normalized();
}

bool CellView::contains(std::size_t i, std::size_t j) const {
  if (!leaves_inwards(i, j) || !leaves_inwards(j, i)) return false;
  return is_folded() ? !is_crossed_nearby(i, j) : !is_crossed(i, j);
}

bool CellView::leaves_inwards(std::size_t i, std::size_t j) const {
  const std::size_t n = corners_.size();
  const std::size_t before = (i + n - 1) % n;
  const std::size_t after = (i + 1) % n;
  if (!is_folded()) return lies_between(flat_[before], flat_[i], flat_[after], flat_[j]);
  const TangentFrame frame = tangent_frame(normals_[i]);
  const auto seen = [&](std::size_t k) { return frame.tangent_from_world(corners_[k]); };
  return lies_between(seen(before), seen(i), seen(after), seen(j));
}

bool CellView::is_crossed(std::size_t i, std::size_t j) const {
  const std::size_t n = corners_.size();
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t l = (k + 1) % n;
    if (k == i || k == j || l == i || l == j) continue;
    if (segments_meet(flat_[i], flat_[j], flat_[k], flat_[l])) return true;
  }
  return false;
}

/// Likewise seen along the normals at both ends. What faces the other way, or is farther off than
/// the diagonal is long, lies before or behind it.
bool CellView::is_crossed_nearby(std::size_t i, std::size_t j) const {
  const Vec3 along = (normals_[i] + normals_[j]).normalized();
  const Vec3 middle = 0.5 * (corners_[i] + corners_[j]);
  const double reach = (corners_[i] - corners_[j]).norm();
  const TangentFrame frame = tangent_frame(along);
  const auto seen = [&](std::size_t k) { return frame.tangent_from_world(corners_[k]); };
  const std::size_t n = corners_.size();
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t l = (k + 1) % n;
    if (k == i || k == j || l == i || l == j) continue;
    if (normals_[k].dot(along) < 0 || normals_[l].dot(along) < 0) continue;
    const double height = std::min(std::abs((corners_[k] - middle).dot(along)),
                                   std::abs((corners_[l] - middle).dot(along)));
    if (height < reach && segments_meet(seen(i), seen(j), seen(k), seen(l))) return true;
  }
  return false;
}

}  // namespace strake
