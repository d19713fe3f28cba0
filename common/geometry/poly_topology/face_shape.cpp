#include "common/geometry/poly_topology/face_shape.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "common/geometry/angles.h"

namespace strake {
namespace {

constexpr double kConcaveTolerance = 1e-9;
constexpr std::size_t kLargePolygon = 256;
/// Areas and lengths that differ by less than this share of the larger one are told apart by
/// rounding alone.
constexpr double kTie = 1e-9;

/// How comparisons end that rounding decides, as whether a corner lies on an edge.
struct Ties {
  double area = 0;    ///< share of the face's area below which a triangle has none
  double length = 0;  ///< share by which a later diagonal or ear must be better to be taken
};

constexpr double kThinAngle = 10 * kDegree;

bool is_thin_face(std::span<const Vec3> positions, std::span<const Index> face) {
  const std::size_t n = face.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3& p = positions[face[i]];
    const Vec3 back = positions[face[(i + n - 1) % n]] - p;
    if (angle_between(back, positions[face[(i + 1) % n]] - p) < kThinAngle) return true;
  }
  return false;
}

/// Cuts ears off one polygon.
class EarCutter {
 public:
  EarCutter(std::span<const Vec3> positions, std::span<const Index> face, const Ties& ties)
      : positions_(positions),
        normal_(newell_normal(positions, face)),
        no_area_(ties.area * normal_.squaredNorm()),
        better_(1 + ties.length),
        ring_(face.begin(), face.end()),
        take_first_(face.size() > kLargePolygon) {}

  void cut(std::vector<std::array<Index, 3>>& triangles) {
    while (ring_.size() > 3) {
      const std::size_t ear = best_ear();
      triangles.push_back({before(ear), ring_[ear], after(ear)});
      ring_.erase(ring_.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    triangles.push_back({ring_[0], ring_[1], ring_[2]});
  }

 private:
  [[nodiscard]] double area_along_normal(Index a, Index b, Index c) const {
    return (positions_[b] - positions_[a]).cross(positions_[c] - positions_[a]).dot(normal_);
  }
  [[nodiscard]] Index before(std::size_t i) const {
    return ring_[(i + ring_.size() - 1) % ring_.size()];
  }
  [[nodiscard]] Index after(std::size_t i) const { return ring_[(i + 1) % ring_.size()]; }

  /// A corner that is none of an ear when it is upright lies in the one across, and the other way
  /// round: so ties end the other way here. Corners of the ear are told by their places, as the
  /// bridge to a hole may be written with vertices of its own for either side.
  [[nodiscard]] bool is_empty(Index a, Index b, Index c) const {
    const auto is_at = [&](Index q, Index corner) {
      return q == corner || positions_[q] == positions_[corner];
    };
    return std::none_of(ring_.begin(), ring_.end(), [&](Index q) {
      return !is_at(q, a) && !is_at(q, b) && !is_at(q, c) &&
             area_along_normal(a, b, q) >= -no_area_ && area_along_normal(b, c, q) >= -no_area_ &&
             area_along_normal(c, a, q) >= -no_area_;
    });
  }

  std::size_t best_ear() {
    double best = -1;
    std::size_t best_at = 1;  // where no ear is valid the polygon crosses itself: go on as a fan
    for (std::size_t k = 0; k < ring_.size(); ++k) {
      const std::size_t i = (start_ + k) % ring_.size();
      const Index a = before(i);
      const Index b = ring_[i];
      const Index c = after(i);
      if (area_along_normal(a, b, c) <= no_area_) continue;
      const double shape = smallest_angle(positions_[a], positions_[b], positions_[c]);
      if (shape <= better_ * best || !is_empty(a, b, c)) continue;
      best = shape;
      best_at = i;
      if (take_first_) {
        start_ = i + 1;  // step on, so that ears do not gather around one corner
        break;
      }
    }
    return best_at;
  }

  std::span<const Vec3> positions_;
  Vec3 normal_;
  double no_area_;
  double better_;
  std::vector<Index> ring_;
  bool take_first_;
  std::size_t start_ = 0;  // where the search for the next ear begins
};

void triangulate_quad(std::span<const Vec3> positions, std::span<const Index> c, const Ties& ties,
                      std::vector<std::array<Index, 3>>& triangles) {
  const Vec3 normal = newell_normal(positions, c);
  const double no_area = ties.area * normal.squaredNorm();
  const auto faces_along = [&](int i, int j, int k) {
    const Vec3& p = positions[c[i]];
    return (positions[c[j]] - p).cross(positions[c[k]] - p).dot(normal) > no_area;
  };
  const bool valid_02 = faces_along(0, 1, 2) && faces_along(0, 2, 3);
  const bool valid_13 = faces_along(1, 2, 3) && faces_along(1, 3, 0);
  const bool shorter_02 = (positions[c[0]] - positions[c[2]]).squaredNorm() <=
                          (1 + ties.length) * (positions[c[1]] - positions[c[3]]).squaredNorm();
  if (valid_02 != valid_13 ? valid_02 : shorter_02) {
    triangles.push_back({c[0], c[1], c[2]});
    triangles.push_back({c[0], c[2], c[3]});
  } else {
    triangles.push_back({c[1], c[2], c[3]});
    triangles.push_back({c[1], c[3], c[0]});
  }
}

void triangulate(std::span<const Vec3> positions, std::span<const Index> face, const Ties& ties,
                 std::vector<std::array<Index, 3>>& triangles) {
  if (face.size() < 3) return;
  if (face.size() == 3) {
    triangles.push_back({face[0], face[1], face[2]});
  } else if (face.size() == 4) {
    triangulate_quad(positions, face, ties, triangles);
  } else {
    EarCutter(positions, face, ties).cut(triangles);
  }
}

FaceTriangles triangulate_all(const PolyMesh& mesh, std::span<const Vec3> positions,
                              const Ties& ties) {
  FaceTriangles result;
  std::vector<std::size_t> first = {0};  // of a face, and the end
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const std::size_t sides = mesh.face(f).size();
    first.push_back(first.back() + (sides > 2 ? sides - 2 : 0));
    result.face.resize(first.back(), f);
  }
  result.corners.resize(first.back());
  tbb::parallel_for(tbb::blocked_range<Index>(0, mesh.face_count()), [&](const auto& faces) {
    std::vector<std::array<Index, 3>> own;
    for (Index f = faces.begin(); f < faces.end(); ++f) {
      own.clear();
      triangulate(positions, mesh.face(f), ties, own);
      std::ranges::copy(own, result.corners.begin() + static_cast<std::ptrdiff_t>(first[f]));
    }
  });
  return result;
}

/// The corner that all triangles of a face share; where there is none, the first one of the face.
std::size_t fan_corner(std::span<const Index> face,
                       std::span<const std::array<Index, 3>> triangles) {
  const auto is_shared = [&](Index v) {
    return std::ranges::all_of(triangles,
                               [&](const auto& t) { return std::ranges::find(t, v) != t.end(); });
  };
  const auto at = std::ranges::find_if(face, is_shared);
  return at == face.end() ? 0 : static_cast<std::size_t>(at - face.begin());
}

}  // namespace

Vec3 newell_normal(std::span<const Vec3> positions, std::span<const Index> face) {
  Vec3 normal = Vec3::Zero();
  const Vec3& origin = positions[face[0]];
  for (std::size_t i = 1; i + 1 < face.size(); ++i) {
    normal += (positions[face[i]] - origin).cross(positions[face[i + 1]] - origin);
  }
  return normal;
}

bool is_concave_face(std::span<const Vec3> positions, std::span<const Index> face) {
  if (face.size() < 4) return false;
  const Vec3 normal = newell_normal(positions, face).normalized();
  const std::size_t n = face.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3& p = positions[face[i]];
    const Vec3 ahead = positions[face[(i + 1) % n]] - p;
    const Vec3 back = positions[face[(i + n - 1) % n]] - p;
    if (ahead.cross(back).dot(normal) < -kConcaveTolerance * ahead.norm() * back.norm()) {
      return true;
    }
  }
  return false;
}

double thin_face_share(const PolyMesh& mesh) {
  if (mesh.face_count() == 0) return 0;
  Index thin = 0;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    if (is_thin_face(mesh.positions, mesh.face(f))) ++thin;
  }
  return double(thin) / mesh.face_count();
}

void triangulate_face(std::span<const Vec3> positions, std::span<const Index> face,
                      std::vector<std::array<Index, 3>>& triangles) {
  triangulate(positions, face, {}, triangles);
}

FaceTriangles triangulate_faces(const PolyMesh& mesh) {
  return triangulate_faces(mesh, mesh.positions);
}

FaceTriangles triangulate_faces(const PolyMesh& mesh, std::span<const Vec3> positions) {
  return triangulate_all(mesh, positions, {});
}

std::vector<FaceTriangles> other_triangulations(const PolyMesh& mesh) {
  std::vector<FaceTriangles> all = {triangulate_faces(mesh)};
  for (const double area : {-kTie, kTie}) {
    for (const double length : {-kTie, kTie}) {
      FaceTriangles other = triangulate_all(mesh, mesh.positions, {area, length});
      const auto is_same = [&](const FaceTriangles& t) { return t.corners == other.corners; };
      if (std::ranges::none_of(all, is_same)) all.push_back(std::move(other));
    }
  }
  all.erase(all.begin());
  return all;
}

void begin_faces_at_fans(PolyMesh& mesh) {
  const FaceTriangles all = triangulate_faces(mesh);
  std::size_t first = 0;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const std::size_t sides = mesh.face(f).size();
    if (sides < 3) continue;
    const std::span own(all.corners.data() + first, sides - 2);
    first += sides - 2;
    if (sides == 3) continue;
    const auto corners = mesh.corners.begin() + mesh.offsets[f];
    std::rotate(corners, corners + static_cast<std::ptrdiff_t>(fan_corner(mesh.face(f), own)),
                corners + static_cast<std::ptrdiff_t>(sides));
  }
}

}  // namespace strake
