#include "tests/support/result_cases.h"

#include <Eigen/Geometry>

namespace strake::support {

Case on_triangles(const PolyMesh& faces, const FaceTriangles& cut) {
  PolyMesh surface;
  surface.positions = faces.positions;
  for (const auto& triangle : cut.corners) surface.add_face(triangle);
  Case result;
  result.mesh = plain_tri_mesh(surface);
  result.quads.mesh = faces;
  VertexProvenance& places = result.quads.provenance;
  places.face.resize(faces.positions.size());
  places.barycentric.resize(faces.positions.size());
  places.lines.assign(faces.positions.size(), {kNone, kNone});
  for (Index f = 0; f < result.mesh.face_count(); ++f) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Index v = result.mesh.faces[f][i];
      places.face[v] = f;
      places.barycentric[v] = {0, 0, 0};
      places.barycentric[v][i] = 1;
    }
  }
  return result;
}

PolyMesh undecided_pentagon() {
  const auto pentagon = [](double y) {
    PolyMesh mesh;
    mesh.positions = {Vec3(-0.1, 3, 0.8), Vec3(-2.2, 2.8, 0.1), Vec3(-1.8, 0, 0),
                      Vec3(-0.2, y, 0.6), Vec3(0.4, 0, -0.1)};
    mesh.add_face(std::array<Index, 5>{0, 1, 2, 3, 4});
    return mesh;
  };
  double reflex = 1;
  double convex = -1;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (reflex + convex);
    const PolyMesh mesh = pentagon(middle);
    const auto& p = mesh.positions;
    const double turn = (p[3] - p[2]).cross(p[4] - p[2]).dot(newell_normal(p, mesh.face(0)));
    (turn > 0 ? convex : reflex) = middle;
  }
  return pentagon(convex);
}

}  // namespace strake::support
