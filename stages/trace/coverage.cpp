#include "stages/trace/coverage.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

#include "stages/trace/face_rows.h"

namespace strake {
namespace {

/// Distance of samples inside large faces, in line distances.
constexpr double kSampleDistance = 0.8;
constexpr int kMostSamplesPerFace = 20000;
constexpr double kRoundingOfPlaces = 1e-9;  ///< of places along a face
constexpr std::uint8_t kBothArms = 3;       ///< the bits of arm_bit

/// Bit of the arm of a cross that a direction follows.
std::uint8_t arm_bit(const Vec3& arm, const Vec3& flat) {
  const double c = arm.dot(flat);
  return c * c >= 0.5 * flat.squaredNorm() ? 1 : 2;
}

}  // namespace

Coverage::Coverage(const TraceDomain& domain, const FaceBlocks& blocks)
    : domain_(domain), blocks_(blocks), wedge_marks_(domain.mesh.wedge_count(), 0) {
  const TriMesh& mesh = domain.mesh;
  offsets_.reserve(static_cast<std::size_t>(mesh.face_count()) + 1);
  offsets_.push_back(0);
  for (Index f = 0; f < mesh.face_count(); ++f) {
    sample_face(f);
    offsets_.push_back(static_cast<Index>(points_.size()));
  }
  std::vector<std::uint8_t> has_corner(wedge_marks_.size(), 0);
  corners_.reserve(wedge_marks_.size());
  first_corner_.push_back(0);
  for (Index block = 0; block < blocks.count(); ++block) {
    for (const Index f : blocks.faces(block)) {
      for (Index h = 3 * f; h < 3 * f + 3; ++h) {
        if (std::exchange(has_corner[mesh.wedge_of(h)], 1) == 0) corners_.push_back(h);
      }
    }
    open_corners_.push_back(static_cast<Index>(corners_.size()) - first_corner_.back());
    first_corner_.push_back(static_cast<Index>(corners_.size()));
  }
}

/// Rows of samples parallel to the longest edge, each a line distance from the next.
void Coverage::sample_face(Index face) {
  if (!is_large_face(domain_.mesh, domain_.spacing, face)) return;
  const FaceRows rows = face_rows(domain_.mesh, face);
  const FieldContext context = field_context(domain_, face);
  const Vec2& a = context.chart.corner[rows.base];
  const Vec2& b = context.chart.corner[(rows.base + 1) % 3];
  const Vec2& top = context.chart.corner[(rows.base + 2) % 3];
  const Vec2 along = (b - a) / rows.longest;
  const double height = along.x() * (top - a).y() - along.y() * (top - a).x();
  const auto distance_at = [&](const Vec2& p) {
    const LocalSpacing local = spacing_at(domain_, context, p, along);
    return kSampleDistance * std::min(local.along, local.to_neighbours);
  };
  int budget = kMostSamplesPerFace;
  double up = std::min(0.5 * height, 0.5 * distance_at(0.5 * (a + b)));
  while (up < height && budget > 0) {
    const double share = up / height;
    const Vec2 start = a + share * (top - a);
    const double width = (1 - share) * rows.longest;
    double next_row = std::numeric_limits<double>::infinity();
    for (double x = std::min(0.5 * width, 0.5 * distance_at(start)); x < width && budget > 0;) {
      const Vec2 p = start + x * along;
      const double step = distance_at(p);
      next_row = std::min(next_row, step);
      Point sample;
      sample.barycentric = context.chart.barycentric(p).cwiseMax(0.0);
      sample.barycentric /= sample.barycentric.sum();
      sample.position = world_point(domain_, context, p);
      const Vec2 arm = field_direction(domain_, context, p, along, LineFamily::minimum);
      sample.arm = world_direction(domain_, context, arm).normalized();
      points_.push_back(sample);
      x += step;
      --budget;
    }
    up += next_row;
  }
  std::stable_sort(points_.begin() + offsets_.back(), points_.end(),
                   [&](const Point& p, const Point& q) {
                     return rows.place(p.position) < rows.place(q.position);
                   });
}

void Coverage::mark(const CoveredDisc& disc, BlockWalk& walk) {
  walk.around(disc.face, disc.point, disc.distance, [&](Index block) {
    if (std::atomic_ref(open_corners_[block]).load(std::memory_order_relaxed) > 0) {
      mark_corners(block, disc);
    }
    // Only large faces have points of their own.
    if (blocks_.is_single(block)) mark_points(blocks_.faces(block).front(), disc);
    return disc.distance;
  });
}

void Coverage::mark_corners(Index block, const CoveredDisc& disc) {
  const TriMesh& mesh = domain_.mesh;
  const double limit = disc.distance * disc.distance;
  for (Index at = first_corner_[block]; at < first_corner_[block + 1]; ++at) {
    const Index w = mesh.wedge_of(corners_[at]);
    const std::atomic_ref marks(wedge_marks_[w]);
    if (marks.load(std::memory_order_relaxed) == kBothArms) continue;
    if ((mesh.positions[mesh.from(corners_[at])] - disc.point).squaredNorm() > limit) continue;
    const Vec3& normal = domain_.field.normal[w];
    const Vec3 flat = disc.direction - normal * normal.dot(disc.direction);
    const std::uint8_t bit = arm_bit(domain_.field.cross[w], flat);
    // Whoever sets the second bit counts the corner: marks only ever grow.
    const std::uint8_t before = marks.fetch_or(bit, std::memory_order_relaxed);
    if (before != kBothArms && (before | bit) == kBothArms) {
      std::atomic_ref(open_corners_[block]).fetch_sub(1, std::memory_order_relaxed);
    }
  }
}

void Coverage::mark_points(Index face, const CoveredDisc& disc) {
  if (offsets_[face] == offsets_[face + 1]) return;
  const FaceRows rows = face_rows(domain_.mesh, face);
  const double middle = rows.place(disc.point);
  const auto first = points_.begin() + offsets_[face];
  const auto last = points_.begin() + offsets_[face + 1];
  const double margin = (1 + kRoundingOfPlaces) * disc.distance;
  const auto is_before = [&](const Point& q) { return rows.place(q.position) < middle - margin; };
  for (auto p = std::partition_point(first, last, is_before);
       p != last && rows.place(p->position) <= middle + margin; ++p) {
    if ((p->position - disc.point).squaredNorm() > disc.distance * disc.distance) continue;
    std::atomic_ref(p->marks).fetch_or(arm_bit(p->arm, disc.direction), std::memory_order_relaxed);
  }
}

Coverage::Gap Coverage::corner_gap(Index face, int corner, int arm) const {
  const Index w = domain_.mesh.face_wedges[face][corner];
  const Vec3& cross = domain_.field.cross[w];
  Gap gap;
  gap.face = face;
  gap.barycentric = Vec3::Constant(0.1);  // inside the face, where a line can start
  gap.barycentric[corner] = 0.8;
  gap.direction = arm == 0 ? cross : Vec3(domain_.field.normal[w].cross(cross));
  return gap;
}

Coverage::Gap Coverage::point_gap(Index face, Index point, int arm) const {
  const Vec3& along = points_[point].arm;
  return {face, points_[point].barycentric,
          arm == 0 ? along : Vec3(domain_.face_normals[face].cross(along))};
}

double Coverage::covered_share() const {
  const std::size_t step = std::max<std::size_t>(1, wedge_marks_.size() / 1000);
  Index covered = 0;
  Index looked = 0;
  for (std::size_t w = 0; w < wedge_marks_.size(); w += step, looked += 2) {
    covered += (wedge_marks_[w] & 1) + (wedge_marks_[w] >> 1 & 1);
  }
  return looked > 0 ? double(covered) / looked : 1;
}

}  // namespace strake
