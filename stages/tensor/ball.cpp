#include "stages/tensor/ball.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "common/geometry/frames.h"

namespace strake {
namespace {

/// Share of its coordinates by which single precision may round a place, doubled.
constexpr double kTileRounding = 2.5e-7;
/// Share of the ball's radius up to which that of a face is small against it.
constexpr double kSmallFace = 0.25;

double squared_distance_to_segment(const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a;
  const double length = d.squaredNorm();
  const double t = length > 0 ? std::clamp(-a.dot(d) / length, 0.0, 1.0) : 0.0;
  return (a + t * d).squaredNorm();
}

/// Signed angle from p to q. Faces are small against the ball as a rule, so that a series is enough
/// for half the angle: to 1e-12.
double angle_between(const Vec2& p, const Vec2& q) {
  const double across = p.x() * q.y() - p.y() * q.x();
  const double along = p.dot(q);
  const double t = across / (along + std::sqrt(along * along + across * across));
  if (!(along > 0 && std::abs(t) < 0.25)) return std::atan2(across, along);
  const double t2 = t * t;
  double series = 0;
  for (int odd = 17; odd >= 1; odd -= 2) series = 1.0 / odd - t2 * series;
  return 2 * t * series;
}

/// Signed area between the origin, a and b inside the disk of radius r around the origin.
double disk_sector_area(const Vec2& a, const Vec2& b, double r) {
  const auto wedge = [r](const Vec2& p, const Vec2& q) {
    return 0.5 * r * r * angle_between(p, q);
  };
  const auto triangle = [](const Vec2& p, const Vec2& q) {
    return 0.5 * (p.x() * q.y() - p.y() * q.x());
  };
  const Vec2 d = b - a;
  const double qa = d.squaredNorm();
  if (!(qa > 0)) return 0;
  const double qb = a.dot(d);
  const double discriminant = qb * qb - qa * (a.squaredNorm() - r * r);
  if (discriminant <= 0) return wedge(a, b);
  const double root = std::sqrt(discriminant);
  const double t0 = (-qb - root) / qa;
  const double t1 = (-qb + root) / qa;
  if (t1 <= 0 || t0 >= 1) return wedge(a, b);
  const Vec2 p = t0 > 0 ? Vec2(a + t0 * d) : a;
  const Vec2 q = t1 < 1 ? Vec2(a + t1 * d) : b;
  return (t0 > 0 ? wedge(a, p) : 0.0) + triangle(p, q) + (t1 < 1 ? wedge(q, b) : 0.0);
}

/// Share of the way from a point in the ball to one outside that is inside.
double share_inside(const Vec3& from, const Vec3& way, double r) {
  const double length2 = way.squaredNorm();
  const double along = from.dot(way);
  return (std::sqrt(along * along + length2 * (r * r - from.squaredNorm())) - along) / length2;
}

/// Adds weight times e e^T.
void add_cycle(const Vec3& e, double weight, std::array<double, 6>& sum) {
  sum[0] += weight * e.x() * e.x();
  sum[1] += weight * e.x() * e.y();
  sum[2] += weight * e.x() * e.z();
  sum[3] += weight * e.y() * e.y();
  sum[4] += weight * e.y() * e.z();
  sum[5] += weight * e.z() * e.z();
}

}  // namespace

double clipped_length(const Vec3& a, const Vec3& b, double r) {
  const Vec3 d = b - a;
  const double length = d.norm();
  if (!(length > 0)) return 0;
  const double middle = -a.dot(d) / length;  // foot of the centre, measured from a
  const double half_squared = r * r - (a + d * (middle / length)).squaredNorm();
  if (half_squared <= 0) return 0;
  const double half = std::sqrt(half_squared);
  return std::max(0.0, std::min(length, middle + half) - std::max(0.0, middle - half));
}

double clipped_area(const Vec3& a, const Vec3& b, const Vec3& c, double r) {
  const Vec3 normal = (b - a).cross(c - a);
  const double twice = normal.norm();
  if (!(twice > 0)) return 0;
  const double r2 = r * r;
  if (a.squaredNorm() <= r2 && b.squaredNorm() <= r2 && c.squaredNorm() <= r2) return 0.5 * twice;
  const Vec3 n = normal / twice;
  const double height = a.dot(n);
  const double disk2 = r2 - height * height;
  if (disk2 <= 0) return 0;
  const TangentFrame frame = tangent_frame(n);
  const Vec2 pa = frame.tangent_from_world(a);
  const Vec2 pb = frame.tangent_from_world(b);
  const Vec2 pc = frame.tangent_from_world(c);
  const double disk = std::sqrt(disk2);
  return std::max(0.0, disk_sector_area(pa, pb, disk) + disk_sector_area(pb, pc, disk) +
                           disk_sector_area(pc, pa, disk));
}

FaceCycles::FaceCycles(const TriMesh& mesh, const std::vector<Vec3>& normals)
    : mesh_(mesh),
      normals_(normals),
      half_bend_(static_cast<std::size_t>(mesh.halfedge_count())),
      tiles_(static_cast<std::size_t>(mesh.face_count())) {
  tbb::parallel_for(Index{0}, mesh.face_count(), [&](Index f) {
    for (Index h = 3 * f; h < 3 * f + 3; ++h) half_bend_[h] = half_bend_of(h);
    tiles_[f] = tile_of(f);
  });
}

float FaceCycles::half_bend_of(Index h) const {
  if (mesh_.is_barrier(h)) return 0;
  const Vec3& left = normals_[TriMesh::face_of(h)];
  const Vec3& right = normals_[TriMesh::face_of(mesh_.twin[h])];
  const Vec3 edge = mesh_.positions[mesh_.to(h)] - mesh_.positions[mesh_.from(h)];
  const double length = edge.norm();
  if (!(length > 0)) return 0;
  const double beta = std::atan2(left.cross(right).dot(edge) / length, left.dot(right));
  return static_cast<float>(0.5 * beta / length);
}

FaceCycles::Tile FaceCycles::tile_of(Index face) const {
  const auto& [a, b, c] = mesh_.faces[face];
  const Vec3 centre = (mesh_.positions[a] + mesh_.positions[b] + mesh_.positions[c]) / 3;
  Tile tile{};
  double radius = 0;
  std::array<double, 6> sum{};
  for (int i = 0; i < 3; ++i) {
    const Index h = 3 * face + i;
    const Vec3& p = mesh_.positions[mesh_.from(h)];
    radius = std::max(radius, (p - centre).norm() + kTileRounding * p.cwiseAbs().maxCoeff());
    add_cycle(mesh_.positions[mesh_.to(h)] - p, half_bend_[h], sum);
    tile.centre[i] = static_cast<float>(centre[i]);
    tile.neighbour[i] = mesh_.is_barrier(h) ? kNone : TriMesh::face_of(mesh_.twin[h]);
  }
  tile.radius = static_cast<float>(radius * (1 + kTileRounding));
  tile.area = static_cast<float>(face_area(mesh_, face));
  std::transform(sum.begin(), sum.end(), tile.cycle.begin(),
                 [](double entry) { return static_cast<float>(entry); });
  return tile;
}

BallWalker::BallWalker(const FaceCycles& cycles)
    : cycles_(cycles), stamp_(static_cast<std::size_t>(cycles.mesh().face_count()), 0) {}

/// Puts a face on the front, unless it is there.
/// \return false where it folds over to another sheet: the bend towards it does not count
bool BallWalker::visit(Index face, const Vec3& normal) {
  if (face == kNone || stamp_[face] == current_) return true;
  if (cycles_.normal(face).dot(normal) <= 0) return false;
  stamp_[face] = current_;
  front_.push_back(face);
  return true;
}

/// The face's sum holds the bends towards all its neighbours: those that fold over are taken out.
void BallWalker::add_whole(Index face, const Vec3& normal) {
  const FaceCycles::Tile& tile = cycles_.tile(face);
  area_ += tile.area;
  for (std::size_t i = 0; i < sum_.size(); ++i) sum_[i] += tile.cycle[i];
  for (int i = 0; i < 3; ++i) {
    if (visit(tile.neighbour[i], normal)) continue;
    const TriMesh& mesh = cycles_.mesh();
    const Index h = 3 * face + i;
    add_cycle(mesh.positions[mesh.to(h)] - mesh.positions[mesh.from(h)], -cycles_.half_bend(h),
              sum_);
  }
}

/// Adds a face that is small against the ball, so that its rim is a flat arc there.
void BallWalker::add_small(Index face, const Vec3& centre, double radius, const Vec3& normal) {
  const TriMesh& mesh = cycles_.mesh();
  const FaceCycles::Tile& tile = cycles_.tile(face);
  std::array<Vec3, 3> p;
  std::array<bool, 3> inside{};
  for (int i = 0; i < 3; ++i) {
    p[i] = mesh.positions[mesh.faces[face][i]] - centre;
    inside[i] = p[i].squaredNorm() <= radius * radius;
  }
  const int count = int(inside[0]) + int(inside[1]) + int(inside[2]);
  if (count == 3) return add_whole(face, normal);
  for (int i = 0; i < 3; ++i) {  // the rim may cut such an edge twice
    const int j = (i + 1) % 3;
    if (!inside[i] && !inside[j] && squared_distance_to_segment(p[i], p[j]) < radius * radius) {
      return add_large(face, centre, radius, normal);
    }
  }
  if (count == 0) return;
  double corner = 1;  // share of the corner that the rim cuts off, inside or outside
  Vec3 chord = Vec3::Zero();
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    if (!inside[i] && !inside[j]) continue;
    const bool goes_on = visit(tile.neighbour[i], normal);
    double share = 1;
    if (inside[i] != inside[j]) {
      const Vec3& from = inside[i] ? p[i] : p[j];
      const Vec3 way = (inside[i] ? p[j] : p[i]) - from;
      share = share_inside(from, way, radius);
      corner *= count == 1 ? share : 1 - share;
      const Vec3 crossing = from + share * way;
      chord += inside[i] ? crossing : Vec3(-crossing);
    }
    if (goes_on) add_cycle(p[j] - p[i], share * cycles_.half_bend(3 * face + i), sum_);
  }
  // Between the chord and the arc: the first term of its series, c^3 / (12 r).
  const double length2 = chord.squaredNorm();
  area_ +=
      (count == 1 ? corner : 1 - corner) * tile.area + length2 * std::sqrt(length2) / (12 * radius);
}

/// Adds a face that the ball may cut in any way.
void BallWalker::add_large(Index face, const Vec3& centre, double radius, const Vec3& normal) {
  const TriMesh& mesh = cycles_.mesh();
  const FaceCycles::Tile& tile = cycles_.tile(face);
  std::array<Vec3, 3> p;
  std::array<bool, 3> inside{};
  for (int i = 0; i < 3; ++i) {
    p[i] = mesh.positions[mesh.faces[face][i]] - centre;
    inside[i] = p[i].squaredNorm() <= radius * radius;
  }
  area_ += clipped_area(p[0], p[1], p[2], radius);
  for (int i = 0; i < 3; ++i) {
    if (tile.neighbour[i] == kNone) continue;
    const int j = (i + 1) % 3;
    if (!inside[i] && !inside[j] && squared_distance_to_segment(p[i], p[j]) >= radius * radius) {
      continue;
    }
    if (!visit(tile.neighbour[i], normal)) continue;
    const Vec3 edge = p[j] - p[i];
    double weight = cycles_.half_bend(3 * face + i);
    if (!inside[i] || !inside[j]) weight *= clipped_length(p[i], p[j], radius) / edge.norm();
    add_cycle(edge, weight, sum_);
  }
}

/// Sums over the ball. \return false where it meets more than `most` faces: the sum is not whole
bool BallWalker::sum(Index h, const Vec3& normal, double radius, Index most) {
  if (++current_ == 0) {
    std::fill(stamp_.begin(), stamp_.end(), 0U);
    current_ = 1;
  }
  const Index first = TriMesh::face_of(h);
  stamp_[first] = current_;
  front_.assign(1, first);
  area_ = 0;
  sum_ = {};
  const Vec3 centre = cycles_.mesh().positions[cycles_.mesh().from(h)];
  for (std::size_t at = 0; at < front_.size(); ++at) {
    if (most != kNone && front_.size() > static_cast<std::size_t>(most)) return false;
    const FaceCycles::Tile& tile = cycles_.tile(front_[at]);
    const Vec3 middle(tile.centre[0], tile.centre[1], tile.centre[2]);
    const double room = radius - tile.radius;
    if (room > 0 && (middle - centre).squaredNorm() <= room * room) {
      add_whole(front_[at], normal);
    } else if (tile.radius <= kSmallFace * radius) {
      add_small(front_[at], centre, radius, normal);
    } else {
      add_large(front_[at], centre, radius, normal);
    }
  }
  return true;
}

/// Of the faces on the front from `centre`.
double BallWalker::median_distance(const Vec3& centre) {
  distance_.clear();
  for (const Index face : front_) {
    const FaceCycles::Tile& tile = cycles_.tile(face);
    const Vec3 middle(tile.centre[0], tile.centre[1], tile.centre[2]);
    distance_.push_back(static_cast<float>((middle - centre).norm()));
  }
  const auto middle = distance_.begin() + static_cast<std::ptrdiff_t>(distance_.size() / 2);
  std::nth_element(distance_.begin(), middle, distance_.end());
  return *middle;
}

std::array<double, 6> BallWalker::tensor(Index h, const Vec3& normal, const BallSize& size) {
  const Vec3& centre = cycles_.mesh().positions[cycles_.mesh().from(h)];
  double radius = size.radius;
  while (!sum(h, normal, radius, radius > size.least_radius ? size.most_faces : kNone)) {
    radius = std::max(size.least_radius, std::min(radius / 2, median_distance(centre)));
  }
  if (radius < size.radius) ++shrunk_;
  std::array<double, 6> tensor = sum_;
  if (area_ > 0) {
    for (double& entry : tensor) entry /= area_;
  }
  return tensor;
}

}  // namespace strake
