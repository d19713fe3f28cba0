#include "stages/trace/face_blocks.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "common/geometry/frames.h"
#include "common/geometry/segment.h"
#include "stages/trace/face_rows.h"

namespace strake {
namespace {

/// Radius of a block, as a share of the smallest line distance there. Smaller ones hold fewer lines
/// that are too far away, but a look around comes to more of them.
constexpr double kBlockSize = 1.0;
/// Length of the longest edge of a large face, likewise.
constexpr double kLarge = 1.5;
/// Cosine of the angle between the normals of faces of a block and of its first one, at least.
constexpr double kLeastAgreement = 0.5;
/// Share of the largest coordinate by which single precision may round a place, doubled.
constexpr double kRoundingOfFloats = 2.5e-7;

Vec3 centroid(const TriMesh& mesh, Index face) {
  const auto& [a, b, c] = mesh.faces[face];
  return (mesh.positions[a] + mesh.positions[b] + mesh.positions[c]) / 3;
}

double largest_coordinate(const TriMesh& mesh) {
  double largest = 0;
  for (const Vec3& p : mesh.positions) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  return largest;
}

/// Slabs of a face hold so many line distances, and are not more than that.
constexpr double kLinesPerSlab = 4;
constexpr double kMostSlabs = 1024;
constexpr double kPlaceRounding = 1e-9;

}  // namespace

double least_spacing(const TriMesh& mesh, const Spacing& spacing, Index face) {
  double least = std::numeric_limits<double>::infinity();
  for (const Index w : mesh.face_wedges[face]) {
    least = std::min({least, spacing.along[w], spacing.across[w]});
  }
  return least;
}

bool is_large_face(const TriMesh& mesh, const Spacing& spacing, Index face) {
  return face_rows(mesh, face).longest >= kLarge * least_spacing(mesh, spacing, face);
}

FaceBlocks::FaceBlocks(const TriMesh& mesh, const Spacing& spacing,
                       const std::vector<std::uint8_t>& barriers)
    : mesh_(mesh), barriers_(barriers), block_of_(mesh.face_count(), kNone) {
  const double rounding = kRoundingOfFloats * largest_coordinate(mesh);
  faces_.reserve(mesh.face_count());
  first_face_.push_back(0);
  for (Index first = 0; first < mesh.face_count(); ++first) {
    if (block_of_[first] != kNone) continue;
    gather(first, spacing);
    balls_.push_back(ball_around(faces(count()), rounding));
  }
  find_ways();
  cut(spacing);
}

void FaceBlocks::cut(const Spacing& spacing) {
  first_slab_.push_back(0);
  for (Index block = 0; block < count(); ++block) {
    Index slabs = 1;
    if (is_single(block)) {
      const Index face = faces(block).front();
      const double lines = face_rows(mesh_, face).longest / least_spacing(mesh_, spacing, face);
      slabs = static_cast<Index>(std::clamp(lines / kLinesPerSlab, 1.0, kMostSlabs));
    }
    first_slab_.push_back(first_slab_.back() + slabs);
  }
}

std::pair<Index, Index> FaceBlocks::slabs(Index block, const Vec3& a, const Vec3& b,
                                          double distance) const {
  const Index first = first_slab_[block];
  const Index count = first_slab_[block + 1] - first;
  if (count == 1) return {first, first + 1};
  const FaceRows rows = face_rows(mesh_, faces(block).front());
  const auto slab_at = [&](double place) {
    return first + static_cast<Index>(std::clamp(count * place / rows.longest, 0.0, count - 1.0));
  };
  const auto [low, high] = std::minmax({rows.place(a), rows.place(b)});
  const double margin = (1 + kPlaceRounding) * distance + kPlaceRounding * rows.longest;
  return {slab_at(low - margin), slab_at(high + margin) + 1};
}

/// Appends the next block: what is connected to a face, free yet, near to its middle, and faces
/// about the same way.
void FaceBlocks::gather(Index first, const Spacing& spacing) {
  const Index block = count();
  const std::size_t begin = faces_.size();
  const double size = kBlockSize * least_spacing(mesh_, spacing, first);
  const Vec3 middle = centroid(mesh_, first);
  const Vec3 normal = face_cross(mesh_, first);
  const auto is_near = [&](Index v) {
    return (mesh_.positions[v] - middle).squaredNorm() <= size * size;
  };
  const auto is_alike = [&](Index f) {
    const Vec3 other = face_cross(mesh_, f);
    return !(normal.dot(other) < kLeastAgreement * normal.norm() * other.norm());
  };
  const auto belongs = [&](Index f) {
    return std::ranges::all_of(mesh_.faces[f], is_near) && is_alike(f) &&
           !is_large_face(mesh_, spacing, f);
  };
  block_of_[first] = block;
  faces_.push_back(first);
  const bool is_alone = is_large_face(mesh_, spacing, first);
  for (std::size_t at = begin; at < faces_.size() && !is_alone; ++at) {
    for (Index h = 3 * faces_[at], i = 0; i < 3; ++i, ++h) {
      if (ends_at(h)) continue;
      const Index other = TriMesh::face_of(mesh_.twin[h]);
      if (block_of_[other] != kNone || !belongs(other)) continue;
      block_of_[other] = block;
      faces_.push_back(other);
    }
  }
  first_face_.push_back(static_cast<Index>(faces_.size()));
}

FaceBlocks::Ball FaceBlocks::ball_around(std::span<const Index> faces, double rounding) const {
  Vec3 centre = Vec3::Zero();
  for (const Index f : faces) centre += centroid(mesh_, f);
  centre /= static_cast<double>(faces.size());
  double radius = 0;
  for (const Index f : faces) {
    for (const Index v : mesh_.faces[f]) {
      radius = std::max(radius, (mesh_.positions[v] - centre).squaredNorm());
    }
  }
  Ball ball;
  for (int i = 0; i < 3; ++i) ball.centre[i] = static_cast<float>(centre[i]);
  ball.radius = static_cast<float>(std::sqrt(radius) + rounding);
  return ball;
}

void FaceBlocks::find_ways() {
  std::vector<Index> seen_from(count(), kNone);
  first_way_.push_back(0);
  for (Index block = 0; block < count(); ++block) {
    for (const Index f : faces(block)) {
      for (Index h = 3 * f; h < 3 * f + 3; ++h) {
        if (ends_at(h)) continue;
        const Index other = block_of_[TriMesh::face_of(mesh_.twin[h])];
        if (other == block) continue;
        // The edges of large faces: their balls tell little.
        if (is_single(block) || is_single(other)) {
          ways_.push_back({other, h});
        } else if (std::exchange(seen_from[other], block) != block) {
          ways_.push_back({other, kNone});
        }
      }
    }
    first_way_.push_back(static_cast<Index>(ways_.size()));
  }
}

void BlockWalk::start(Index face) {
  if (++current_ == 0) {
    std::fill(stamp_.begin(), stamp_.end(), 0U);
    current_ = 1;
  }
  const Index first = blocks_.block_of(face);
  stamp_[first] = current_;
  cell_.assign(1, first);
}

void BlockWalk::go_on_from(Index block, const Vec3& point, double distance) {
  const TriMesh& mesh = blocks_.mesh_;
  for (Index w = blocks_.first_way_[block]; w < blocks_.first_way_[block + 1]; ++w) {
    const auto [other, h] = blocks_.ways_[w];
    if (stamp_[other] == current_ || !is_within(other, point, distance)) continue;
    if (h != kNone &&
        (way_to_segment(point, mesh.positions[mesh.from(h)], mesh.positions[mesh.to(h)])
             .squaredNorm() > distance * distance)) {
      continue;
    }
    stamp_[other] = current_;
    cell_.push_back(other);
  }
}

}  // namespace strake
