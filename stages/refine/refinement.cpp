#include "stages/refine/refinement.h"

#include <algorithm>
#include <array>
#include <utility>

#include "common/geometry/cell_error/cell_error.h"
#include "common/geometry/nearest_on_surface.h"
#include "common/geometry/poly_topology/face_shape.h"
#include "common/geometry/poly_topology/poly_edges.h"
#include "stages/refine/edges_across_bend.h"
#include "stages/refine/flat_faces.h"
#include "stages/refine/turned_ears.h"

namespace strake {
namespace {

/// Where edges are measured.
constexpr std::array<double, 3> kPlacesOnEdge = {0.25, 0.5, 0.75};
/// An edge below this share of the mean one of its cell is not divided for the others' sake: half
/// of it would be next to nothing, and half of that after another round.
constexpr double kShortSide = 0.05;

}  // namespace

Refinement::Refinement(const TriMesh& mesh, QuadMesh quads, std::int64_t most_sides)
    : mesh_(mesh),
      quads_(std::move(quads)),
      points_(mesh),
      crossing_(mesh, Tangles::kFaults),
      max_sides_(static_cast<std::size_t>(most_sides)) {
  for (Index f = 0; f < quads_.mesh.face_count(); ++f) {
    max_sides_ = std::max(max_sides_, quads_.mesh.face(f).size());
  }
}

void Refinement::put_back(const SurfaceDistance& input, double tolerance) {
  for (Index v = 0; v < quads_.mesh.vertex_count(); ++v) {
    Vec3& p = quads_.mesh.positions[v];
    if (input.closest_within(p - mesh_.origin, tolerance).triangle != kNone) continue;
    p = mesh_.origin + place_of(mesh_, foot_of(v));
  }
}

void Refinement::drop_turned_ears() {
  quads_.mesh.attributes = {};  // carried over anew at the end
  strake::drop_turned_ears(points_, quads_);
}

void Refinement::reach(const std::vector<Excess>& excess) {
  const NearestOnSurface nearest(mesh_, quads_);
  std::vector<char> moved(quads_.mesh.positions.size(), 0);
  for (const Excess& e : excess) {
    if (e.input_face == kNone) continue;
    const Index v = nearest.vertex(e.input_face, e.place);
    if (v == kNone || moved[v] != 0 || points_.is_on_line(foot_of(v))) continue;
    const auto& [a, b, c] = mesh_.faces[e.input_face];
    const ClosestPoint at = closest_point_on_triangle(e.place, mesh_.positions[a],
                                                      mesh_.positions[b], mesh_.positions[c]);
    set_foot(quads_.provenance, v, {e.input_face, at.barycentric});
    quads_.mesh.positions[v] = e.place + mesh_.origin;
    moved[v] = 1;
  }
}

void Refinement::finish(ToleranceProof& proof, const InlayLimits& limits) {
  refill_within(proof, quads_);
  mend_flat_faces_within(proof, quads_);  // what has no area crosses nothing, and hides what does
  inlay_crossing(proof, crossing_, proof.tolerance(), quads_, limits);
  mend_flat_faces_within(proof, quads_);
  pair_odd_cells_within(proof, points_, {}, quads_);
}

void Refinement::divide(const ComparedSurfaces& surfaces, const std::vector<Target>& targets,
                        double tolerance) {
  positions_ = surfaces.positions();
  normals_.assign(positions_.size(), Vec3::Zero());
  for (Index f = 0; f < quads_.mesh.face_count(); ++f) {
    const Vec3 normal = newell_normal(positions_, quads_.mesh.face(f));
    for (const Index v : quads_.mesh.face(f)) normals_[v] += normal;
  }
  find_boundary();
  std::vector<char> chosen(static_cast<std::size_t>(quads_.mesh.face_count()), 0);
  EdgeMarks marks;
  for (const Target& target : targets) {
    if (add_jags(target.face, tolerance, marks)) continue;
    chosen[target.face] = 1;
    const std::span<const Index> face = quads_.mesh.face(target.face);
    for (const std::size_t i : edges_to_divide(surfaces, target, tolerance)) {
      const Index a = face[i];
      const Index b = face[(i + 1) % face.size()];
      if (marks.at(a, b) == kNone) marks.set(a, b, add_on_edge(a, b));
    }
  }
  const auto add_centre = [&](Index a, Index b, const std::vector<Index>& ring) {
    return add_between(a, b, newell_normal(positions_, ring));
  };
  quads_.mesh = split_cells(quads_.mesh, chosen, marks, max_sides_, positions_, add_centre);
  quads_.mesh.positions = positions_;
  for (Vec3& p : quads_.mesh.positions) p += mesh_.origin;
}

Index Refinement::add(const SurfacePoint& point) {
  positions_.push_back(place_of(mesh_, point));
  normals_.push_back(Vec3::Zero());
  add_foot(quads_.provenance, point);
  return static_cast<Index>(positions_.size()) - 1;
}

void Refinement::find_boundary() {
  boundary_ = {};
  const PolyEdges edges = collect_edges(quads_.mesh);
  for (Index e = 0; e < edges.edge_count(); ++e) {
    if (edges.sides_of(e).size() > 1) continue;
    boundary_.set(edges.vertices[e][0], edges.vertices[e][1], e);
  }
}

bool Refinement::add_jags(Index cell, double tolerance, EdgeMarks& marks) {
  bool any = false;
  const std::span<const Index> face = quads_.mesh.face(cell);
  for (std::size_t i = 0; i < face.size(); ++i) {
    const Index a = face[i];
    const Index b = face[(i + 1) % face.size()];
    if (!is_boundary(a, b)) continue;
    std::vector<Index> jags;
    for (const SurfacePoint& point :
         points_.jags_between(foot_of(a), foot_of(b), normals_[a] + normals_[b], tolerance)) {
      jags.push_back(add(point));
    }
    if (jags.empty()) continue;
    any = true;
    marks.set_chain(a, b, std::move(jags));
  }
  return any;
}

Index Refinement::add_on_edge(Index a, Index b) {
  if (is_boundary(a, b)) {
    if (const auto point = points_.between_on_boundary(foot_of(a), foot_of(b))) return add(*point);
  }
  return add_between(a, b, normals_[a] + normals_[b]);
}

Index Refinement::add_between(Index a, Index b, const Vec3& normal) {
  const Vec3 middle = 0.5 * (positions_[a] + positions_[b]);
  return add(points_.between(foot_of(a), foot_of(b), middle, normal));
}

bool Refinement::is_beyond(const SurfaceDistance& input, Index a, Index b, double tolerance) const {
  if (is_boundary(a, b) && points_.boundary_height(foot_of(a), foot_of(b)) > tolerance) {
    return true;
  }
  return std::ranges::any_of(kPlacesOnEdge, [&](double share) {
    const Vec3 p = positions_[a] + share * (positions_[b] - positions_[a]);
    return input.closest_within(p, tolerance).triangle == kNone;
  });
}

bool Refinement::is_short(std::span<const Index> face, std::size_t edge) const {
  const auto length = [&](std::size_t i) {
    return (positions_[face[(i + 1) % face.size()]] - positions_[face[i]]).norm();
  };
  double around = 0;
  for (std::size_t i = 0; i < face.size(); ++i) around += length(i);
  return length(edge) * static_cast<double>(face.size()) < kShortSide * around;
}

std::vector<std::size_t> Refinement::edges_to_divide(const ComparedSurfaces& surfaces,
                                                     const Target& target, double tolerance) const {
  const std::span<const Index> face = quads_.mesh.face(target.face);
  const std::size_t n = face.size();
  if (n == 3) return {0, 1, 2};
  std::vector<std::size_t> beyond;
  for (std::size_t i = 0; i < n; ++i) {
    const auto at = [&](std::size_t e) {
      return is_beyond(surfaces.input(), face[e % n], face[(e + 1) % n], tolerance);
    };
    if (at(i) || (n == 4 && !is_short(face, i) && at(i + 2))) beyond.push_back(i);
  }
  if (!beyond.empty()) return beyond;
  std::vector<Vec3> corners;
  for (const Index v : face) corners.push_back(positions_[v]);
  return edges_across_bend(corners, cell_bend(surfaces, target.face), target.distance);
}

}  // namespace strake
