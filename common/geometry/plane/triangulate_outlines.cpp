#include "common/geometry/plane/triangulate_outlines.h"

#include <geos_c.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <utility>

namespace strake {
namespace {

/// Angles, radians, by which a drawing is turned until GEOS takes it: where the lowest points of
/// holes share a coordinate, as in a grid, it may fail to join these to the outline.
constexpr std::array<double, 3> kTurns = {0, 1, 2};
/// Share of the area by which triangles may miss it.
constexpr double kRounding = 1e-9;

using Outline = std::vector<Index>;
using Triangle = std::array<Index, 3>;

double signed_area(const std::vector<Vec2>& points, const Outline& outline) {
  double twice = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec2 a = points[outline[i]] - points[outline[0]];
    const Vec2 b = points[outline[(i + 1) % outline.size()]] - points[outline[0]];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return twice / 2;
}

/// The part of GEOS that is needed, without messages on the console.
class Geos {
 public:
  using Geometry = std::unique_ptr<GEOSGeometry, std::function<void(GEOSGeometry*)>>;

  Geos() : handle_(GEOS_init_r()) {}
  ~Geos() { GEOS_finish_r(handle_); }
  Geos(const Geos&) = delete;
  Geos& operator=(const Geos&) = delete;

  /// The area inside of some outlines and outside of others; nothing where they cross.
  [[nodiscard]] Geometry area_within(const std::vector<Vec2>& points,
                                     const std::vector<Outline>& outlines) const {
    std::vector<GEOSGeometry*> sides;
    for (const Outline& outline : outlines) {
      for (std::size_t i = 0; i < outline.size(); ++i) {
        sides.push_back(line(points[outline[i]], points[outline[(i + 1) % outline.size()]]));
      }
    }
    const Geometry drawing = owned(GEOSGeom_createCollection_r(
        handle_, GEOS_MULTILINESTRING, sides.data(), static_cast<unsigned>(sides.size())));
    Geometry area = owned(GEOSBuildArea_r(handle_, drawing.get()));
    if (area && GEOSisValid_r(handle_, area.get()) != 1) area.reset();
    return area;
  }

  /// The corners of each triangle; nothing where GEOS fails.
  [[nodiscard]] std::vector<std::array<Vec2, 3>> triangulate(const Geometry& area) const {
    const Geometry triangles = owned(GEOSConstrainedDelaunayTriangulation_r(handle_, area.get()));
    std::vector<std::array<Vec2, 3>> corners;
    const int count = triangles ? GEOSGetNumGeometries_r(handle_, triangles.get()) : 0;
    for (int t = 0; t < count; ++t) {
      const GEOSGeometry* triangle = GEOSGetGeometryN_r(handle_, triangles.get(), t);
      const GEOSCoordSequence* sequence =
          GEOSGeom_getCoordSeq_r(handle_, GEOSGetExteriorRing_r(handle_, triangle));
      std::array<Vec2, 3> places;
      for (unsigned i = 0; i < 3; ++i) {
        GEOSCoordSeq_getXY_r(handle_, sequence, i, &places[i].x(), &places[i].y());
      }
      corners.push_back(places);
    }
    return corners;
  }

 private:
  [[nodiscard]] GEOSGeometry* line(const Vec2& a, const Vec2& b) const {
    GEOSCoordSequence* ends = GEOSCoordSeq_create_r(handle_, 2, 2);
    GEOSCoordSeq_setXY_r(handle_, ends, 0, a.x(), a.y());
    GEOSCoordSeq_setXY_r(handle_, ends, 1, b.x(), b.y());
    return GEOSGeom_createLineString_r(handle_, ends);
  }

  [[nodiscard]] Geometry owned(GEOSGeometry* geometry) const {
    return {geometry, [this](GEOSGeometry* g) { GEOSGeom_destroy_r(handle_, g); }};
  }

  GEOSContextHandle_t handle_;
};

/// The points by their places; nothing where two are at the same.
std::optional<std::map<std::pair<double, double>, Index>> point_at_place(
    const std::vector<Vec2>& points, const std::vector<Outline>& outlines) {
  std::map<std::pair<double, double>, Index> point_at;
  for (const Outline& outline : outlines) {
    for (const Index p : outline) {
      const auto [at, is_new] = point_at.try_emplace({points[p].x(), points[p].y()}, p);
      if (!is_new && at->second != p) return std::nullopt;
    }
  }
  return point_at;
}

/// Triangles of points; nothing where they do not fill what the outlines bound.
std::vector<Triangle> triangulate_area(const Geos& geos, const Geos::Geometry& area,
                                       const std::vector<Vec2>& points,
                                       const std::vector<Outline>& outlines) {
  const auto point_at = point_at_place(points, outlines);
  if (!point_at) return {};
  double left = 0;
  for (const Outline& outline : outlines) left += signed_area(points, outline);
  const double whole = left;
  std::vector<Triangle> triangles;
  for (const auto& corners : geos.triangulate(area)) {
    Triangle triangle{};
    for (int i = 0; i < 3; ++i) {
      const auto at = point_at->find({corners[i].x(), corners[i].y()});
      if (at == point_at->end()) return {};
      triangle[i] = at->second;
    }
    const double size = signed_area(points, Outline(triangle.begin(), triangle.end()));
    if (size < 0) std::swap(triangle[1], triangle[2]);
    left -= std::abs(size);
    triangles.push_back(triangle);
  }
  if (!(std::abs(left) <= kRounding * whole)) return {};
  return triangles;
}

}  // namespace

std::vector<Triangle> triangulate_outlines(const std::vector<Vec2>& points,
                                           const std::vector<Outline>& outlines) {
  const Geos geos;
  for (const double turn : kTurns) {
    std::vector<Vec2> turned = points;
    for (Vec2& point : turned) point = Eigen::Rotation2Dd(turn) * point;
    const Geos::Geometry area = geos.area_within(turned, outlines);
    if (!area) break;
    std::vector<Triangle> triangles = triangulate_area(geos, area, turned, outlines);
    if (!triangles.empty()) return triangles;
  }
  return {};
}

}  // namespace strake
