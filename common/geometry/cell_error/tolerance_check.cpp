#include "common/geometry/cell_error/tolerance_check.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>

namespace strake {
namespace {

/// Pieces with edges shorter than this share of the tolerance are not halved any more.
constexpr double kSmallestPiece = 0.02;
/// A point of a triangle is at most this share of the longest edge from the nearest corner; rounded
/// up.
constexpr double kFarthestInside = 0.57736;
/// Corners in a row of which each is looked for near the foot of the one before.
constexpr std::size_t kCornersInARow = 64;

struct Corner {
  Vec3 place;
  ClosestPoint foot;
};
using Piece = std::array<Corner, 3>;

/// Proves pieces of one surface to be near the other one, or finds where they are not.
class PieceCheck {
 public:
  PieceCheck(const SurfaceDistance& other, double tolerance)
      : other_(other), tolerance_(tolerance) {}

  /// \param guess  triangle of the other surface near `p`; kNone: none is known
  [[nodiscard]] Corner corner(const Vec3& p, Index guess) const {
    return {p, other_.closest_near(p, guess)};
  }

  /// Calls found(corner, distance) for places of the piece that are too far, or not proven not to
  /// be.
  template <class Found>
  void check(const Piece& piece, const Found& found) const {
    const auto worst = std::max_element(
        piece.begin(), piece.end(),
        [](const Corner& a, const Corner& b) { return a.foot.distance < b.foot.distance; });
    if (worst->foot.distance > tolerance_) {
      found(*worst, worst->foot.distance);
      return;
    }
    int longest = 0;
    for (int i = 1; i < 3; ++i) {
      if (edge(piece, i) > edge(piece, longest)) longest = i;
    }
    if (worst->foot.distance + kFarthestInside * edge(piece, longest) <= tolerance_) return;
    const double bound = upper_bound(piece);
    if (bound <= tolerance_) return;
    if (edge(piece, longest) < kSmallestPiece * tolerance_) {
      found(*worst, bound);
      return;
    }
    const Corner& a = piece[longest];
    const Corner& b = piece[(longest + 1) % 3];
    const Corner& c = piece[(longest + 2) % 3];
    const Corner middle = corner(0.5 * (a.place + b.place), a.foot.triangle);
    check({a, middle, c}, found);
    check({middle, b, c}, found);
  }

 private:
  static double edge(const Piece& piece, int i) {
    return (piece[i].place - piece[(i + 1) % 3].place).norm();
  }

  /// The least, over the triangles nearest to the corners, of the distance that no point of the
  /// piece exceeds.
  [[nodiscard]] double upper_bound(const Piece& piece) const {
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i) {
      const auto& t = other_.triangles()[piece[i].foot.triangle];
      const auto& p = other_.positions();
      double largest = piece[i].foot.distance;
      for (int j = 0; j < 3 && largest < least; ++j) {
        if (j == i) continue;
        largest = std::max(
            largest, closest_point_on_triangle(piece[j].place, p[t[0]], p[t[1]], p[t[2]]).distance);
      }
      least = std::min(least, largest);
    }
    return least;
  }

  const SurfaceDistance& other_;
  double tolerance_;
};

/// The worst place of one triangle.
struct Worst {
  double distance = 0;
  Vec3 place = Vec3::Zero();
  Index on_other = kNone;
};

/// [triangles] of one surface.
std::vector<Worst> check_surface(const SurfaceDistance& own, const SurfaceDistance& other,
                                 double tolerance) {
  const PieceCheck check(other, tolerance);
  std::vector<Corner> corners(own.positions().size());
  std::vector<char> used(corners.size(), 0);
  for (const auto& triangle : own.triangles()) {
    for (const Index v : triangle) used[v] = 1;
  }
  const tbb::blocked_range<std::size_t> all(0, corners.size(), kCornersInARow);
  tbb::parallel_for(all, [&](const auto& row) {
    Index guess = kNone;
    for (std::size_t v = row.begin(); v < row.end(); ++v) {
      if (used[v] == 0) continue;
      corners[v] = check.corner(own.positions()[v], guess);
      guess = corners[v].foot.triangle;
    }
  });
  std::vector<Worst> worst(own.triangles().size());
  tbb::parallel_for(std::size_t{0}, worst.size(), [&](std::size_t t) {
    const auto& [a, b, c] = own.triangles()[t];
    check.check({corners[a], corners[b], corners[c]}, [&](const Corner& at, double distance) {
      if (distance > worst[t].distance) worst[t] = {distance, at.place, at.foot.triangle};
    });
  });
  return worst;
}

/// \param cell  [triangles of the result] its face
std::vector<Excess> check_both_ways(const SurfaceDistance& result, const std::vector<Index>& cell,
                                    const SurfaceDistance& input, double tolerance) {
  std::vector<Excess> excess;
  const std::vector<Worst> of_result = check_surface(result, input, tolerance);
  for (std::size_t t = 0; t < of_result.size(); ++t) {
    const Worst& worst = of_result[t];
    if (worst.on_other != kNone) excess.push_back({worst.distance, worst.place, cell[t], kNone});
  }
  const std::vector<Worst> of_input = check_surface(input, result, tolerance);
  for (std::size_t t = 0; t < of_input.size(); ++t) {
    const Worst& worst = of_input[t];
    if (worst.on_other == kNone) continue;
    excess.push_back({worst.distance, worst.place, cell[worst.on_other], static_cast<Index>(t)});
  }
  return excess;
}

}  // namespace

std::vector<Excess> check_tolerance(const ComparedSurfaces& surfaces, double tolerance) {
  return check_both_ways(surfaces.result(), surfaces.triangles().face, surfaces.input(), tolerance);
}

std::vector<Index> cells_in_doubt(const ComparedSurfaces& surfaces, double tolerance) {
  std::vector<Index> in_doubt;
  for (const FaceTriangles& other : other_triangulations(surfaces.faces())) {
    const SurfaceDistance result(surfaces.positions(), other.corners);
    const auto excess = check_both_ways(result, other.face, surfaces.input(), tolerance);
    if (excess.empty()) continue;
    std::vector<char> is_near(surfaces.positions().size(), 0);
    for (const Excess& e : excess) {
      for (const Index v : surfaces.faces().face(e.cell)) is_near[v] = 1;
    }
    const auto touches = [&](Index cell) {
      return std::ranges::any_of(surfaces.faces().face(cell),
                                 [&](Index v) { return is_near[v] != 0; });
    };
    for (std::size_t t = 0; t < other.corners.size(); ++t) {
      if (other.corners[t] == surfaces.triangles().corners[t]) continue;
      if (touches(other.face[t])) in_doubt.push_back(other.face[t]);
    }
  }
  std::ranges::sort(in_doubt);
  in_doubt.erase(std::unique(in_doubt.begin(), in_doubt.end()), in_doubt.end());
  return in_doubt;
}

}  // namespace strake
