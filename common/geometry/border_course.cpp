#include "common/geometry/border_course.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "common/geometry/angles.h"
#include "common/geometry/frames.h"
#include "common/geometry/topology/vertex_ring.h"

namespace strake {
namespace {

/// Turn to and fro of single vertices, in the mean over some on each side, from which on a
/// boundary is ragged.
constexpr double kRaggedTurn = 10 * kDegree;
constexpr Index kRaggedReach = 8;
/// Edges to both sides that a direction is taken over, and the largest share of a loop.
constexpr Index kDirectionReach = 4;
/// Share of its way that a boundary leads on, at least, as far as that tells how far to look.
constexpr double kLeastStraight = 0.1;
constexpr Index kLeastOfLoop = 6;
/// Of the wanted length of edges, to both sides.
constexpr double kReach = 0.5;
/// Of the wanted length of edges, in the mean over a ragged piece and at one vertex: wider teeth
/// are shape, and cells follow them.
constexpr double kWidestTooth = 0.75;
constexpr double kWidestOfPiece = 1.25;
/// Edges of a tooth: a mean over less to both sides would not see past it.
constexpr Index kTooth = 2;
/// Farthest on a closed boundary: a mean over more would close it up.
constexpr double kLoopShare = 1.0 / 12;
/// Of the wanted length of edges: what is farther off is no tooth but shape.
constexpr double kMostOff = 0.5;
/// Of the diagonal: what is farther off is seen, however large cells are.
constexpr double kMostSeen = 0.0075;
/// How far to both sides a corner of the course turns, in reaches of the mean.
constexpr double kCornerReach = 2;

/// One loop of the boundary, the surface on its left.
class BorderLoop {
 public:
  BorderLoop(const TriMesh& mesh, Index start) : mesh_(mesh) {
    Index h = start;
    do {
      halfedges_.push_back(h);
      h = mesh.vertex_out[mesh.to(h)];
    } while (h != start);
    count_ = static_cast<Index>(halfedges_.size());
    until_.push_back(0);
    for (Index i = 0; i < count_; ++i) until_.push_back(until_.back() + (at(i + 1) - at(i)).norm());
    find_turns();
  }

  [[nodiscard]] const std::vector<Index>& halfedges() const { return halfedges_; }

  /// Whether the boundary turns to and fro around a vertex: each time at a single one, against
  /// both beside it. Teeth with a top, steps and polygons do not.
  [[nodiscard]] bool is_ragged(Index i) const {
    double sum = 0;
    for (Index j = i - kRaggedReach; j <= i + kRaggedReach; ++j) sum += to_and_fro(j);
    return sum > (2 * kRaggedReach + 1) * kRaggedTurn;
  }

  /// The direction from a vertex on, from a few edges away.
  [[nodiscard]] Vec3 direction(Index i) const {
    const Index few = few_edges(kDirectionReach);
    return (at(i + 1 + few) - at(i - few)).normalized();
  }

  /// Length of a tooth at a vertex, along the boundary.
  [[nodiscard]] double tooth(Index i) const {
    const Index few = few_edges(kRaggedReach);
    return static_cast<double>(kTooth) * (until(i + few) - until(i - few)) / (2 * few);
  }

  /// Straight way over the one along the boundary, around a vertex with turns.
  [[nodiscard]] double straightness(Index i) const {
    const Index few = few_edges(kRaggedReach);
    const double straight = (at(i + few) - at(i - few)).norm();
    return std::max(straight / (until(i + few) - until(i - few)), kLeastStraight);
  }

  /// How far along the boundary to look from a vertex to both sides.
  [[nodiscard]] double reach(Index i, double size) const {
    const double wanted = std::max(kReach * size / straightness(i), tooth(i));
    return std::min(wanted, kLoopShare * until_.back());
  }

  /// The mean of the boundary around a place along it, weighted less the farther away.
  [[nodiscard]] Vec3 mean_around(Index i, double shift, double reach) const {
    const double centre = until(i) + shift;
    Vec3 sum = Vec3::Zero();
    double weights = 0;
    const auto add_edge = [&](Index j) {
      const double from = std::max(until(j), centre - reach);
      const double to = std::min(until(j + 1), centre + reach);
      const double length = until(j + 1) - until(j);
      if (!(to > from)) return;
      // The weight is linear on both sides of the centre: Simpson's rule is exact there.
      for (const auto& [a, b] :
           {std::pair(from, std::min(to, centre)), std::pair(std::max(from, centre), to)}) {
        if (!(b > a)) continue;
        for (const auto& [s, share] :
             {std::pair(a, 1.0 / 6), std::pair((a + b) / 2, 4.0 / 6), std::pair(b, 1.0 / 6)}) {
          const double weight = share * (b - a) * (reach - std::abs(s - centre));
          const double along = (s - until(j)) / length;
          sum += weight * ((1 - along) * (at(j) - at(i)) + along * (at(j + 1) - at(i)));
          weights += weight;
        }
      }
    };
    Index first = i;
    while (until(first) > centre - reach) --first;
    while (until(first + 1) <= centre - reach) ++first;
    for (Index j = first; until(j) < centre + reach; ++j) add_edge(j);
    return weights > 0 ? Vec3(at(i) + sum / weights) : at(i);
  }

  /// Whether the course turns sharply at a vertex. \param reach  of the mean there
  [[nodiscard]] bool turns_sharply(Index i, double reach) const {
    const double far = std::min(kCornerReach * reach, kLoopShare * until_.back());
    const Vec3 here = mean_around(i, 0, reach);
    const Vec3 behind = mean_around(i, -far, reach);
    const Vec3 ahead = mean_around(i, far, reach);
    return angle_between(here - behind, ahead - here) > kSharpTurn;
  }

  [[nodiscard]] Index vertex(Index i) const { return mesh_.from(halfedges_[wrap(i)]); }
  [[nodiscard]] Index count() const { return count_; }
  /// Along the loop, on and on around it.
  [[nodiscard]] double until(Index i) const {
    const Index j = wrap(i);
    return until_[j] + static_cast<double>((i - j) / count_) * until_.back();
  }

 private:
  /// Edges to one side, fewer on small loops.
  [[nodiscard]] Index few_edges(Index most) const {
    return std::clamp(count_ / kLeastOfLoop, Index{1}, most);
  }
  [[nodiscard]] Index wrap(Index i) const { return ((i % count_) + count_) % count_; }
  [[nodiscard]] const Vec3& at(Index i) const { return mesh_.positions[vertex(i)]; }

  void find_turns() {
    for (Index i = 0; i < count_; ++i) {
      Vec3 normal = Vec3::Zero();
      for_each_outgoing(mesh_, vertex(i),
                        [&](Index h) { normal += face_cross(mesh_, TriMesh::face_of(h)); });
      const Vec3 before = at(i) - at(i - 1);
      const Vec3 after = at(i + 1) - at(i);
      const double turn = angle_between(before, after);
      turns_.push_back(before.cross(after).dot(normal) < 0 ? -turn : turn);
    }
  }

  [[nodiscard]] double to_and_fro(Index i) const {
    const double before = turns_[wrap(i - 1)];
    const double here = turns_[wrap(i)];
    const double after = turns_[wrap(i + 1)];
    if (here * before >= 0 || here * after >= 0) return 0;
    return std::min({std::abs(before), std::abs(here), std::abs(after)});
  }

  const TriMesh& mesh_;
  std::vector<Index> halfedges_;
  std::vector<double> until_;  ///< [count + 1] length before each vertex, model units
  std::vector<double> turns_;  ///< radians, positive towards the surface
  Index count_ = 0;
};

template <typename Use>
void for_each_loop(const TriMesh& mesh, const Use& use) {
  std::vector<std::uint8_t> seen(mesh.twin.size(), 0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (!mesh.is_boundary(h) || seen[h] != 0) continue;
    const BorderLoop loop(mesh, h);
    for (const Index other : loop.halfedges()) seen[other] = 1;
    use(loop);
  }
}

/// Way along a loop of some length from a place to the nearest corner, whichever way round.
double way_to_corner(const std::vector<double>& corners, double place, double length) {
  if (corners.empty()) return length;
  const auto after = std::lower_bound(corners.begin(), corners.end(), place);
  const double next = after != corners.end() ? *after : corners.front() + length;
  const double last = after != corners.begin() ? *(after - 1) : corners.back() - length;
  return std::min(next - place, place - last);
}

/// Sets reaches to 0 where teeth are as wide as cells. A ragged piece is looked at as a whole:
/// where some of its teeth stayed its border would be a patchwork.
void drop_wide_teeth(const BorderLoop& loop, const std::vector<double>& size,
                     std::vector<double>& reach) {
  const Index count = loop.count();
  const auto width = [&](Index i) {  // in wanted lengths
    const double wanted = size[loop.vertex(i)];
    const double tooth = loop.tooth(i) * loop.straightness(i);
    return tooth < kWidestOfPiece * wanted ? tooth / wanted : kWidestOfPiece;
  };
  Index first = 0;  // where a piece may begin
  while (first < count && reach[first] > 0) ++first;
  for (Index begin = first % count, left = count; left > 0;) {
    Index length = 0;
    double sum = 0;
    for (; length < left && reach[(begin + length) % count] > 0; ++length) {
      sum += width((begin + length) % count);
    }
    const bool is_wide = sum > kWidestTooth * static_cast<double>(length);
    for (Index k = 0; k < length; ++k) {
      const Index i = (begin + k) % count;
      if (is_wide || width(i) >= kWidestOfPiece) reach[i] = 0;
    }
    const Index passed = std::max(length, Index{1});
    begin = (begin + passed) % count;
    left -= passed;
  }
}

/// Whether features meet the boundary at a vertex.
bool is_junction(const TriMesh& mesh, Index vertex) {
  return any_outgoing(mesh, vertex, [&](Index h) { return mesh.is_feature[h] != 0; });
}

}  // namespace

Vec3 BorderCourse::offset_at(const TriMesh& mesh, const SurfacePoint& point) const {
  if (offset.empty()) return Vec3::Zero();
  const Index corner = corner_at(point);
  if (corner != kNone) return offset[mesh.from(corner)];
  const Index h = edge_at(point, [&](Index side) { return mesh.is_boundary(side); });
  if (h == kNone) return Vec3::Zero();
  return point.barycentric[h % 3] * offset[mesh.from(h)] +
         share_along(point, h) * offset[mesh.to(h)];
}

BorderCourse border_course(const TriMesh& mesh, const std::vector<double>& size, double most_off) {
  BorderCourse course;
  course.is_corner = mesh.is_corner;
  course.direction = ragged_directions(mesh);
  if (course.direction.empty()) return course;
  for_each_loop(mesh, [&](const BorderLoop& loop) {
    const Index count = loop.count();
    std::vector<double> reach(static_cast<std::size_t>(count), 0.0);
    for (Index i = 0; i < count; ++i) {
      if (loop.is_ragged(i)) reach[i] = loop.reach(i, size[loop.vertex(i)]);
    }
    drop_wide_teeth(loop, size, reach);
    std::vector<double> corners;  // along the loop, ascending
    for (Index i = 0; i < count; ++i) {
      const Index v = loop.vertex(i);
      if (mesh.is_corner[v] == 0) continue;
      if (is_junction(mesh, v)) {
        reach[i] = 0;
      } else if (reach[i] > 0 && !loop.turns_sharply(i, reach[i])) {
        course.is_corner[v] = 0;
        continue;
      }
      corners.push_back(loop.until(i));
    }
    std::vector<Vec3> offsets(static_cast<std::size_t>(count), Vec3::Zero());
    for (Index i = 0; i < count; ++i) {
      if (reach[i] == 0) continue;
      // A mean over more than a tooth would round corners off.
      const double to_corner = way_to_corner(corners, loop.until(i), loop.until(count));
      const double own = std::min(reach[i], std::max(to_corner, loop.tooth(i)));
      offsets[i] = loop.mean_around(i, 0, own) - mesh.positions[loop.vertex(i)];
    }
    for (Index i = 0; i < count; ++i) {
      const Index v = loop.vertex(i);
      // All of a tooth or nothing, with those beside it.
      double height = 0;
      for (Index j = i - kTooth; j <= i + kTooth; ++j) {
        height = std::max(height, offsets[((j % count) + count) % count].norm());
      }
      if (reach[i] == 0 ||
          height > std::min({most_off, kMostOff * size[v], kMostSeen * mesh.diagonal}))
        continue;
      if (course.offset.empty()) course.offset.assign(mesh.positions.size(), Vec3::Zero());
      course.offset[v] = offsets[i];
    }
  });
  return course;
}

std::vector<double> sizes_at_vertices(const TriMesh& mesh, const std::vector<double>& along,
                                      const std::vector<double>& across) {
  std::vector<double> sizes(mesh.positions.size(), 0.0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (!mesh.is_boundary(h)) continue;
    const Index w = mesh.wedge_of(h);
    sizes[mesh.from(h)] = std::min(along[w], across[w]);
  }
  return sizes;
}

std::vector<Vec3> ragged_directions(const TriMesh& mesh) {
  std::vector<Vec3> directions;
  for_each_loop(mesh, [&](const BorderLoop& loop) {
    for (Index i = 0; i < loop.count(); ++i) {
      if (!loop.is_ragged(i)) continue;
      if (directions.empty()) directions.assign(mesh.positions.size(), Vec3::Zero());
      directions[loop.vertex(i)] = loop.direction(i);
    }
  });
  return directions;
}

}  // namespace strake
