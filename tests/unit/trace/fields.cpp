#include "tests/unit/trace/fields.h"

#include <Eigen/Geometry>
#include <random>

#include "common/geometry/mesh_measures.h"
#include "tests/support/mesh_support.h"

namespace strake {

TriMesh sample_mesh(SampleKind kind, std::int64_t faces, double jitter) {
  SampleOptions options;
  options.faces = faces;
  options.jitter = jitter;
  TriMesh mesh = support::plain_tri_mesh(make_sample(kind, options));
  Vec3 low = mesh.positions[0];
  Vec3 high = low;
  for (const Vec3& p : mesh.positions) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  mesh.diagonal = (high - low).norm();
  return mesh;
}

PrincipalField field_along(const TriMesh& mesh, const std::function<Vec3(const Vec3&)>& direction) {
  const Index n = mesh.wedge_count();
  PrincipalField field;
  field.normal = wedge_normals(mesh, FaceNormals(mesh));
  for (Index w = 0; w < n; ++w) {
    const Vec3 d = direction(mesh.positions[mesh.wedge_vertex[w]]);
    const Vec3& normal = field.normal[w];
    field.t_min.push_back((d - normal * normal.dot(d)).normalized());
  }
  field.cross = field.t_min;
  field.k_min.assign(n, 0);
  field.k_max.assign(n, 0);
  field.wedge_confidence.assign(n, 1);
  field.face_confidence.assign(mesh.face_count(), 1);
  field.cross_extended = true;
  return field;
}

void turn_crosses(PrincipalField& field, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  for (std::size_t w = 0; w < field.cross.size(); ++w) {
    for (auto turns = random() % 4; turns > 0; --turns) {
      field.cross[w] = field.normal[w].cross(field.cross[w]).eval();
    }
  }
}

}  // namespace strake
