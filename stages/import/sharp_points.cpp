#include "stages/import/sharp_points.h"

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "common/geometry/angles.h"
#include "common/geometry/frames.h"
#include "common/geometry/mesh_measures.h"
#include "common/geometry/topology/vertex_ring.h"
#include "stages/import/feature_graph.h"

namespace strake::import {
namespace {

constexpr double kLeastMissing = 20 * kDegree;
constexpr double kMostAround = 0.5;  ///< share of it
/// Length of the sum of normals around a tip, as a share of their lengths: where it is longer no
/// cone misses so much. Most vertices need no angles for that.
const double kLongestSum = 1 - kLeastMissing / (2 * M_PI);

/// Full turn less the angles around an inner vertex.
double missing_angle(const TriMesh& mesh, Index vertex) {
  double left = 2 * M_PI;
  for_each_outgoing(mesh, vertex, [&](Index h) { left -= corner_angle(mesh, h); });
  return left;
}

}  // namespace

Index find_sharp_points(TriMesh& mesh) {
  std::vector<Vec3> sum(mesh.positions.size(), Vec3::Zero());
  std::vector<double> length(mesh.positions.size(), 0.0);
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const Vec3 normal = face_cross(mesh, f);
    const double norm = normal.norm();
    for (const Index v : mesh.faces[f]) {
      sum[v] += normal;
      length[v] += norm;
    }
  }
  const std::vector<Index> degree = barrier_degrees(mesh);
  Index count = 0;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (degree[v] != 0 || !(sum[v].norm() < kLongestSum * length[v])) continue;
    const double missing = missing_angle(mesh, v);
    if (missing < kLeastMissing) continue;
    double around = 0;
    for_each_neighbour(mesh, v, [&](Index w) {
      if (degree[w] == 0) around += std::abs(missing_angle(mesh, w));
    });
    if (!(around < kMostAround * missing)) continue;
    mesh.is_corner[v] = 1;
    ++count;
  }
  return count;
}

}  // namespace strake::import
