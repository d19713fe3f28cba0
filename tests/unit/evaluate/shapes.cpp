#include "tests/unit/evaluate/shapes.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "common/geometry/poly_topology/face_shape.h"
#include "common/geometry/topology/topology.h"

namespace strake::shapes {

PolyMesh grid(Index n, Index m, bool close_s, bool close_t,
              const std::function<Vec3(double, double)>& place) {
  PolyMesh mesh;
  const Index rows = close_s ? n : n + 1;
  const Index columns = close_t ? m : m + 1;
  for (Index i = 0; i < rows; ++i) {
    for (Index j = 0; j < columns; ++j) {
      mesh.positions.push_back(place(static_cast<double>(i) / n, static_cast<double>(j) / m));
    }
  }
  const auto at = [&](Index i, Index j) { return (i % rows) * columns + j % columns; };
  for (Index i = 0; i < n; ++i) {
    for (Index j = 0; j < m; ++j) {
      mesh.add_face(std::array{at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

PolyMesh square(Index n, double height) {
  return grid(n, n, false, false, [&](double s, double t) { return Vec3(s, t, height); });
}

PolyMesh torus(Index n, Index m, double major, double minor) {
  return grid(n, m, true, true, [&](double s, double t) {
    const double u = 2 * std::numbers::pi * s;
    const double v = 2 * std::numbers::pi * t;
    const double r = major + minor * std::cos(v);
    return Vec3(r * std::cos(u), r * std::sin(u), minor * std::sin(v));
  });
}

PolyMesh cube(Index n, double half) {
  // Points of the integer grid [0, n]^3 that lie on its surface, joined where sides meet.
  PolyMesh mesh;
  std::map<std::array<Index, 3>, Index> known;
  const auto vertex = [&](const std::array<Index, 3>& p) {
    const auto [entry, is_new] = known.try_emplace(p, mesh.vertex_count());
    if (is_new) mesh.positions.push_back(half * (2 * Vec3(p[0], p[1], p[2]) / n - Vec3::Ones()));
    return entry->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const bool top : {false, true}) {
      for (Index i = 0; i < n; ++i) {
        for (Index j = 0; j < n; ++j) {
          const auto corner = [&](Index di, Index dj) {
            std::array<Index, 3> p = {};
            p[axis] = top ? n : 0;
            p[(axis + 1) % 3] = i + di;
            p[(axis + 2) % 3] = j + dj;
            return vertex(p);
          };
          const std::array up = {corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)};
          const std::array down = {up[0], up[3], up[2], up[1]};
          mesh.add_face(top ? up : down);
        }
      }
    }
  }
  return mesh;
}

PolyMesh moebius_band(Index n) {
  PolyMesh mesh;
  for (Index i = 0; i < n; ++i) {
    const double u = 2 * std::numbers::pi * i / n;
    for (const double side : {-0.3, 0.3}) {
      const double r = 1 + side * std::cos(u / 2);
      mesh.positions.emplace_back(r * std::cos(u), r * std::sin(u), side * std::sin(u / 2));
    }
  }
  for (Index i = 0; i + 1 < n; ++i) {
    mesh.add_face(std::array{2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1});
  }
  mesh.add_face(std::array{2 * n - 2, Index{1}, Index{0}, 2 * n - 1});
  return mesh;
}

PolyMesh moved(PolyMesh mesh, const std::function<Vec3(const Vec3&)>& move) {
  for (Vec3& p : mesh.positions) p = move(p);
  return mesh;
}

PolyMesh shaken(PolyMesh mesh, double amount) {
  std::mt19937 random(7);
  const auto symmetric = [&] { return static_cast<double>(random()) / 2147483648.0 - 1; };
  for (Vec3& p : mesh.positions) {
    for (int k = 0; k < 3; ++k) p[k] += amount * symmetric();
  }
  return mesh;
}

TriMesh reference(const PolyMesh& mesh, double feature_angle_deg) {
  TriMesh result;
  result.positions = mesh.positions;
  result.faces = triangulate_faces(mesh).corners;
  Eigen::AlignedBox3d box;
  for (const Vec3& p : result.positions) box.extend(p);
  result.diagonal = box.diagonal().norm();
  result.id = "test";
  build_topology(result);
  const auto normal = [&](Index f) {
    return newell_normal(result.positions, result.faces[f]).normalized();
  };
  const double least = std::cos(feature_angle_deg * std::numbers::pi / 180);
  for (Index h = 0; h < result.halfedge_count(); ++h) {
    if (result.is_boundary(h)) continue;
    const Index other = TriMesh::face_of(result.twin[h]);
    result.is_feature[h] = normal(TriMesh::face_of(h)).dot(normal(other)) < least ? 1 : 0;
  }
  build_wedges(result);
  return result;
}

}  // namespace strake::shapes
