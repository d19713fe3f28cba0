#include "common/geometry/samples/planar_triangulation.h"

#include <cmath>

namespace strake {
namespace {

// Coordinates stay below 2^27, so orientations fit 64 bits and in-circle determinants 112.
__extension__ using Wide = __int128;
constexpr double kHalfGrid = 1 << 24;
constexpr std::int64_t kFrame = std::int64_t{1} << 26;

}  // namespace

PlanarTriangulation::PlanarTriangulation(const Vec2& lower, const Vec2& upper)
    : centre_((lower + upper) / 2),
      scale_(kHalfGrid / ((upper - lower).maxCoeff() / 2)),
      points_({{-kFrame, -kFrame}, {kFrame, -kFrame}, {kFrame, kFrame}, {-kFrame, kFrame}}) {
  triangles_.push_back({{0, 1, 2}, {kNone, 1, kNone}, {0, 0, 0}});
  triangles_.push_back({{0, 2, 3}, {kNone, kNone, 0}, {0, 0, 0}});
  triangle_of_ = {0, 0, 0, 1};
  visited_.assign(2, 0);
  leaving_.assign(4, kNone);
}

PlanarTriangulation::GridPoint PlanarTriangulation::to_grid(const Vec2& p) const {
  const Vec2 q = (p - centre_) * scale_;
  return {std::llround(q.x()), std::llround(q.y())};
}

int PlanarTriangulation::orientation(const GridPoint& a, const GridPoint& b,
                                     const GridPoint& c) const {
  const std::int64_t det = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  return det > 0 ? 1 : (det < 0 ? -1 : 0);
}

bool PlanarTriangulation::in_circle(const Triangle& t, const GridPoint& p) const {
  std::array<std::int64_t, 3> x{}, y{}, square{};
  for (std::size_t i = 0; i < 3; ++i) {
    x[i] = points_[t.vertices[i]].x - p.x;
    y[i] = points_[t.vertices[i]].y - p.y;
    square[i] = x[i] * x[i] + y[i] * y[i];
  }
  Wide det = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    det += Wide{square[i]} * (x[j] * y[k] - x[k] * y[j]);
  }
  return det > 0;
}

Index PlanarTriangulation::locate(const GridPoint& p, Index start, bool within) const {
  Index t = start;
  // A walk towards the point; in a constrained triangulation it might circle, hence the bound.
  const std::size_t bound = 3 * triangles_.size() + 16;
  for (std::size_t step = 0; step < bound; ++step) {
    const Triangle& triangle = triangles_[t];
    Index next = t;
    for (std::size_t k = 0; k < 3 && next == t; ++k) {
      const std::size_t i = (k + step) % 3;
      const int side = orientation(points_[triangle.vertices[(i + 1) % 3]],
                                   points_[triangle.vertices[(i + 2) % 3]], p);
      if (side > 0) continue;
      if (triangle.locked[i] && (within || side == 0)) return kNone;
      if (side < 0) next = triangle.neighbours[i];
    }
    if (next == t) return t;
    if (next == kNone) return kNone;
    t = next;
  }
  return kNone;
}

bool PlanarTriangulation::open_cavity(const Vec2& point, Index near, bool within) {
  const GridPoint p = to_grid(point);
  const Index home = locate(p, near, within);
  if (home == kNone) return false;
  for (const Index v : triangles_[home].vertices) {
    if (points_[v].x == p.x && points_[v].y == p.y) return false;
  }
  ++search_;
  pending_ = p;
  cavity_.assign(1, home);
  cavity_edges_.clear();
  visited_[home] = search_;
  for (std::size_t next = 0; next < cavity_.size(); ++next) {
    const Triangle& t = triangles_[cavity_[next]];
    for (std::size_t i = 0; i < 3; ++i) {
      const Index other = t.neighbours[i];
      if (other != kNone && visited_[other] == search_) continue;
      if (other != kNone && !t.locked[i] && in_circle(triangles_[other], p)) {
        visited_[other] = search_;
        cavity_.push_back(other);
      } else {
        cavity_edges_.push_back(
            {t.vertices[(i + 1) % 3], t.vertices[(i + 2) % 3], other, t.locked[i]});
      }
    }
  }
  return true;
}

Index PlanarTriangulation::new_triangle(std::size_t reuse) {
  if (reuse < cavity_.size()) return cavity_[reuse];
  triangles_.emplace_back();
  visited_.push_back(0);
  return static_cast<Index>(triangles_.size()) - 1;
}

Index PlanarTriangulation::fill_cavity() {
  const Index vertex = static_cast<Index>(points_.size());
  points_.push_back(pending_);
  leaving_.push_back(kNone);
  const bool inside = triangles_[cavity_[0]].inside;
  fresh_.clear();
  for (std::size_t i = 0; i < cavity_edges_.size(); ++i) {
    const CavityEdge& edge = cavity_edges_[i];
    const Index t = new_triangle(i);
    Triangle& triangle = triangles_[t];
    triangle.vertices = {edge.from, edge.to, vertex};
    triangle.neighbours = {kNone, kNone, edge.outer};
    triangle.locked = {0, 0, edge.locked};
    triangle.inside = inside;
    ++triangle.version;
    leaving_[edge.from] = t;
    triangle_of_[edge.from] = t;
    fresh_.push_back(t);
    if (edge.outer == kNone) continue;
    Triangle& outer = triangles_[edge.outer];
    for (std::size_t k = 0; k < 3; ++k) {
      if (outer.vertices[(k + 1) % 3] == edge.to && outer.vertices[(k + 2) % 3] == edge.from) {
        outer.neighbours[k] = t;
      }
    }
  }
  // Around the new point, the triangle over edge (a, b) is followed by the one over (b, c).
  for (const Index t : fresh_) {
    const Index following = leaving_[triangles_[t].vertices[1]];
    triangles_[t].neighbours[0] = following;
    triangles_[following].neighbours[1] = t;
  }
  // A cavity has an edge, so there is a new triangle.
  triangle_of_.push_back(fresh_.front());  // cppcheck-suppress containerOutOfBounds
  return vertex;
}

Index PlanarTriangulation::insert(const Vec2& point) {
  const Index near = fresh_.empty() ? 0 : fresh_.back();
  return open_cavity(point, near, false) ? fill_cavity() : kNone;
}

bool PlanarTriangulation::lock_edge(Index a, Index b) {
  const Index first = triangle_of_[a];
  Index t = first;
  do {
    Triangle& triangle = triangles_[t];
    std::size_t i = 0;
    while (triangle.vertices[i] != a) ++i;
    if (triangle.vertices[(i + 1) % 3] == b) {
      const Index other = triangle.neighbours[(i + 2) % 3];
      if (other == kNone) return false;
      triangle.locked[(i + 2) % 3] = 1;
      for (std::size_t k = 0; k < 3; ++k) {
        if (triangles_[other].neighbours[k] == t) triangles_[other].locked[k] = 1;
      }
      return true;
    }
    t = triangle.neighbours[(i + 1) % 3];
  } while (t != first && t != kNone);
  return false;
}

void PlanarTriangulation::mark_inside() {
  ++search_;
  std::vector<Index> stack = {triangle_of_[0]};
  triangles_[stack[0]].inside = false;
  visited_[stack[0]] = search_;
  while (!stack.empty()) {
    const Index t = stack.back();
    stack.pop_back();
    for (std::size_t i = 0; i < 3; ++i) {
      const Index other = triangles_[t].neighbours[i];
      if (other == kNone || visited_[other] == search_) continue;
      visited_[other] = search_;
      triangles_[other].inside = triangles_[t].inside != (triangles_[t].locked[i] != 0);
      stack.push_back(other);
    }
  }
}

Vec2 PlanarTriangulation::circumcentre(Index triangle) const {
  const auto& v = triangles_[triangle].vertices;
  const GridPoint& a = points_[v[0]];
  const double bx = static_cast<double>(points_[v[1]].x - a.x);
  const double by = static_cast<double>(points_[v[1]].y - a.y);
  const double cx = static_cast<double>(points_[v[2]].x - a.x);
  const double cy = static_cast<double>(points_[v[2]].y - a.y);
  const double twice_area = bx * cy - by * cx;
  const double b2 = bx * bx + by * by, c2 = cx * cx + cy * cy;
  const Vec2 offset((cy * b2 - by * c2) / (2 * twice_area), (bx * c2 - cx * b2) / (2 * twice_area));
  const Vec2 grid = Vec2(static_cast<double>(a.x), static_cast<double>(a.y)) + offset;
  return grid / scale_ + centre_;
}

}  // namespace strake
