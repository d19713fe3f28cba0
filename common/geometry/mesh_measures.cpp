#include "common/geometry/mesh_measures.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

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

double edge_length(const TriMesh& mesh, Index halfedge) {
  return (mesh.positions[mesh.to(halfedge)] - mesh.positions[mesh.from(halfedge)]).norm();
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

FaceNormals::FaceNormals(const TriMesh& mesh) : mesh_(&mesh) {
  std::vector<std::uint8_t> is_sliver(mesh.faces.size(), 0);
  tbb::parallel_for(Index{0}, mesh.face_count(),
                    [&](Index f) { is_sliver[f] = has_own_normal(mesh, f) ? 0 : 1; });
  for (Index f = 0; f < mesh.face_count(); ++f) {
    if (is_sliver[f] != 0) slivers_.push_back(f);
  }
  sliver_normals_.resize(slivers_.size(), Vec3::Zero());
  // Outwards from known faces, front by front, so that the result does not depend on the order of
  // faces within a front.
  std::vector<Index> front = slivers_;
  while (!front.empty()) {
    std::vector<std::pair<Index, Vec3>> found;
    for (const Index f : front) {
      Vec3 sum = Vec3::Zero();
      for (Index h = 3 * f; h < 3 * f + 3; ++h) {
        const Index t = mesh.twin[h];
        if (t == kNone) continue;
        sum += (*this)[TriMesh::face_of(t)] *
               (mesh.positions[mesh.to(h)] - mesh.positions[mesh.from(h)]).norm();
      }
      if (sum.norm() > 0) found.emplace_back(f, sum.normalized());
    }
    front.clear();
    for (const auto& [f, normal] : found) {
      sliver_normals_[place_of_sliver(f)] = normal;
      is_sliver[f] = 0;  // no more to be found
    }
    for (const auto& [f, normal] : found) {
      for (Index h = 3 * f; h < 3 * f + 3; ++h) {
        const Index t = mesh.twin[h];
        if (t != kNone && is_sliver[TriMesh::face_of(t)] != 0) {
          front.push_back(TriMesh::face_of(t));
        }
      }
    }
    std::sort(front.begin(), front.end());
    front.erase(std::unique(front.begin(), front.end()), front.end());
  }
  for (Vec3& normal : sliver_normals_) {
    if (normal.isZero(0)) normal = Vec3::UnitZ();
  }
}

std::vector<Vec3> FaceNormals::all() const {
  std::vector<Vec3> normals(mesh_->faces.size());
  tbb::parallel_for(Index{0}, mesh_->face_count(), [&](Index f) { normals[f] = (*this)[f]; });
  return normals;
}

Vec3 FaceNormals::own(Index face) const {
  const Vec3 n = face_cross(*mesh_, face);
  return n / n.norm();
}

std::size_t FaceNormals::place_of_sliver(Index face) const {
  const auto found = std::lower_bound(slivers_.begin(), slivers_.end(), face);
  return static_cast<std::size_t>(found - slivers_.begin());
}

Vec3 FaceNormals::of_sliver(Index face) const { return sliver_normals_[place_of_sliver(face)]; }

std::vector<Vec3> wedge_normals(const TriMesh& mesh, const FaceNormals& face_normals) {
  std::vector<Vec3> normals(mesh.wedge_count(), Vec3::Zero());
  std::vector<double> angles(static_cast<std::size_t>(mesh.halfedge_count()));
  tbb::parallel_for(Index{0}, mesh.halfedge_count(),
                    [&](Index h) { angles[h] = corner_angle(mesh, h); });
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const Vec3 normal = face_normals[f];
    for (Index h = 3 * f; h < 3 * f + 3; ++h) normals[mesh.wedge_of(h)] += normal * angles[h];
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

double surface_area(const TriMesh& mesh) {
  double sum = 0;
  for (const double area : wedge_areas(mesh)) sum += area;
  return sum;
}

}  // namespace strake
