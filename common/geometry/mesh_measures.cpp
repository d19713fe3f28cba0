#include "common/geometry/mesh_measures.h"

#include <tbb/parallel_for.h>

#include "common/geometry/angles.h"
#include "common/geometry/frames.h"

namespace strake {
namespace {

/// A face this thin for its longest edge has no normal of its own.
constexpr double kSliverRatio = 1e-6;

}  // namespace

double corner_angle(const TriMesh& mesh, Index h) {
  const Vec3& p = mesh.positions[mesh.from(h)];
  const Vec3 a = mesh.positions[mesh.to(h)] - p;
  const Vec3 b = mesh.positions[mesh.from(TriMesh::prev(h))] - p;
  return angle_between(a, b);
}

bool has_own_normal(const TriMesh& mesh, Index face) {
  const auto& v = mesh.faces[face];
  double longest = 0;
  for (int i = 0; i < 3; ++i) {
    longest =
        std::max(longest, (mesh.positions[v[(i + 1) % 3]] - mesh.positions[v[i]]).squaredNorm());
  }
  const double length = face_cross(mesh, face).norm();
  return length > kSliverRatio * longest && length > 0;
}

std::vector<Vec3> face_normals(const TriMesh& mesh) {
  const Index count = mesh.face_count();
  std::vector<Vec3> normals(count, Vec3::Zero());
  std::vector<char> known(count, 0);
  tbb::parallel_for(Index{0}, count, [&](Index f) {
    if (!has_own_normal(mesh, f)) return;
    const Vec3 n = face_cross(mesh, f);
    normals[f] = n / n.norm();
    known[f] = 1;
  });
  // Slivers: spread outwards from known faces, front by front, so that the result does not depend
  // on the order of faces within a front.
  std::vector<Index> open;
  for (Index f = 0; f < count; ++f) {
    if (!known[f]) open.push_back(f);
  }
  while (!open.empty()) {
    std::vector<Index> rest;
    std::vector<std::pair<Index, Vec3>> found;
    for (const Index f : open) {
      Vec3 sum = Vec3::Zero();
      for (Index h = 3 * f; h < 3 * f + 3; ++h) {
        const Index t = mesh.twin[h];
        if (t == kNone || !known[TriMesh::face_of(t)]) continue;
        sum += normals[TriMesh::face_of(t)] *
               (mesh.positions[mesh.to(h)] - mesh.positions[mesh.from(h)]).norm();
      }
      if (sum.norm() > 0) {
        found.emplace_back(f, sum.normalized());
      } else {
        rest.push_back(f);
      }
    }
    if (found.empty()) {
      for (const Index f : rest) normals[f] = Vec3::UnitZ();
      break;
    }
    for (const auto& [f, n] : found) {
      normals[f] = n;
      known[f] = 1;
    }
    open = std::move(rest);
  }
  return normals;
}

std::vector<Vec3> wedge_normals(const TriMesh& mesh, const std::vector<Vec3>& face_normals) {
  std::vector<Vec3> normals(mesh.wedge_count(), Vec3::Zero());
  std::vector<double> angles(static_cast<std::size_t>(mesh.halfedge_count()));
  tbb::parallel_for(Index{0}, mesh.halfedge_count(),
                    [&](Index h) { angles[h] = corner_angle(mesh, h); });
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    normals[mesh.wedge_of(h)] += face_normals[TriMesh::face_of(h)] * angles[h];
  }
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    Vec3& n = normals[mesh.wedge_of(h)];
    const double length = n.norm();
    n = length > 1e-12 ? Vec3(n / length) : face_normals[TriMesh::face_of(h)];
  }
  return normals;
}

std::vector<double> wedge_areas(const TriMesh& mesh) {
  std::vector<double> areas(mesh.wedge_count(), 0);
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const double third = face_area(mesh, f) / 3;
    for (int i = 0; i < 3; ++i) areas[mesh.face_wedges[f][i]] += third;
  }
  return areas;
}

}  // namespace strake
