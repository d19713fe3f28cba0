#include "stages/refine/changes_within.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "common/geometry/cell_error/tolerance_check.h"
#include "common/geometry/face_crossings/face_crossings.h"
#include "common/geometry/patch_fill/redivide_faces.h"
#include "common/geometry/patch_fill/refill_crossing.h"
#include "common/geometry/poly_topology/face_shape.h"
#include "common/geometry/poly_topology/poly_edges.h"
#include "common/geometry/poly_topology/poly_topology.h"

namespace strake {
namespace {

/// Times that faces are made anew: where that is beyond the tolerance they stay the next time.
constexpr int kMostRefills = 4;
/// Height of a triangle, in longest edges, up to which it has no area; and times that edges of such
/// triangles are turned.
constexpr double kFlat = 1e-9;
constexpr int kMostTurns = 10;
/// Times that a result with odd faces paired is proven.
constexpr int kMostPairings = 80;

/// The changes that bring faces beyond the tolerance, or to cross others.
/// \param change_of_face  [F of the result]
/// \return [changes] 1: one of them; all where it is none of them alone
std::vector<char> harmful_changes(ToleranceProof& proof, const QuadMesh& changed,
                                  std::span<const Redivision> changes,
                                  const std::vector<Index>& change_of_face) {
  std::vector<char> harmful(changes.size(), 0);
  const std::vector<Excess> excess = proof.check(ComparedSurfaces(proof.input(), changed));
  std::vector<std::uint8_t> is_near(changed.mesh.positions.size(), 0);  // a place beyond
  for (const Excess& e : excess) {
    if (change_of_face[e.cell] != kNone) {
      harmful[change_of_face[e.cell]] = 1;
    } else {
      for (const Index v : changed.mesh.face(e.cell)) is_near[v] = 1;
    }
  }
  std::vector<std::uint8_t> is_new(change_of_face.size(), 0);
  for (std::size_t f = 0; f < is_new.size(); ++f) is_new[f] = change_of_face[f] != kNone ? 1 : 0;
  const auto crossing =
      find_crossing_faces(changed.mesh.positions, triangulate_faces(changed.mesh), is_new, {});
  for (const auto& pair : crossing) {
    for (const Index f : pair) {
      if (change_of_face[f] != kNone) harmful[change_of_face[f]] = 1;
    }
  }
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const auto& outline = changes[i].outline;
    if (std::ranges::any_of(outline, [&](Index v) { return is_near[v] != 0; })) harmful[i] = 1;
  }
  const bool is_sound = excess.empty() && crossing.empty();
  if (!is_sound && std::ranges::find(harmful, 1) == harmful.end()) std::ranges::fill(harmful, 1);
  return harmful;
}

/// Whether no edge inside a face joins vertices that have an edge already.
bool adds_no_double_edge(std::span<const Index> face,
                         const std::vector<std::array<Index, 3>>& triangles,
                         const PolyEdges& edges) {
  const auto is_side = [&](Index a, Index b) {
    for (std::size_t i = 0; i < face.size(); ++i) {
      if (face[i] == a && face[(i + 1) % face.size()] == b) return true;
    }
    return false;
  };
  for (const auto& triangle : triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Index a = triangle[i];
      const Index b = triangle[(i + 1) % 3];
      const std::array<Index, 2> edge = {std::min(a, b), std::max(a, b)};
      if (!is_side(a, b) && std::ranges::binary_search(edges.vertices, edge)) return false;
    }
  }
  return true;
}

/// The corner of a triangle that lies on the side opposite; 3 where the triangle has an area.
std::size_t flat_corner(const std::vector<Vec3>& positions, std::span<const Index> face) {
  if (face.size() != 3) return 3;
  std::size_t corner = 0;
  double longest = -1;
  for (std::size_t i = 0; i < 3; ++i) {
    const double side = (positions[face[(i + 2) % 3]] - positions[face[(i + 1) % 3]]).norm();
    if (side <= longest) continue;
    longest = side;
    corner = i;
  }
  return newell_normal(positions, face).norm() <= kFlat * longest * longest ? corner : 3;
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

/// The longest edges of flat triangles turned, each with a triangle of the face beyond it that has
/// an area; no face is changed twice.
Replacements turned_edges(const PolyMesh& mesh) {
  const PolyEdges edges = collect_edges(mesh);
  Replacements instead;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const std::size_t corner = flat_corner(mesh.positions, mesh.face(f));
    if (corner == 3 || instead.contains(f)) continue;
    const Index m = mesh.face(f)[corner];
    const Index a = mesh.face(f)[(corner + 1) % 3];
    const Index b = mesh.face(f)[(corner + 2) % 3];
    const Index beyond = face_beyond(edges, f, a, b);
    if (beyond == kNone || instead.contains(beyond)) continue;
    std::vector<std::array<Index, 3>> triangles;
    triangulate_face(mesh.positions, mesh.face(beyond), triangles);
    const auto beside = std::ranges::find_if(triangles, [&](const auto& t) {
      return std::ranges::find(t, a) != t.end() && std::ranges::find(t, b) != t.end();
    });
    if (beside == triangles.end() || flat_corner(mesh.positions, *beside) != 3) continue;
    if (!adds_no_double_edge(mesh.face(beyond), triangles, edges)) continue;
    const Index c = *std::ranges::find_if(*beside, [&](Index v) { return v != a && v != b; });
    const std::array<Index, 2> edge = {std::min(c, m), std::max(c, m)};
    if (std::ranges::binary_search(edges.vertices, edge)) continue;
    *beside = {m, a, c};
    triangles.push_back({m, c, b});
    instead[f] = {};
    instead[beyond] = std::move(triangles);
  }
  return instead;
}

}  // namespace

void turn_flat_triangles_within(ToleranceProof& proof, QuadMesh& quads) {
  QuadMesh turned = quads;
  for (int i = 0; i < kMostTurns; ++i) {
    const Replacements instead = turned_edges(turned.mesh);
    if (instead.empty()) break;
    PolyMesh faces;
    for (Index f = 0; f < turned.mesh.face_count(); ++f) {
      const auto found = instead.find(f);
      if (found == instead.end()) {
        faces.add_face(turned.mesh.face(f));
      } else {
        for (const auto& triangle : found->second) faces.add_face(triangle);
      }
    }
    turned.mesh.corners = std::move(faces.corners);
    turned.mesh.offsets = std::move(faces.offsets);
  }
  if (turned.mesh.corners == quads.mesh.corners) return;
  if (!analyse(turned.mesh).is_oriented_manifold()) return;
  if (proof.check(ComparedSurfaces(proof.input(), turned)).empty()) quads = std::move(turned);
}

void refill_within(ToleranceProof& proof, QuadMesh& quads) {
  const InputSurface& input = *proof.input();
  std::vector<Vec3> spared;
  for (int i = 0; i < kMostRefills; ++i) {
    QuadMesh refilled = quads;
    const Index made =
        refill_crossing_faces(input.mesh, input.distance, refilled, proof.tolerance(), spared);
    if (made == 0) return;
    const std::vector<Excess> excess = proof.check(ComparedSurfaces(proof.input(), refilled));
    if (excess.empty()) {
      quads = std::move(refilled);
      return;
    }
    for (const Excess& e : excess) spared.push_back(e.place);
  }
}

void pair_odd_cells_within(ToleranceProof& proof, const SurfacePoints& points, QuadMesh& quads) {
  const auto foot = [&](Index v) {
    return SurfacePoint{quads.provenance.face[v], quads.provenance.barycentric[v]};
  };
  const auto may_remove = [&](Index a, Index b) {
    return !points.has_line_along(foot(a), foot(b));
  };
  std::set<std::vector<Index>> refused;
  std::vector<Redivision> changes = find_redivisions(quads.mesh, may_remove, refused);
  for (int i = 0; i < kMostPairings && !changes.empty(); ++i) {
    QuadMesh changed = quads;
    std::vector<Index> change_of_face;
    changed.mesh = redivide_faces(quads.mesh, changes, change_of_face);
    const std::vector<char> harmful = harmful_changes(proof, changed, changes, change_of_face);
    std::vector<Redivision> harmless;
    for (std::size_t c = 0; c < changes.size(); ++c) {
      if (harmful[c] != 0) {
        refused.insert(changes[c].outline);
      } else {
        harmless.push_back(std::move(changes[c]));
      }
    }
    if (harmless.size() == changes.size()) {
      quads = std::move(changed);
      harmless.clear();
    }
    changes =
        harmless.empty() ? find_redivisions(quads.mesh, may_remove, refused) : std::move(harmless);
  }
}

void cut_cells_in_doubt(ToleranceProof& proof, QuadMesh& quads) {
  const std::vector<Index> in_doubt = proof.cells_in_doubt(ComparedSurfaces(proof.input(), quads));
  if (in_doubt.empty()) return;
  const PolyEdges edges = collect_edges(quads.mesh);
  PolyMesh cut;
  for (Index f = 0; f < quads.mesh.face_count(); ++f) {
    const std::span<const Index> face = quads.mesh.face(f);
    std::vector<std::array<Index, 3>> triangles;
    if (std::ranges::binary_search(in_doubt, f)) {
      triangulate_face(quads.mesh.positions, face, triangles);
    }
    if (triangles.empty() || !adds_no_double_edge(face, triangles, edges)) {
      cut.add_face(face);
    } else {
      for (const auto& triangle : triangles) cut.add_face(triangle);
    }
  }
  quads.mesh.corners = std::move(cut.corners);
  quads.mesh.offsets = std::move(cut.offsets);
}

}  // namespace strake
