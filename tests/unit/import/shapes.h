#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <variant>
#include <vector>

#include "common/core/poly_mesh.h"
#include "common/geometry/topology/topology.h"
#include "stages/import/import.h"

namespace strake::shapes {

inline PolyMesh polygons(std::vector<Vec3> positions,
                         const std::vector<std::vector<Index>>& faces) {
  PolyMesh mesh;
  mesh.positions = std::move(positions);
  for (const auto& face : faces) mesh.add_face(face);
  return mesh;
}

/// The unit cube moved by `shift`, quads looking outwards.
inline PolyMesh cube(const Vec3& shift = Vec3::Zero()) {
  std::vector<Vec3> positions;
  for (int i = 0; i < 8; ++i) positions.push_back(shift + Vec3(i & 1, (i >> 1) & 1, (i >> 2) & 1));
  return polygons(
      positions,
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}});
}

/// The mesh with vertices of equal position made one, faces as they are.
inline PolyMesh merged(const PolyMesh& mesh) {
  PolyMesh result;
  std::vector<Index> index;
  for (const Vec3& p : mesh.positions) {
    const auto found = std::find(result.positions.begin(), result.positions.end(), p);
    index.push_back(static_cast<Index>(found - result.positions.begin()));
    if (found == result.positions.end()) result.positions.push_back(p);
  }
  for (Index f = 0; f < mesh.face_count(); ++f) {
    std::vector<Index> face;
    for (const Index v : mesh.face(f)) face.push_back(index[v]);
    result.add_face(face);
  }
  return result;
}

/// The mesh with vertices of its own for every face.
inline PolyMesh unwelded(const PolyMesh& mesh) {
  PolyMesh result;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    std::vector<Index> face;
    for (const Index v : mesh.face(f)) {
      face.push_back(result.vertex_count());
      result.positions.push_back(mesh.positions[v]);
    }
    result.add_face(face);
  }
  return result;
}

/// The mesh with the faces for which `keep` holds.
template <typename Keep>
PolyMesh filtered(const PolyMesh& mesh, const Keep& keep) {
  PolyMesh result;
  result.positions = mesh.positions;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    if (keep(f)) result.add_face(mesh.face(f));
  }
  return result;
}

/// The mesh with the faces turned over for which `turn` holds.
template <typename Turn>
PolyMesh turned(const PolyMesh& mesh, const Turn& turn) {
  PolyMesh result;
  result.positions = mesh.positions;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    std::vector<Index> face(mesh.face(f).begin(), mesh.face(f).end());
    if (turn(f)) std::reverse(face.begin(), face.end());
    result.add_face(face);
  }
  return result;
}

/// n x m quads over the unit square, z given by `height(x, y)`.
template <typename Height>
PolyMesh grid(int n, int m, const Height& height) {
  PolyMesh mesh;
  for (int j = 0; j <= m; ++j) {
    for (int i = 0; i <= n; ++i) {
      const double x = static_cast<double>(i) / n;
      const double y = static_cast<double>(j) / m;
      mesh.positions.emplace_back(x, y, height(x, y));
    }
  }
  for (int j = 0; j < m; ++j) {
    for (int i = 0; i < n; ++i) {
      const Index a = j * (n + 1) + i;
      mesh.add_face(std::array<Index, 4>{a, a + 1, a + n + 2, a + n + 1});
    }
  }
  return mesh;
}

/// A torus of n x m quads around the z axis.
inline PolyMesh torus(int n, int m, double tube = 0.4) {
  PolyMesh mesh;
  for (int j = 0; j < m; ++j) {
    for (int i = 0; i < n; ++i) {
      const double u = 2 * std::numbers::pi * i / n;
      const double v = 2 * std::numbers::pi * j / m;
      const double r = 1 + tube * std::cos(v);
      mesh.positions.emplace_back(r * std::cos(u), r * std::sin(u), tube * std::sin(v));
    }
  }
  const auto at = [&](int i, int j) { return static_cast<Index>((j % m) * n + i % n); };
  for (int j = 0; j < m; ++j) {
    for (int i = 0; i < n; ++i) {
      mesh.add_face(std::array<Index, 4>{at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

/// Options that leave edges as long as they are.
inline ImportOptions undivided() {
  ImportOptions options;
  options.longest_edge = percent(100);
  return options;
}

inline ImportResult imported(const PolyMesh& mesh, const ImportOptions& options = undivided()) {
  SilentObserver observer;
  ImportResult result = import_mesh(mesh, options, observer);
  validate(result.mesh);
  return result;
}

inline std::int64_t count(const Report& report, const std::string& key) {
  for (const auto& [name, value] : report.entries()) {
    if (name == key) return std::get<std::int64_t>(value);
  }
  return -1;
}

/// Signed volume; of an open mesh that of the cone over it.
inline double volume(const TriMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.faces) {
    sum += mesh.positions[a].cross(mesh.positions[b]).dot(mesh.positions[c]) / 6;
  }
  return sum;
}

inline double area(const TriMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.faces) {
    const Vec3& p = mesh.positions[a];
    sum += 0.5 * (mesh.positions[b] - p).cross(mesh.positions[c] - p).norm();
  }
  return sum;
}

}  // namespace strake::shapes
