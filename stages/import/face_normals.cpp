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

/// Whether something holds of all coordinates of the file.
template <class Test>
bool all_coordinates(const TriMesh& mesh, Test test) {
  return std::ranges::all_of(mesh.positions, [&](const Vec3& p) {
    const Vec3 at = p + mesh.origin;
    return test(at.x()) && test(at.y()) && test(at.z());
  });
}

/// What rounding may have moved corners by, model units: a unit in the last place of single
/// precision, of the coordinates in the file. Where these have the digits to lie far from the
/// origin, that of the extent: so they do after a mesh was moved there.
double rounding_error(const TriMesh& mesh) {
  constexpr double kSinglePrecision = 1.2e-7;
  constexpr double kDoublePrecision = 2.3e-16;
  constexpr double kWritten = 1e-9;  // what nine digits leave of a number of single precision
  constexpr double kNear = 30;       // diagonals, of which the error is a millionth there
  double largest = 0;
  for (const Vec3& p : mesh.positions) {
    largest = std::max(largest, (p + mesh.origin).cwiseAbs().maxCoeff());
  }
  const double single = kSinglePrecision * largest;
  if (largest <= kNear * mesh.diagonal) return single;
  const double moved = 2 * kDoublePrecision * largest;  // by taking the origin off
  const auto is_single = [&](double x) {
    return std::abs(x - static_cast<float>(x)) <= kWritten * std::abs(x) + moved;
  };
  if (all_coordinates(mesh, is_single)) return single;
  const double least = std::max(kSinglePrecision * mesh.diagonal, 4 * moved);
  for (double step = std::pow(10, std::floor(std::log10(single))); step > least; step /= 10) {
    const auto is_decimal = [&](double x) {
      return std::abs(x - step * std::round(x / step)) <= 1e-6 * step + moved;
    };
    if (all_coordinates(mesh, is_decimal)) return step;
  }
  return std::min(single, least);
}

/// Height from which on the normal of any face is trusted: rounding turns it by about 1/20 then.
double trusted_height(const TriMesh& mesh) { return 20 * rounding_error(mesh); }

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
