#include "stages/refine/flat_faces.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "common/geometry/flat_triangle.h"
#include "common/geometry/poly_topology/face_shape.h"
#include "common/geometry/poly_topology/poly_edges.h"
#include "common/geometry/poly_topology/poly_topology.h"
#include "stages/refine/double_edge.h"
#include "stages/refine/merge_places.h"

namespace strake {
namespace {

constexpr int kMostTurns = 10;  ///< times that edges are turned

/// The side of a face after this corner is its longest.
std::size_t longest_side(const std::vector<Vec3>& positions, std::span<const Index> face) {
  std::size_t longest = 0;
  double length = -1;
  for (std::size_t i = 0; i < face.size(); ++i) {
    const double side = (positions[face[(i + 1) % face.size()]] - positions[face[i]]).norm();
    if (side <= length) continue;
    length = side;
    longest = i;
  }
  return longest;
}

bool is_flat(const std::vector<Vec3>& positions, std::span<const Index> face) {
  const std::size_t i = longest_side(positions, face);
  const double length = (positions[face[(i + 1) % face.size()]] - positions[face[i]]).norm();
  return newell_normal(positions, face).norm() <= kFlatHeight * length * length;
}

/// Whether two vertices of a face in a row are at the same place.
bool has_side_of_no_length(const std::vector<Vec3>& positions, std::span<const Index> face) {
  double shortest = std::numeric_limits<double>::infinity();
  double longest = 0;
  for (std::size_t i = 0; i < face.size(); ++i) {
    const double side = (positions[face[(i + 1) % face.size()]] - positions[face[i]]).norm();
    shortest = std::min(shortest, side);
    longest = std::max(longest, side);
  }
  return shortest <= kFlatHeight * longest;
}

/// Faces without area, or with a side of no length.
Index flat_count(const PolyMesh& mesh) {
  Index count = 0;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const std::span<const Index> face = mesh.face(f);
    count += is_flat(mesh.positions, face) || has_side_of_no_length(mesh.positions, face) ? 1 : 0;
  }
  return count;
}

/// The face on the other side of an edge of a face; kNone at the boundary.
Index face_beyond(const PolyEdges& edges, Index face, Index a, Index b) {
  const std::array<Index, 2> edge = {std::min(a, b), std::max(a, b)};
  const auto at = std::ranges::lower_bound(edges.vertices, edge);
  for (const Index side : edges.sides_of(static_cast<Index>(at - edges.vertices.begin()))) {
    if (edges.corner_face[side] != face) return edges.corner_face[side];
  }
  return kNone;
}

/// What takes the place of faces.
using Replacements = std::map<Index, std::vector<std::array<Index, 3>>>;

/// A face as triangles: of a quad both ways, along the shorter diagonal first, so that those of a
/// flat one do not have their longest sides in common; none that makes an edge double.
std::vector<std::vector<std::array<Index, 3>>> cuts(const PolyMesh& mesh, Index f,
                                                    const PolyEdges& edges) {
  const std::span<const Index> face = mesh.face(f);
  std::vector<std::vector<std::array<Index, 3>>> ways;
  if (face.size() == 4) {
    const auto length = [&](std::size_t k) {
      return (mesh.positions[face[k + 2]] - mesh.positions[face[k]]).norm();
    };
    const std::size_t shorter = length(0) <= length(1) ? 0 : 1;
    for (const std::size_t k : {shorter, 1 - shorter}) {
      ways.push_back(
          {{face[k], face[k + 1], face[k + 2]}, {face[k], face[k + 2], face[(k + 3) % 4]}});
    }
  } else {
    triangulate_face(mesh.positions, face, ways.emplace_back());
  }
  std::erase_if(ways, [&](const auto& way) { return !adds_no_double_edge(face, way, edges); });
  return ways;
}

/// The longest edges of flat triangles turned, each with a triangle of the face beyond it that has
/// an area, and flat quads as halves if wanted; no face is changed twice.
Replacements turned_edges(const PolyMesh& mesh, bool cuts_quads) {
  const PolyEdges edges = collect_edges(mesh);
  Replacements instead;
  std::set<std::array<Index, 2>> turned;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const std::span<const Index> face = mesh.face(f);
    if (face.size() > 4 || instead.contains(f) || !is_flat(mesh.positions, face)) continue;
    if (face.size() == 4) {
      if (!cuts_quads) continue;
      auto ways = cuts(mesh, f, edges);
      if (!ways.empty()) instead[f] = std::move(ways.front());
      continue;
    }
    const std::size_t longest = longest_side(mesh.positions, face);
    const Index a = face[longest];
    const Index b = face[(longest + 1) % 3];
    const Index m = face[(longest + 2) % 3];
    const Index beyond = face_beyond(edges, f, a, b);
    if (beyond == kNone || instead.contains(beyond)) continue;
    for (auto& triangles : cuts(mesh, beyond, edges)) {
      const auto beside = std::ranges::find_if(triangles, [&](const auto& t) {
        return std::ranges::find(t, a) != t.end() && std::ranges::find(t, b) != t.end();
      });
      if (beside == triangles.end() || is_flat(mesh.positions, *beside)) continue;
      const Index c = *std::ranges::find_if(*beside, [&](Index v) { return v != a && v != b; });
      const std::array<Index, 2> edge = {std::min(c, m), std::max(c, m)};
      if (std::ranges::binary_search(edges.vertices, edge) || !turned.insert(edge).second) continue;
      *beside = {m, a, c};
      triangles.push_back({m, c, b});
      instead[f] = {};
      instead[beyond] = std::move(triangles);
      break;
    }
  }
  return instead;
}

/// Turns edges as often as that does something. \param cuts_quads  whether flat quads become halves
PolyMesh turn_edges(PolyMesh mesh, bool cuts_quads) {
  for (int i = 0; i < kMostTurns; ++i) {
    const Replacements instead = turned_edges(mesh, cuts_quads);
    if (instead.empty()) break;
    PolyMesh faces;
    for (Index f = 0; f < mesh.face_count(); ++f) {
      const auto found = instead.find(f);
      if (found == instead.end()) {
        faces.add_face(mesh.face(f));
      } else {
        for (const auto& triangle : found->second) faces.add_face(triangle);
      }
    }
    mesh.corners = std::move(faces.corners);
    mesh.offsets = std::move(faces.offsets);
  }
  return mesh;
}

/// Takes a result with fewer flat faces, if it is a surface like the other one.
void take_if_better(ToleranceProof& proof, QuadMesh mended, QuadMesh& quads) {
  if (flat_count(mended.mesh) >= flat_count(quads.mesh)) return;
  const PolyTopology topology = analyse(mended.mesh);
  if (!topology.is_oriented_manifold() || topology.euler != analyse(quads.mesh).euler) return;
  if (proof.check(ComparedSurfaces(proof.input(), mended)).empty()) quads = std::move(mended);
}

}  // namespace

void mend_flat_faces_within(ToleranceProof& proof, QuadMesh& quads) {
  if (flat_count(quads.mesh) == 0) return;
  QuadMesh merged = quads;
  merge_places(merged);
  take_if_better(proof, std::move(merged), quads);
  for (const bool cuts_quads : {false, true}) {
    QuadMesh turned = quads;
    turned.mesh = turn_edges(std::move(turned.mesh), cuts_quads);
    take_if_better(proof, std::move(turned), quads);
  }
}

}  // namespace strake
