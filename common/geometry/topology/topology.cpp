#include "common/geometry/topology/topology.h"

#define XXH_INLINE_ALL
#include <fmt/format.h>
#include <xxhash.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "common/core/error.h"
#include "common/geometry/topology/vertex_ring.h"

namespace strake {
namespace {

/// A half-edge in the bucket of its lower vertex.
struct BucketEntry {
  Index upper;
  Index halfedge;
};

/// Half-edges bucketed by the lower of their two vertices.
struct EdgeBuckets {
  std::vector<Index> offsets;  ///< [V + 1]
  std::vector<BucketEntry> entries;
};

EdgeBuckets bucket_edges(const TriMesh& mesh) {
  EdgeBuckets buckets;
  buckets.offsets.assign(mesh.positions.size() + 2, 0);
  for (const auto& face : mesh.faces) {
    for (int i = 0; i < 3; ++i) ++buckets.offsets[std::min(face[i], face[(i + 1) % 3]) + 2];
  }
  for (std::size_t v = 2; v < buckets.offsets.size(); ++v) {
    buckets.offsets[v] += buckets.offsets[v - 1];
  }
  buckets.entries.resize(3 * mesh.faces.size());
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    const auto [lower, upper] = std::minmax({mesh.from(h), mesh.to(h)});
    buckets.entries[buckets.offsets[lower + 1]++] = {upper, h};
  }
  buckets.offsets.pop_back();
  return buckets;
}

void pair_twins(TriMesh& mesh) {
  EdgeBuckets buckets = bucket_edges(mesh);
  mesh.twin.assign(mesh.halfedge_count(), kNone);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const auto first = buckets.entries.begin() + buckets.offsets[v];
    const auto last = buckets.entries.begin() + buckets.offsets[v + 1];
    std::sort(first, last, [](const BucketEntry& a, const BucketEntry& b) {
      return std::pair(a.upper, a.halfedge) < std::pair(b.upper, b.halfedge);
    });
    for (auto it = first; it != last;) {
      auto end = it + 1;
      while (end != last && end->upper == it->upper) ++end;
      const auto count = end - it;
      if (count > 2 || (count == 2 && mesh.from(it->halfedge) == mesh.from(it[1].halfedge))) {
        throw Error(ExitCode::internal,
                    fmt::format("edge ({}, {}) has {} faces or two of equal direction", v,
                                it->upper, count));
      }
      if (count == 2) {
        mesh.twin[it->halfedge] = it[1].halfedge;
        mesh.twin[it[1].halfedge] = it->halfedge;
      }
      it = end;
    }
  }
}

/// The outgoing half-edge at which the numbering of the wedges of a vertex starts.
Index first_wedge_start(const TriMesh& mesh, Index vertex) {
  const Index barrier = find_outgoing(mesh, vertex, [&](Index h) { return mesh.is_barrier(h); });
  return barrier != kNone ? barrier : mesh.vertex_out[vertex];
}

/// [F] A face of lower number in the same component, not always a neighbour; its own number for the
/// first of each.
std::vector<Index> faces_before(const TriMesh& mesh) {
  std::vector<Index> before(mesh.faces.size());
  const auto first_of = [&](Index face) {
    while (before[face] != face) {
      before[face] = before[before[face]];
      face = before[face];
    }
    return face;
  };
  for (Index face = 0; face < mesh.face_count(); ++face) {
    before[face] = face;
    for (Index h = 3 * face; h < 3 * face + 3; ++h) {
      if (mesh.twin[h] == kNone || TriMesh::face_of(mesh.twin[h]) > face) continue;
      const Index mine = first_of(face);
      const Index other = first_of(TriMesh::face_of(mesh.twin[h]));
      before[std::max(mine, other)] = std::min(mine, other);
    }
  }
  return before;
}

Index count_boundary_loops(const TriMesh& mesh) {
  std::vector<std::uint8_t> visited(mesh.halfedge_count(), 0);
  Index loops = 0;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (!mesh.is_boundary(h) || visited[h] != 0) continue;
    ++loops;
    for (Index b = h; visited[b] == 0; b = mesh.vertex_out[mesh.to(b)]) visited[b] = 1;
  }
  return loops;
}

}  // namespace

void build_topology(TriMesh& mesh) {
  pair_twins(mesh);
  mesh.vertex_out.assign(mesh.vertex_count(), kNone);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    Index& out = mesh.vertex_out[mesh.from(h)];
    if (out == kNone || (mesh.twin[h] == kNone && mesh.twin[out] != kNone)) out = h;
  }
  if (mesh.is_feature.size() != 3 * mesh.faces.size()) {
    mesh.is_feature.assign(3 * mesh.faces.size(), 0);
  }
  if (mesh.is_corner.size() != mesh.positions.size()) {
    mesh.is_corner.assign(mesh.positions.size(), 0);
  }
}

void build_wedges(TriMesh& mesh) {
  mesh.face_wedges.assign(mesh.faces.size(), {kNone, kNone, kNone});
  mesh.wedge_vertex.clear();
  mesh.wedge_vertex.reserve(mesh.positions.size());
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (mesh.vertex_out[v] == kNone) continue;
    const Index start = first_wedge_start(mesh, v);
    mesh.wedge_vertex.push_back(v);
    Index h = start;
    do {
      if (h != start && mesh.is_barrier(h)) mesh.wedge_vertex.push_back(v);
      mesh.face_wedges[h / 3][h % 3] = mesh.wedge_count() - 1;
      h = mesh.rotate_ccw(h);
    } while (h != kNone && h != start);
  }
}

std::vector<Index> face_components(const TriMesh& mesh) {
  std::vector<Index> component = faces_before(mesh);
  Index count = 0;
  for (Index face = 0; face < mesh.face_count(); ++face) {
    const Index before = component[face];
    component[face] = before == face ? count++ : component[before];
  }
  return component;
}

std::vector<double> component_extents(const TriMesh& mesh, const std::vector<Index>& component) {
  std::vector<Eigen::AlignedBox3d> boxes;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const auto c = static_cast<std::size_t>(component[f]);
    if (c >= boxes.size()) boxes.resize(c + 1);
    for (const Index v : mesh.faces[f]) boxes[c].extend(mesh.positions[v]);
  }
  std::vector<double> extents;
  extents.reserve(boxes.size());
  for (const Eigen::AlignedBox3d& box : boxes) extents.push_back(box.diagonal().norm());
  return extents;
}

Census census(const TriMesh& mesh) {
  Census result;
  for (const Index component : face_components(mesh)) {
    result.components = std::max(result.components, component + 1);
  }
  result.boundary_loops = count_boundary_loops(mesh);
  Index edges = 0;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) edges += mesh.edge_of(h) == h ? 1 : 0;
  result.euler_characteristic = mesh.vertex_count() - edges + mesh.face_count();
  // chi = 2 - 2 g - b for each component, summed.
  result.genus = (2 * result.components - result.boundary_loops - result.euler_characteristic) / 2;
  return result;
}

std::string content_id(const TriMesh& mesh) {
  const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state(XXH3_createState(),
                                                                       &XXH3_freeState);
  XXH3_128bits_reset(state.get());
  const auto add = [&](const auto* data, std::size_t count) {
    XXH3_128bits_update(state.get(), data, count * sizeof(*data));
  };
  const std::array<Index, 2> counts = {mesh.vertex_count(), mesh.face_count()};
  add(counts.data(), counts.size());
  add(mesh.origin.data(), 3);
  add(mesh.positions.data(), mesh.positions.size());
  add(mesh.faces.data(), mesh.faces.size());
  add(mesh.is_feature.data(), mesh.is_feature.size());
  add(mesh.is_corner.data(), mesh.is_corner.size());
  add(mesh.parent_id.data(), mesh.parent_id.size());
  const XXH128_hash_t hash = XXH3_128bits_digest(state.get());
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

}  // namespace strake
