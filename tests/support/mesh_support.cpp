#include "tests/support/mesh_support.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "common/geometry/samples/random.h"
#include "common/geometry/topology/topology.h"

namespace strake::support {
namespace {

std::vector<Index> shuffled(Index count, UniformRandom& random) {
  std::vector<Index> order(count);
  std::iota(order.begin(), order.end(), Index{0});
  for (Index i = count - 1; i > 0; --i) {
    const Index j = static_cast<Index>((random.symmetric() + 1) / 2 * (i + 1));
    std::swap(order[i], order[j]);
  }
  return order;
}

Vec3 area_vector(const TriMesh& mesh, Index f) {
  const auto& v = mesh.faces[f];
  const Vec3& a = mesh.positions[v[0]];
  return (mesh.positions[v[1]] - a).cross(mesh.positions[v[2]] - a) / 2;
}

}  // namespace

TriMesh plain_tri_mesh(const PolyMesh& mesh) {
  TriMesh result;
  result.positions = mesh.positions;
  Vec3 lower = mesh.positions.front(), upper = lower;
  for (const Vec3& p : mesh.positions) {
    lower = lower.cwiseMin(p);
    upper = upper.cwiseMax(p);
  }
  result.diagonal = (upper - lower).norm();
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(f);
    result.faces.push_back({face[0], face[1], face[2]});
  }
  result.source_vertex.resize(mesh.positions.size());
  std::iota(result.source_vertex.begin(), result.source_vertex.end(), Index{0});
  result.source_face.resize(result.faces.size());
  std::iota(result.source_face.begin(), result.source_face.end(), Index{0});
  build_topology(result);
  build_wedges(result);
  result.id = content_id(result);
  return result;
}

PolyMesh transformed(const PolyMesh& mesh, const Mat3& linear, const Vec3& shift) {
  PolyMesh result = mesh;
  for (Vec3& p : result.positions) p = linear * p + shift;
  if (linear.determinant() < 0) {
    for (Index f = 0; f < mesh.face_count(); ++f) {
      std::reverse(result.corners.begin() + mesh.offsets[f],
                   result.corners.begin() + mesh.offsets[f + 1]);
    }
  }
  return result;
}

PolyMesh together(const PolyMesh& a, const PolyMesh& b) {
  PolyMesh result = a;
  result.positions.insert(result.positions.end(), b.positions.begin(), b.positions.end());
  for (Index f = 0; f < b.face_count(); ++f) {
    std::vector<Index> face(b.face(f).begin(), b.face(f).end());
    for (Index& v : face) v += a.vertex_count();
    result.add_face(face);
  }
  return result;
}

Mat3 oblique_rotation() {
  return Eigen::AngleAxisd(2.1, Vec3(0.36, -0.48, 0.8)).toRotationMatrix();
}

Mat3 oblique_reflection() {
  const Vec3 normal = Vec3(0.8, 0.36, 0.48).normalized();
  return Mat3::Identity() - 2 * normal * normal.transpose();
}

PermutedMesh permuted(const PolyMesh& mesh, std::uint64_t seed) {
  UniformRandom random(seed);
  PermutedMesh result;
  result.old_vertex = shuffled(mesh.vertex_count(), random);
  result.old_face = shuffled(mesh.face_count(), random);
  std::vector<Index> new_vertex(mesh.positions.size());
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    new_vertex[result.old_vertex[v]] = v;
    result.mesh.positions.push_back(mesh.positions[result.old_vertex[v]]);
  }
  for (const Index f : result.old_face) {
    std::vector<Index> face;
    for (const Index v : mesh.face(f)) face.push_back(new_vertex[v]);
    const double share = (random.symmetric() + 1) / 2;
    const auto first = static_cast<std::ptrdiff_t>(share * static_cast<double>(face.size()));
    std::rotate(face.begin(), face.begin() + first, face.end());
    result.mesh.add_face(face);
  }
  return result;
}

double dihedral_angle(const TriMesh& mesh, Index h) {
  const Vec3 left = area_vector(mesh, TriMesh::face_of(h));
  const Vec3 right = area_vector(mesh, TriMesh::face_of(mesh.twin[h]));
  const Vec3 edge = (mesh.positions[mesh.to(h)] - mesh.positions[mesh.from(h)]).normalized();
  return std::atan2(left.cross(right).dot(edge), left.dot(right));
}

double mean_edge_length(const TriMesh& mesh) {
  double sum = 0;
  Index count = 0;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (mesh.edge_of(h) != h) continue;
    sum += (mesh.positions[mesh.to(h)] - mesh.positions[mesh.from(h)]).norm();
    ++count;
  }
  return sum / count;
}

std::vector<double> vertex_areas(const TriMesh& mesh) {
  std::vector<double> area(mesh.positions.size(), 0);
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const double third = area_vector(mesh, f).norm() / 3;
    for (const Index v : mesh.faces[f]) area[v] += third;
  }
  return area;
}

double observed_order(const std::vector<double>& sizes, const std::vector<double>& errors) {
  const double n = static_cast<double>(sizes.size());
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const double x = std::log(sizes[i]), y = std::log(errors[i]);
    sx += x;
    sy += y;
    sxx += x * x;
    sxy += x * y;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

}  // namespace strake::support
