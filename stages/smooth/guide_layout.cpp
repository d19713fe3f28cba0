#include "stages/smooth/guide_layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/core/error.h"
#include "common/geometry/frames.h"
#include "common/geometry/surface_distance/surface_distance.h"

namespace strake {
namespace {

constexpr double kFarthest = 0.02;   ///< of a guide from the surface, share of the diagonal
constexpr double kShortPiece = 0.1;  ///< against the root of the area of the face it lies in
constexpr double kShortest = 1e-7;   ///< of any piece, share of the diagonal
constexpr double kOnSurface = 1e-6;  ///< share of the diagonal

class GuideLayer {
 public:
  GuideLayer(const TriMesh& mesh, const GuideLines& guides)
      : mesh_(mesh), guides_(guides), surface_(mesh.positions, mesh.faces) {}

  LaidGuides lay() {
    for (line_ = 0; line_ < guides_.lines.size(); ++line_) {
      const std::vector<Vec3>& points = guides_.lines[line_];
      Place last = place(points.front() - mesh_.origin);
      for (std::size_t i = 1; i < points.size(); ++i) {
        const Place next = place(points[i] - mesh_.origin);
        lay_between(last, next);
        last = next;
      }
      const auto pieces = static_cast<Index>(laid_.face.size());
      if (pieces > laid_.offsets.back()) laid_.offsets.push_back(pieces);
    }
    if (laid_.line_count() == 0) {
      throw InputError(fmt::format(
          "'{}' has no guide line that runs along the surface; draw one on it", guides_.name));
    }
    return std::move(laid_);
  }

 private:
  /// A point of a guide and the nearest point of the surface.
  struct Place {
    Vec3 point;
    ClosestPoint foot;
  };

  [[nodiscard]] Place place(const Vec3& point) const {
    const ClosestPoint foot = surface_.closest_within(point, kFarthest * mesh_.diagonal);
    if (foot.triangle != kNone) return {point, foot};
    const Vec3 at = point + mesh_.origin;
    throw InputError(fmt::format(
        "'{}', guide {}: at ({}, {}, {}) it is {:.3g} from the surface, more than {:g} % of its "
        "diagonal; draw it nearer to the surface, or with more points",
        guides_.name, line_ + 1, at.x(), at.y(), at.z(), surface_.closest(point).distance,
        100 * kFarthest));
  }

  void lay_between(const Place& begin, const Place& end) {
    const Place middle = place(0.5 * (begin.point + end.point));
    const Index face = middle.foot.triangle;
    const bool is_inside = begin.foot.triangle == face && end.foot.triangle == face;
    const double shortest =
        std::max(kShortPiece * std::sqrt(face_area(mesh_, face)), kShortest * mesh_.diagonal);
    if (!is_inside && (end.point - begin.point).norm() > shortest) {
      lay_between(begin, middle);
      lay_between(middle, end);
    } else if (touch(begin.foot.triangle, face) && touch(face, end.foot.triangle) &&
               !is_beside(middle.foot)) {
      add(begin, middle, end);
    }
  }

  void add(const Place& begin, const Place& middle, const Place& end) {
    const Index face = middle.foot.triangle;
    const Vec3 step = surface_.point(end.foot) - surface_.point(begin.foot);
    const Vec3 normal = face_cross(mesh_, face).normalized();
    const Vec3 flat = step - normal * normal.dot(step);
    if (!(flat.norm() > kOnSurface * kShortest * mesh_.diagonal)) return;
    const auto& b = middle.foot.barycentric;
    laid_.face.push_back(face);
    laid_.barycentric.emplace_back(b[0], b[1], b[2]);
    laid_.step.push_back(flat);
  }

  [[nodiscard]] bool touch(Index a, Index b) const {
    const auto& other = mesh_.faces[b];
    return std::any_of(mesh_.faces[a].begin(), mesh_.faces[a].end(), [&](Index vertex) {
      return std::find(other.begin(), other.end(), vertex) != other.end();
    });
  }

  /// Whether the guide runs beside the surface here, off its boundary.
  [[nodiscard]] bool is_beside(const ClosestPoint& foot) const {
    if (foot.distance <= kOnSurface * mesh_.diagonal) return false;
    for (Index i = 0; i < 3; ++i) {
      const Index opposite = TriMesh::next(3 * foot.triangle + i);
      if (foot.barycentric[i] == 0 && mesh_.is_boundary(opposite)) return true;
    }
    return false;
  }

  const TriMesh& mesh_;
  const GuideLines& guides_;
  SurfaceDistance surface_;
  LaidGuides laid_;
  std::size_t line_ = 0;
};

}  // namespace

LaidGuides lay_guides(const TriMesh& mesh, const GuideLines& guides) {
  return GuideLayer(mesh, guides).lay();
}

}  // namespace strake
