#include "stages/import/face_normals.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "common/geometry/frames.h"
#include "common/geometry/mesh_measures.h"

namespace strake::import {
namespace {

double longest_edge(const TriMesh& mesh, Index f) {
  return std::max(
      {edge_length(mesh, 3 * f), edge_length(mesh, 3 * f + 1), edge_length(mesh, 3 * f + 2)});
}

/// Height from which on the normal of any face is trusted: rounding moves a corner by up to a unit
/// in the last place of single precision, so the normal by about 1/20 at most.
double trusted_height(const TriMesh& mesh) {
  constexpr double kSinglePrecision = 1.2e-7;
  constexpr double kHeightPerError = 20;
  double largest = 0;
  for (const Vec3& p : mesh.positions) {
    largest = std::max(largest, (p + mesh.origin).cwiseAbs().maxCoeff());
  }
  return kHeightPerError * kSinglePrecision * largest;
}

/// Hands normals on to neighbours without one, breadth-first; only across edges at least `share`
/// times as long as the longest of the receiving face.
void spread(const TriMesh& mesh, double share, std::vector<Vec3>& normals) {
  std::vector<Index> queue;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    if (normals[f] != Vec3::Zero()) queue.push_back(f);
  }
  for (std::size_t i = 0; i < queue.size(); ++i) {
    for (Index h = 3 * queue[i]; h < 3 * queue[i] + 3; ++h) {
      if (mesh.twin[h] == kNone) continue;
      const Index g = mesh.twin[h] / 3;
      if (normals[g] != Vec3::Zero()) continue;
      if (edge_length(mesh, h) < share * longest_edge(mesh, g)) continue;
      normals[g] = Vec3(normals[queue[i]]);
      queue.push_back(g);
    }
  }
}

}  // namespace

std::vector<Vec3> robust_face_normals(const TriMesh& mesh) {
  constexpr double kSliver = 0.02;  // height over longest edge
  const double lowest = trusted_height(mesh);
  std::vector<Vec3> normals(mesh.faces.size(), Vec3::Zero());
  bool all_trusted = true;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const Vec3 area = face_cross(mesh, f);
    const double norm = area.norm();
    const double longest = longest_edge(mesh, f);
    if (norm > std::min(lowest, kSliver * longest) * longest && norm > 0) {
      normals[f] = area / norm;
    } else {
      all_trusted = false;
    }
  }
  if (!all_trusted) {
    constexpr double kLongEdge = 0.9;
    spread(mesh, kLongEdge, normals);
    spread(mesh, 0, normals);
  }
  return normals;
}

}  // namespace strake::import
