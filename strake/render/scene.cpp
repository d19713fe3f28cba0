#include "strake/render/scene.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "common/core/error.h"
#include "common/geometry/angles.h"
#include "common/geometry/poly_topology/face_shape.h"
#include "common/geometry/poly_topology/poly_edges.h"
#include "common/geometry/poly_topology/vertex_faces.h"

namespace strake {
namespace {

constexpr unsigned kSurfaceId = 0;
constexpr unsigned kLineId = 1;
constexpr unsigned kSurfaceMask = 1;
constexpr unsigned kLineMask = 2;
// Faces bent by less than 35 degrees share their normals, those by more than 60 keep their own.
constexpr double kSmoothCosine = 0.82;
constexpr double kCreaseCosine = 0.5;

double corner_angle(const PolyMesh& mesh, Index face, Index corner) {
  const auto at = [&](Index c) -> const Vec3& { return mesh.positions[mesh.corners[c]]; };
  return angle_between(at(mesh.next_corner(face, corner)) - at(corner),
                       at(mesh.previous_corner(face, corner)) - at(corner));
}

/// One normal per corner: the mean over the faces around the vertex that bend little from its own.
std::vector<Eigen::Vector3f> smooth_normals(const PolyMesh& mesh, bool flat) {
  std::vector<Vec3> face_normal(static_cast<std::size_t>(mesh.face_count()));
  std::vector<double> angle(mesh.corners.size());
  tbb::parallel_for(Index{0}, mesh.face_count(), [&](Index f) {
    face_normal[f] = newell_normal(mesh.positions, mesh.face(f)).normalized();
    for (Index c = mesh.offsets[f]; c < mesh.offsets[f + 1]; ++c) {
      angle[c] = corner_angle(mesh, f, c);
    }
  });
  const VertexFaces around(mesh);
  std::vector<Eigen::Vector3f> normals(mesh.corners.size());
  tbb::parallel_for(Index{0}, mesh.face_count(), [&](Index f) {
    for (Index c = mesh.offsets[f]; c < mesh.offsets[f + 1]; ++c) {
      Vec3 sum = face_normal[f];
      if (!flat) {
        sum.setZero();
        const Index v = mesh.corners[c];
        for (std::size_t i = 0; i < around.faces(v).size(); ++i) {
          const Vec3& normal = face_normal[around.faces(v)[i]];
          const double smooth =
              (normal.dot(face_normal[f]) - kCreaseCosine) / (kSmoothCosine - kCreaseCosine);
          sum += std::clamp(smooth, 0.0, 1.0) * angle[around.corners(v)[i]] * normal;
        }
      }
      normals[c] = (sum.norm() > 0 ? sum.normalized() : face_normal[f]).cast<float>();
    }
  });
  return normals;
}

RTCRay make_ray(const Vec3& origin, const Vec3& direction, double reach, unsigned mask) {
  RTCRay ray = {};
  ray.org_x = static_cast<float>(origin.x());
  ray.org_y = static_cast<float>(origin.y());
  ray.org_z = static_cast<float>(origin.z());
  ray.dir_x = static_cast<float>(direction.x());
  ray.dir_y = static_cast<float>(direction.y());
  ray.dir_z = static_cast<float>(direction.z());
  ray.tfar = static_cast<float>(reach);
  ray.mask = mask;
  return ray;
}

}  // namespace

Scene::Scene(PolyMesh mesh, const std::string& name, bool flat,
             const std::optional<SceneFrame>& frame)
    : mesh_(std::move(mesh)) {
  normalise(name, frame);
  device_.reset(rtcNewDevice(nullptr));
  if (!device_) throw Error(ExitCode::internal, "the ray tracer (Embree) does not start");
  scene_.reset(rtcNewScene(device_.get()));
  rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
  build_surface(flat);
}

Scene::~Scene() = default;

void Scene::normalise(const std::string& name, const std::optional<SceneFrame>& frame) {
  Eigen::AlignedBox3d box;
  for (const Index v : mesh_.corners) box.extend(mesh_.positions[v]);
  if (box.isEmpty() || !(box.diagonal().norm() > 0) || !box.diagonal().allFinite()) {
    throw InputError("'" + name + "' has no face of finite, positive size: nothing to draw");
  }
  centre_ = frame ? frame->centre : box.center();
  scale_ = 1 / (frame ? frame->diagonal : box.diagonal().norm());
  for (Vec3& p : mesh_.positions) p = place(p);
}

void Scene::build_surface(bool flat) {
  FaceTriangles triangles = triangulate_faces(mesh_);
  const std::vector<Eigen::Vector3f> normals = smooth_normals(mesh_, flat);
  triangle_face_ = std::move(triangles.face);
  corner_normals_.resize(triangle_face_.size());

  RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                               RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                                               mesh_.positions.size()));
  for (std::size_t v = 0; v < mesh_.positions.size(); ++v) {
    for (int k = 0; k < 3; ++k) vertices[3 * v + k] = static_cast<float>(mesh_.positions[v][k]);
  }
  auto* indices = static_cast<unsigned*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(unsigned), triangle_face_.size()));
  for (std::size_t t = 0; t < triangle_face_.size(); ++t) {
    const std::span<const Index> face = mesh_.face(triangle_face_[t]);
    for (int k = 0; k < 3; ++k) {
      const Index v = triangles.corners[t][k];
      indices[3 * t + k] = static_cast<unsigned>(v);
      const auto at = std::find(face.begin(), face.end(), v) - face.begin();
      corner_normals_[t][k] = normals[mesh_.offsets[triangle_face_[t]] + at];
    }
  }
  attach(geometry, kSurfaceId, kSurfaceMask);
}

void Scene::add_lines(const Polylines& lines, double radius) {
  std::size_t point_count = 0;
  for (const Polylines::Line& line : lines.lines) point_count += line.points.size();
  RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE);
  auto* points = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 4 * sizeof(float), point_count));
  auto* segments = static_cast<unsigned*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT, sizeof(unsigned),
                              point_count - lines.lines.size()));
  unsigned point = 0;
  for (std::size_t l = 0; l < lines.lines.size(); ++l) {
    const std::vector<Index>& line = lines.lines[l].points;
    for (std::size_t i = 0; i < line.size(); ++i, ++point) {
      const Vec3 p = place(lines.positions[line[i]]);
      for (int k = 0; k < 3; ++k) points[4 * point + k] = static_cast<float>(p[k]);
      points[4 * point + 3] = static_cast<float>(radius * lines.lines[l].width);
      if (i + 1 == line.size()) continue;
      segments[segment_line_.size()] = point;
      segment_line_.push_back(static_cast<Index>(l));
    }
  }
  attach(geometry, kLineId, kLineMask);
}

void Scene::attach(RTCGeometry geometry, unsigned id, unsigned mask) {
  rtcSetGeometryMask(geometry, mask);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene_.get(), geometry, id);
  rtcReleaseGeometry(geometry);
}

bool Scene::is_closed() const {
  const PolyEdges edges = collect_edges(mesh_);
  for (Index e = 0; e < edges.edge_count(); ++e) {
    if (edges.sides_of(e).size() != 2) return false;
  }
  return true;
}

void Scene::commit() { rtcCommitScene(scene_.get()); }

Hit Scene::trace(const Vec3& origin, const Vec3& direction) const {
  RTCRayHit query = {};
  query.ray =
      make_ray(origin, direction, std::numeric_limits<float>::infinity(), kSurfaceMask | kLineMask);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene_.get(), &context, &query);

  Hit hit;
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return hit;
  hit.position = origin + static_cast<double>(query.ray.tfar) * direction;
  hit.geometric_normal = Vec3(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z).normalized();
  hit.shading_normal = hit.geometric_normal;
  if (query.hit.geomID == kLineId) {
    hit.kind = Hit::Kind::line;
    hit.line = segment_line_[query.hit.primID];
    return hit;
  }
  hit.kind = Hit::Kind::surface;
  hit.face = triangle_face_[query.hit.primID];
  const auto& corners = corner_normals_[query.hit.primID];
  const float u = query.hit.u;
  const float v = query.hit.v;
  const Eigen::Vector3f normal = (1 - u - v) * corners[0] + u * corners[1] + v * corners[2];
  if (normal.norm() > 0) hit.shading_normal = normal.normalized().cast<double>();
  return hit;
}

bool Scene::is_blocked(const Vec3& origin, const Vec3& direction, double reach) const {
  RTCRay ray = make_ray(origin, direction, reach, kSurfaceMask);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene_.get(), &context, &ray);
  return ray.tfar < 0;
}

}  // namespace strake
