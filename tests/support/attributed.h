#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "common/core/poly_mesh.h"

/// Surfaces whose colours, texture coordinates and labels follow from the place.
namespace strake::support {

/// A colour that is linear in the position.
inline Colour linear_colour(const Vec3& p) {
  return {0.5 + 0.2 * p.x() - 0.1 * p.z(), 0.5 + 0.25 * p.y(), 0.4 + 0.1 * (p.x() + p.y()), 1};
}

inline void colour_linearly(PolyMesh& mesh) {
  mesh.attributes.colour.clear();
  for (const Vec3& p : mesh.positions) mesh.attributes.colour.push_back(linear_colour(p));
}

/// The axis along which a unit vector points most nearly: 0 to 5 for +x, -x, +y, -y, +z, -z.
inline Index side_of(const Vec3& direction) {
  Index axis = 0;
  direction.cwiseAbs().maxCoeff(&axis);
  return 2 * axis + (direction[axis] < 0 ? 1 : 0);
}

/// The cube from (-1, -1, -1) to (1, 1, 1), each side n x n quads with the side's number as label,
/// and its name in OBJ.
inline PolyMesh labelled_cube(int n) {
  PolyMesh mesh;
  FaceLabels labels{"g", {}, {"right", "left", "top", "bottom", "front", "back"}};
  const auto vertex = [&](const Vec3& p) {
    const auto same = [&](const Vec3& q) { return (p - q).norm() < 1e-9; };
    const auto found = std::find_if(mesh.positions.begin(), mesh.positions.end(), same);
    const auto index = static_cast<Index>(found - mesh.positions.begin());
    if (index == mesh.vertex_count()) mesh.positions.push_back(p);
    return index;
  };
  for (Index side = 0; side < 6; ++side) {
    const int axis = side / 2;
    const double sign = side % 2 == 0 ? 1 : -1;
    const auto at = [&](int i, int j) {
      Vec3 p;
      p[axis] = sign;
      p[(axis + 1) % 3] = -1 + 2.0 * i / n;
      p[(axis + 2) % 3] = sign * (-1 + 2.0 * j / n);
      return vertex(p);
    };
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        mesh.add_face(std::array<Index, 4>{at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
        labels.of_face.push_back(side);
      }
    }
  }
  mesh.attributes.labels = {labels};
  colour_linearly(mesh);
  return mesh;
}

/// The side of a cylinder of radius 1 around z from 0 to 2, n x m quads. Texture coordinates are
/// the share of the turn, from 0 to 1 at the seam at y = 0, x > 0, and z.
inline PolyMesh seamed_tube(int n, int m) {
  PolyMesh mesh;
  for (int j = 0; j <= m; ++j) {
    for (int i = 0; i < n; ++i) {
      const double angle = 2 * std::numbers::pi * i / n;
      mesh.positions.emplace_back(std::cos(angle), std::sin(angle), 2.0 * j / m);
    }
  }
  for (int j = 0; j < m; ++j) {
    for (int i = 0; i < n; ++i) {
      const Index next = (i + 1) % n;
      mesh.add_face(
          std::array<Index, 4>{j * n + i, j * n + next, (j + 1) * n + next, (j + 1) * n + i});
      for (const auto& [a, b] : {std::pair{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}}) {
        mesh.attributes.texture.push_back({static_cast<double>(a) / n, 2.0 * b / m});
      }
    }
  }
  return mesh;
}

}  // namespace strake::support
