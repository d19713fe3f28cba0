#include <fmt/format.h>

#include <utility>
#include <vector>

#include "common/core/error.h"
#include "common/geometry/topology/topology.h"

namespace strake {
namespace {

template <typename... Args>
void require(bool holds, fmt::format_string<Args...> text, Args&&... args) {
  if (holds) return;
  throw Error(ExitCode::internal,
              "invalid mesh: " + fmt::format(text, std::forward<Args>(args)...));
}

void check_sizes(const TriMesh& mesh) {
  const std::size_t vertices = mesh.positions.size();
  const std::size_t faces = mesh.faces.size();
  require(mesh.twin.size() == 3 * faces, "{} twins for {} faces", mesh.twin.size(), faces);
  require(mesh.is_feature.size() == 3 * faces, "{} feature flags for {} faces",
          mesh.is_feature.size(), faces);
  require(mesh.vertex_out.size() == vertices, "{} outgoing half-edges for {} vertices",
          mesh.vertex_out.size(), vertices);
  require(mesh.is_corner.size() == vertices, "{} corner flags for {} vertices",
          mesh.is_corner.size(), vertices);
  require(mesh.face_wedges.size() == faces, "{} wedge triples for {} faces",
          mesh.face_wedges.size(), faces);
  require(mesh.source_vertex.empty() || mesh.source_vertex.size() == vertices,
          "{} source vertices for {} vertices", mesh.source_vertex.size(), vertices);
  require(mesh.source_face.empty() || mesh.source_face.size() == faces,
          "{} source faces for {} faces", mesh.source_face.size(), faces);
}

void check_parent(const TriMesh& mesh) {
  require(mesh.parent_wedge.empty() || mesh.parent_wedge.size() == mesh.wedge_vertex.size(),
          "{} parent wedges for {} wedges", mesh.parent_wedge.size(), mesh.wedge_vertex.size());
}

void check_faces(const TriMesh& mesh) {
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    require(mesh.positions[v].allFinite(), "vertex {} is not finite", v);
  }
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const auto& [a, b, c] = mesh.faces[f];
    for (const Index v : mesh.faces[f]) {
      require(v >= 0 && v < mesh.vertex_count(), "face {} uses vertex {} of {}", f, v,
              mesh.vertex_count());
    }
    require(a != b && b != c && c != a, "face {} repeats a corner", f);
  }
}

void check_edges(const TriMesh& mesh) {
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    const Index twin = mesh.twin[h];
    if (twin == kNone) {
      require(mesh.is_feature[h] == 0, "boundary half-edge {} is flagged as a feature", h);
      continue;
    }
    require(twin >= 0 && twin < mesh.halfedge_count() && mesh.twin[twin] == h,
            "half-edges {} and {} are not each other's twins", h, twin);
    require(mesh.from(twin) == mesh.to(h) && mesh.to(twin) == mesh.from(h),
            "twins {} and {} do not run against each other", h, twin);
    require(mesh.is_feature[h] == mesh.is_feature[twin], "feature flags of twins {}, {} differ", h,
            twin);
  }
}

void check_fans(const TriMesh& mesh) {
  std::vector<Index> corners(mesh.vertex_count(), 0);
  for (const auto& face : mesh.faces) {
    for (const Index v : face) ++corners[v];
  }
  std::vector<Index> neighbour_of(mesh.vertex_count(), kNone);
  const auto meet = [&](Index vertex, Index neighbour) {
    require(neighbour_of[neighbour] != vertex, "two edges connect the vertices {} and {}", vertex,
            neighbour);
    neighbour_of[neighbour] = vertex;
  };
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const Index start = mesh.vertex_out[v];
    require(corners[v] > 0, "vertex {} is not used", v);
    require(start >= 0 && start < mesh.halfedge_count() && mesh.from(start) == v,
            "vertex {} has the outgoing half-edge {}, which starts elsewhere", v, start);
    Index visited = 0;
    Index h = start;
    do {
      ++visited;
      meet(v, mesh.to(h));
      const Index last = TriMesh::prev(h);
      h = mesh.twin[last];
      if (h == kNone) meet(v, mesh.from(last));
    } while (h != kNone && h != start && visited <= corners[v]);
    require(visited == corners[v], "vertex {} has several fans: {} of {} corners in the first", v,
            visited, corners[v]);
    require(h == start || mesh.twin[start] == kNone,
            "the outgoing half-edge of boundary vertex {} is not its clockwise-most", v);
  }
}

void check_wedges(const TriMesh& mesh) {
  std::vector<std::uint8_t> used(mesh.wedge_count(), 0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    const Index wedge = mesh.wedge_of(h);
    require(wedge >= 0 && wedge < mesh.wedge_count() && mesh.wedge_vertex[wedge] == mesh.from(h),
            "corner {} has wedge {}, which belongs elsewhere", h, wedge);
    used[wedge] = 1;
    if (mesh.is_barrier(h)) continue;
    require(mesh.wedge_of(mesh.rotate_cw(h)) == wedge,
            "wedge {} ends at half-edge {}, which is no barrier", wedge, h);
  }
  for (Index w = 0; w < mesh.wedge_count(); ++w) require(used[w] != 0, "wedge {} is not used", w);
}

}  // namespace

void validate(const TriMesh& mesh) {
  check_sizes(mesh);
  check_faces(mesh);
  check_edges(mesh);
  check_fans(mesh);
  check_wedges(mesh);
  check_parent(mesh);
}

}  // namespace strake
