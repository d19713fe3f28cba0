#include "tests/support/result_cases.h"

#include <Eigen/Geometry>
#include <array>

#include "common/geometry/poly_topology/face_shape.h"

namespace strake::support {

Case sheets(Index n, Index cells, const std::vector<Height>& heights) {
  const auto vertex = [](Index sheet, Index i, Index j, Index count) {
    return (sheet * (count + 1) + j) * (count + 1) + i;
  };
  PolyMesh soup;
  const auto count = static_cast<Index>(heights.size());
  for (Index s = 0; s < count; ++s) {
    for (Index j = 0; j <= n; ++j) {
      for (Index i = 0; i <= n; ++i) {
        const double x = double(i) / n;
        const double y = double(j) / n;
        soup.positions.emplace_back(x, y, heights[s](x, y));
      }
    }
    for (Index j = 0; j < n; ++j) {
      for (Index i = 0; i < n; ++i) {
        const Index a = vertex(s, i, j, n);
        const Index b = vertex(s, i + 1, j, n);
        const Index c = vertex(s, i + 1, j + 1, n);
        const Index d = vertex(s, i, j + 1, n);
        soup.add_face(std::array<Index, 3>{a, b, c});
        soup.add_face(std::array<Index, 3>{a, c, d});
      }
    }
  }
  Case result;
  result.mesh = plain_tri_mesh(soup);
  const Index step = n / cells;
  for (Index s = 0; s < count; ++s) {
    for (Index j = 0; j <= cells; ++j) {
      for (Index i = 0; i <= cells; ++i) {
        const Index v = vertex(s, i * step, j * step, n);
        const Index h = result.mesh.vertex_out[v];
        std::array<double, 3> barycentric = {0, 0, 0};
        barycentric[h % 3] = 1;
        result.quads.mesh.positions.push_back(soup.positions[v]);
        result.quads.provenance.face.push_back(TriMesh::face_of(h));
        result.quads.provenance.barycentric.push_back(barycentric);
        result.quads.provenance.lines.push_back({kNone, kNone});
      }
    }
    for (Index j = 0; j < cells; ++j) {
      for (Index i = 0; i < cells; ++i) {
        result.quads.mesh.add_face(
            std::array<Index, 4>{vertex(s, i, j, cells), vertex(s, i + 1, j, cells),
                                 vertex(s, i + 1, j + 1, cells), vertex(s, i, j + 1, cells)});
      }
    }
  }
  return result;
}

Case toothed_sheet(Index n, Index cells, double height) {
  Case result = grid(n, cells, [](double, double) { return 0.0; });
  PolyMesh soup;
  for (const Vec3& p : result.mesh.positions) soup.positions.push_back(p + result.mesh.origin);
  for (const auto& face : result.mesh.faces) soup.add_face(face);
  for (Index i = 0; i < n; ++i) {
    const Index left = n * (n + 1) + i;
    soup.add_face(std::array<Index, 3>{left + 1, soup.vertex_count(), left});
    soup.positions.emplace_back((i + 0.5) / n, 1 + height, 0);
  }
  result.mesh = plain_tri_mesh(soup);
  return result;
}

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

std::multiset<std::size_t> sides(const PolyMesh& mesh) {
  std::multiset<std::size_t> result;
  for (Index f = 0; f < mesh.face_count(); ++f) result.insert(mesh.face(f).size());
  return result;
}

double total_area(const PolyMesh& mesh) {
  double sum = 0;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    sum += newell_normal(mesh.positions, mesh.face(f)).z() / 2;
  }
  return sum;
}

}  // namespace strake::support
