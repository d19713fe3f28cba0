#include "common/geometry/surface_distance/surface_distance.h"

#include <embree3/rtcore.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <new>

#include "common/core/error.h"

namespace strake {
namespace {

// Coordinates in the hierarchy's frame are rounded by at most 2^-24 of their size, of the query
// point and of the triangle, on three axes, and the hierarchy computes in floats: ten times that is
// a safe margin.
constexpr double kFloatMargin = 1e-6;

/// Squared sine of an angle below which scalar products cancel too much.
constexpr double kThin = 1e-4;

ClosestPoint closest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  const double length2 = ab.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - a).dot(ab) / length2, 0.0, 1.0) : 0.0;
  return {kNone, (p - a - t * ab).norm(), {1 - t, t, 0}};
}

/// Slower, for any triangle: also one without area.
ClosestPoint closest_on_thin_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = (b - a).cross(c - a);
  const double area2 = normal.squaredNorm();
  if (area2 > 0) {
    const double u = normal.dot((b - p).cross(c - p)) / area2;
    const double v = normal.dot((c - p).cross(a - p)) / area2;
    const double w = 1 - u - v;
    // Not by the normal: cancellation leaves little of it, but the point is in the triangle.
    if (u >= 0 && v >= 0 && w >= 0) {
      return {kNone, (p - a - v * (b - a) - w * (c - a)).norm(), {u, v, w}};
    }
  }
  const ClosestPoint on_ab = closest_on_segment(p, a, b);
  const ClosestPoint on_bc = closest_on_segment(p, b, c);
  const ClosestPoint on_ca = closest_on_segment(p, c, a);
  ClosestPoint best = on_ab;
  if (on_bc.distance < best.distance) {
    best = {kNone, on_bc.distance, {0, on_bc.barycentric[0], on_bc.barycentric[1]}};
  }
  if (on_ca.distance < best.distance) {
    best = {kNone, on_ca.distance, {on_ca.barycentric[1], 0, on_ca.barycentric[0]}};
  }
  return best;
}

/// A place in the hierarchy's frame; the fourth is 0. So all of it goes through the processor at
/// once.
using Place = Eigen::Array4f;
constexpr int kPlaceSize = 4;

/// Whether the box around a triangle is beyond the radius of a query, which costs a fraction of
/// looking for its nearest point.
bool is_box_beyond(const RTCPointQuery& query, const Place& a, const Place& b, const Place& c) {
  const Place at(query.x, query.y, query.z, 0);
  const Place below = a.min(b).min(c) - at;
  const Place above = at - a.max(b).max(c);
  return below.max(above).max(0.0F).square().sum() > query.radius * query.radius;
}

/// What a query carries through the hierarchy.
struct Search {
  const SurfaceDistance* surface;
  const float* places;  ///< [V][kPlaceSize]
  const std::function<bool(Index)>* accept;
  Vec3 point;
  double scale;
  double margin;
  ClosestPoint best;
};

bool visit_triangle(RTCPointQueryFunctionArguments* arguments) {
  auto& search = *static_cast<Search*>(arguments->userPtr);
  const auto triangle = static_cast<Index>(arguments->primID);
  if (triangle == search.best.triangle) return false;
  const auto& [a, b, c] = search.surface->triangles()[triangle];
  const auto place = [&search](Index v) {
    return Eigen::Map<const Place, Eigen::Aligned16>(search.places +
                                                     kPlaceSize * std::ptrdiff_t{v});
  };
  if (is_box_beyond(*arguments->query, place(a), place(b), place(c))) return false;
  if (search.accept != nullptr && !(*search.accept)(triangle)) return false;
  const auto& positions = search.surface->positions();
  ClosestPoint found =
      closest_point_on_triangle(search.point, positions[a], positions[b], positions[c]);
  found.triangle = triangle;
  const bool is_nearer = found.distance < search.best.distance ||
                         (found.distance == search.best.distance &&
                          (search.best.triangle == kNone || triangle < search.best.triangle));
  if (!is_nearer) return false;
  search.best = found;
  arguments->query->radius =
      static_cast<float>((found.distance * search.scale + search.margin) * (1 + 1e-6));
  return true;
}

}  // namespace

struct SurfaceDistance::Hierarchy {
  RTCDevice device;
  RTCScene scene = nullptr;
  const float* places = nullptr;  ///< [V][kPlaceSize], in the scene

  Hierarchy() : device(rtcNewDevice(nullptr)) {
    if (device == nullptr) fail(rtcGetDeviceError(nullptr));
    scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_COMPACT);  // less memory, and no slower
  }
  Hierarchy(const Hierarchy&) = delete;
  Hierarchy& operator=(const Hierarchy&) = delete;
  ~Hierarchy() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }

  /// Embree notes what went wrong, and goes on.
  void check() const {
    if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE) fail(error);
  }
  /// Triangles are nothing that it could refuse, but for want of memory.
  [[noreturn]] static void fail(RTCError error) {
    if (error != RTC_ERROR_UNSUPPORTED_CPU) throw std::bad_alloc();
    throw Error(ExitCode::internal, "the spatial index (Embree) does not know this processor");
  }
};

// Ericson, Real-Time Collision Detection, 2005, section 5.1.5: which feature is nearest follows
// from the signs of six scalar products.
ClosestPoint closest_point_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a;
  const Vec3 ac = c - a;
  if (!(ab.cross(ac).squaredNorm() > kThin * ab.squaredNorm() * ac.squaredNorm())) {
    return closest_on_thin_triangle(p, a, b, c);
  }
  const Vec3 ap = p - a;
  const double ab_a = ab.dot(ap);
  const double ac_a = ac.dot(ap);
  if (ab_a <= 0 && ac_a <= 0) return {kNone, ap.norm(), {1, 0, 0}};
  const Vec3 bp = p - b;
  const double ab_b = ab.dot(bp);
  const double ac_b = ac.dot(bp);
  if (ab_b >= 0 && ac_b <= ab_b) return {kNone, bp.norm(), {0, 1, 0}};
  const Vec3 cp = p - c;
  const double ab_c = ab.dot(cp);
  const double ac_c = ac.dot(cp);
  if (ac_c >= 0 && ab_c <= ac_c) return {kNone, cp.norm(), {0, 0, 1}};
  const double along_c = ab_a * ac_b - ab_b * ac_a;  // the barycentric coordinate of c, times area
  if (along_c <= 0 && ab_a >= 0 && ab_b <= 0) {
    const double t = ab_a / (ab_a - ab_b);
    return {kNone, (ap - t * ab).norm(), {1 - t, t, 0}};
  }
  const double along_b = ab_c * ac_a - ab_a * ac_c;
  if (along_b <= 0 && ac_a >= 0 && ac_c <= 0) {
    const double t = ac_a / (ac_a - ac_c);
    return {kNone, (ap - t * ac).norm(), {1 - t, 0, t}};
  }
  const double along_a = ab_b * ac_c - ab_c * ac_b;
  if (along_a <= 0 && ac_b >= ab_b && ab_c >= ac_c) {
    const double t = (ac_b - ab_b) / ((ac_b - ab_b) + (ab_c - ac_c));
    return {kNone, (bp - t * (c - b)).norm(), {0, 1 - t, t}};
  }
  const double sum = along_a + along_b + along_c;
  const double v = along_b / sum;
  const double w = along_c / sum;
  return {kNone, (ap - v * ab - w * ac).norm(), {1 - v - w, v, w}};
}

SurfaceDistance::SurfaceDistance(const std::vector<Vec3>& positions, const Triangles& triangles)
    : positions_(positions), triangles_(triangles), hierarchy_(std::make_unique<Hierarchy>()) {
  if (triangles_.empty()) throw PreconditionError("the surface to measure against has no triangle");
  Eigen::AlignedBox3d box;
  for (const auto& triangle : triangles_) {
    for (const Index v : triangle) box.extend(positions_[v]);
  }
  centre_ = box.center();
  const double half_size = box.sizes().maxCoeff() / 2;
  scale_ = half_size > 0 ? 1 / half_size : 1;

  const std::unique_ptr<RTCGeometryTy, decltype(&rtcReleaseGeometry)> owner(
      rtcNewGeometry(hierarchy_->device, RTC_GEOMETRY_TYPE_TRIANGLE), rtcReleaseGeometry);
  RTCGeometry geometry = owner.get();
  auto* places = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Place), positions_.size()));
  if (places == nullptr) Hierarchy::fail(RTC_ERROR_OUT_OF_MEMORY);
  hierarchy_->places = places;
  static_assert(sizeof(Triangles::value_type) == 3 * sizeof(unsigned));
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                             triangles_.data(), 0, 3 * sizeof(unsigned), triangles_.size());
  for (std::size_t v = 0; v < positions_.size(); ++v) {
    const Vec3 p = scale_ * (positions_[v] - centre_);
    Eigen::Map<Place, Eigen::Aligned16> place(places + kPlaceSize * v);
    place.head<3>() = p.cast<float>().array();
    place[3] = 0;
  }
  rtcSetGeometryPointQueryFunction(geometry, visit_triangle);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(hierarchy_->scene, geometry);
  rtcCommitScene(hierarchy_->scene);
  hierarchy_->check();
}

SurfaceDistance::~SurfaceDistance() = default;

ClosestPoint SurfaceDistance::on_triangle(const Vec3& p, Index triangle) const {
  const auto& [a, b, c] = triangles_[triangle];
  ClosestPoint found = closest_point_on_triangle(p, positions_[a], positions_[b], positions_[c]);
  found.triangle = triangle;
  return found;
}

ClosestPoint SurfaceDistance::closest(const Vec3& p) const { return query(p, {}, nullptr); }

ClosestPoint SurfaceDistance::closest_near(const Vec3& p, Index guess) const {
  return query(p, guess == kNone ? ClosestPoint{} : on_triangle(p, guess), nullptr);
}

ClosestPoint SurfaceDistance::closest_within(const Vec3& p, double reach) const {
  return query(p, {kNone, reach, {}}, nullptr);
}

ClosestPoint SurfaceDistance::closest_if(const Vec3& p, double reach,
                                         const std::function<bool(Index)>& accept) const {
  return query(p, {kNone, reach, {}}, &accept);
}

ClosestPoint SurfaceDistance::query(const Vec3& p, const ClosestPoint& best,
                                    const std::function<bool(Index)>* accept) const {
  const Vec3 local = scale_ * (p - centre_);
  Search search{this, hierarchy_->places, accept, p, scale_, 0, best};
  search.margin = kFloatMargin * std::max(1.0, local.cwiseAbs().maxCoeff());

  RTCPointQuery query = {};
  query.x = static_cast<float>(local.x());
  query.y = static_cast<float>(local.y());
  query.z = static_cast<float>(local.z());
  query.radius = static_cast<float>((best.distance * scale_ + search.margin) * (1 + 1e-6));
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(hierarchy_->scene, &query, &context, nullptr, &search);
  if (search.best.triangle == kNone) search.best.distance = std::numeric_limits<double>::infinity();
  return search.best;
}

double SurfaceDistance::distance_to_back(const Vec3& p, const Vec3& direction, double reach,
                                         double least_cosine,
                                         const std::function<bool(Index)>& accept) const {
  const Vec3 local = scale_ * (p - centre_);
  RTCRayHit ray = {};
  ray.ray.org_x = static_cast<float>(local.x());
  ray.ray.org_y = static_cast<float>(local.y());
  ray.ray.org_z = static_cast<float>(local.z());
  ray.ray.dir_x = static_cast<float>(direction.x());
  ray.ray.dir_y = static_cast<float>(direction.y());
  ray.ray.dir_z = static_cast<float>(direction.z());
  ray.ray.tnear = static_cast<float>(kFloatMargin * std::max(1.0, local.cwiseAbs().maxCoeff()));
  ray.ray.mask = ~0U;
  const float step = ray.ray.tnear;
  while (true) {
    ray.ray.tfar = static_cast<float>(scale_ * reach);
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(hierarchy_->scene, &context, &ray);
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::numeric_limits<double>::infinity();
    if (accept(static_cast<Index>(ray.hit.primID))) break;
    ray.ray.tnear = ray.ray.tfar + step;
  }
  const auto& [a, b, c] = triangles_[ray.hit.primID];
  const Vec3 normal = (positions_[b] - positions_[a]).cross(positions_[c] - positions_[a]);
  if (!(normal.dot(direction) > least_cosine * normal.norm()))
    return std::numeric_limits<double>::infinity();
  return ray.ray.tfar / scale_;
}

Vec3 SurfaceDistance::point(const ClosestPoint& at) const {
  const auto& corners = triangles_[at.triangle];
  return at.barycentric[0] * positions_[corners[0]] + at.barycentric[1] * positions_[corners[1]] +
         at.barycentric[2] * positions_[corners[2]];
}

}  // namespace strake
