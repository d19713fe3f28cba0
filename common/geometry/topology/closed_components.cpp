#include "common/geometry/topology/closed_components.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "common/geometry/face_crossings/box_tree.h"
#include "common/geometry/topology/topology.h"

namespace strake {
namespace {

/// Share of area times extent below which a volume is that of rounding.
constexpr double kNoVolume = 1e-9;
/// Points of a component at which is looked whether it lies inside others.
constexpr std::size_t kPoints = 9;

struct Solid {
  double volume = 0;
  double area = 0;
  Eigen::AlignedBox3d box;
  std::vector<Index> faces;

  [[nodiscard]] bool looks_inwards() const {
    return volume < -kNoVolume * area * box.diagonal().norm();
  }
};

/// A point of a component, and how often others go around it, outwards less inwards.
struct Point {
  Vec3 at;
  Index component;
  int winding = 0;
};

class Judge {
 public:
  Judge(std::span<const Vec3> positions, std::span<const std::array<Index, 3>> faces,
        std::span<const Index> component, std::span<const std::uint8_t> is_closed)
      : positions_(positions), faces_(faces), component_(component), is_closed_(is_closed) {}

  ClosedComponents run() {
    measure();
    const auto looks_inwards = [&](std::size_t c) { return solids_[c].looks_inwards(); };
    const auto is_closed = [&](std::size_t c) { return is_closed_[c] != 0; };
    const std::vector<std::uint8_t> is_cavity =
        those_inside(looks_inwards, is_closed, [](int winding) { return winding >= 1; });
    ClosedComponents result;
    result.is_to_turn.resize(solids_.size());
    for (std::size_t c = 0; c < solids_.size(); ++c) {
      result.count += is_closed(c) ? 1 : 0;
      result.cavities += is_cavity[c];
      result.is_to_turn[c] = looks_inwards(c) && is_cavity[c] == 0 ? 1 : 0;
      result.inside_out += result.is_to_turn[c];
    }
    if (result.inside_out == 0) return result;
    const std::vector<std::uint8_t> is_inside_out = result.is_to_turn;
    const std::vector<std::uint8_t> is_inside =
        those_inside([&](std::size_t c) { return is_closed(c) && is_inside_out[c] == 0; },
                     [&](std::size_t c) { return is_inside_out[c] != 0; },
                     [](int winding) { return winding < 0; });
    for (std::size_t c = 0; c < solids_.size(); ++c) result.is_to_turn[c] |= is_inside[c];
    return result;
  }

 private:
  void measure() {
    solids_.resize(is_closed_.size());
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      if (is_closed_[component_[f]] == 0) continue;
      Solid& solid = solids_[component_[f]];
      solid.faces.push_back(static_cast<Index>(f));
      const auto& [a, b, c] = faces_[f];
      // About a vertex of its own, as the model may lie far from the origin.
      const Vec3& origin = positions_[faces_[solid.faces[0]][0]];
      const Vec3 normal = (positions_[b] - positions_[a]).cross(positions_[c] - positions_[a]);
      solid.volume += normal.dot(positions_[a] - origin) / 6;
      solid.area += normal.norm() / 2;
      for (const Index v : faces_[f]) solid.box.extend(positions_[v]);
    }
  }

  /// \return [components] whether it is one of these, and is wound around as asked at each of its
  /// points by those that may be `around`
  template <class Asked, class Around, class IsWound>
  std::vector<std::uint8_t> those_inside(const Asked& is_asked, const Around& may_be_around,
                                         const IsWound& is_wound) {
    place_points(is_asked);
    std::vector<BoxTree::Box> places;
    for (const Point& point : points_) places.emplace_back(point.at);
    const BoxTree tree(places);
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      if (!points_.empty() && may_be_around(component_[f])) cross(f, tree);
    }
    std::vector<std::uint8_t> result(solids_.size(), 0);
    for (const Point& point : points_) result[point.component] = 1;
    for (const Point& point : points_) {
      if (!is_wound(point.winding)) result[point.component] = 0;
    }
    return result;
  }

  /// On faces, and off their corners and edges, which may lie above others'.
  template <class Asked>
  void place_points(const Asked& is_asked) {
    points_.clear();
    for (std::size_t c = 0; c < solids_.size(); ++c) {
      const Solid& solid = solids_[c];
      if (!is_asked(c)) continue;
      if (slanted_.empty()) slant();
      const std::size_t count = std::min(kPoints, solid.faces.size());
      for (std::size_t i = 0; i < count; ++i) {
        const auto& [p, q, r] = faces_[solid.faces[i * solid.faces.size() / count]];
        points_.push_back({0.4142 * slanted_[p] + 0.3141 * slanted_[q] + 0.2717 * slanted_[r],
                           static_cast<Index>(c)});
      }
    }
  }

  /// Shears all along the horizontal. What counts is what lies above what, and that without doubt:
  /// upright faces, of which models have many, would lie above each other's points.
  void slant() {
    constexpr double kX = 0.1376;
    constexpr double kY = 0.0719;
    slanted_.reserve(positions_.size());
    for (const Vec3& p : positions_) {
      slanted_.emplace_back(p.x() + kX * p.z(), p.y() + kY * p.z(), p.z());
    }
  }

  /// Whether a point is left of the edge from a to b, seen from above, alike for both its faces.
  [[nodiscard]] bool is_left(Index a, Index b, const Vec3& p) const {
    const Vec3 along = slanted_[std::max(a, b)] - slanted_[std::min(a, b)];
    const Vec3 to = p - slanted_[std::min(a, b)];
    return (along.x() * to.y() - along.y() * to.x() > 0) == (a < b);
  }

  /// Counts a face for the points below it. Those below all of its component are left out: its
  /// other faces would undo what this one counts.
  void cross(std::size_t f, const BoxTree& tree) {
    const auto& [a, b, c] = faces_[f];
    BoxTree::Box box;
    for (const Index v : faces_[f]) box.extend(slanted_[v]);
    box.min().z() = solids_[component_[f]].box.min().z();
    const Vec3 normal = (slanted_[b] - slanted_[a]).cross(slanted_[c] - slanted_[a]);
    tree.visit_touching(box, [&, a = a, b = b, c = c](Index i) {
      Point& point = points_[i];
      if (point.component == component_[f]) return;
      const bool left = is_left(a, b, point.at);
      if (is_left(b, c, point.at) != left || is_left(c, a, point.at) != left) return;
      const bool is_above = (normal.dot(slanted_[a] - point.at) > 0) == (normal.z() > 0);
      if (is_above) point.winding += left ? 1 : -1;
    });
  }

  std::span<const Vec3> positions_;
  std::span<const std::array<Index, 3>> faces_;
  std::span<const Index> component_;
  std::span<const std::uint8_t> is_closed_;
  std::vector<Vec3> slanted_;  ///< [V] once there are points; the same heights
  std::vector<Solid> solids_;  ///< [components]
  std::vector<Point> points_;
};

}  // namespace

ClosedComponents judge_closed_components(std::span<const Vec3> positions,
                                         std::span<const std::array<Index, 3>> faces,
                                         std::span<const Index> component,
                                         std::span<const std::uint8_t> is_closed) {
  return Judge(positions, faces, component, is_closed).run();
}

ClosedComponents judge_closed_components(const TriMesh& mesh) {
  const std::vector<Index> component = face_components(mesh);
  const Index count =
      component.empty() ? 0 : 1 + *std::max_element(component.begin(), component.end());
  std::vector<std::uint8_t> is_closed(count, 1);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (mesh.is_boundary(h)) is_closed[component[TriMesh::face_of(h)]] = 0;
  }
  return judge_closed_components(mesh.positions, mesh.faces, component, is_closed);
}

}  // namespace strake
