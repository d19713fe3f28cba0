#include "stages/fit/vertex_places.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "common/geometry/frames.h"
#include "common/geometry/poly_topology/poly_edges.h"
#include "common/geometry/topology/vertex_ring.h"
#include "stages/fit/guide_vertices.h"
#include "stages/fit/result_components.h"

namespace strake::fitting {
namespace {

/// A vertex nearer to the boundary than this share of the diagonal is on it.
constexpr double kOnBoundary = 1e-9;
/// Vertices of the input's boundary that stand for what lies between two of the result's.
constexpr std::size_t kMostBetween = 4;

/// [V of the input] lengths of the edges of a result that stand for the boundary there; 0
/// elsewhere.
std::vector<double> lengths_on_boundary(const TriMesh& mesh, const QuadMesh& quads) {
  std::vector<std::pair<Index, double>> starts;  // half-edge that a boundary edge starts on, length
  const PolyEdges edges = collect_edges(quads.mesh);
  for (Index e = 0; e < edges.edge_count(); ++e) {
    if (edges.sides_of(e).size() != 1) continue;
    const auto& [a, b] = edges.vertices[e];
    const double length = (quads.mesh.positions[b] - quads.mesh.positions[a]).norm();
    if (!(length > 0)) continue;
    for (const Index v : {a, b}) {
      const SurfacePoint foot = foot_of(quads.provenance, v);
      const Index corner = corner_at(foot);
      for (Index h = 3 * foot.face; h < 3 * foot.face + 3; ++h) {
        const Index out = mesh.vertex_out[mesh.from(h)];
        if (is_on_edge(foot, h) && mesh.is_boundary(h)) {
          starts.emplace_back(h, length);
        } else if (h == corner && mesh.is_boundary(out)) {
          starts.emplace_back(out, length);
        }
      }
    }
  }
  std::sort(starts.begin(), starts.end());  // of several on a half-edge the longest is left
  std::vector<double> lengths(mesh.positions.size(), 0.0);
  for (const auto& [h, length] : starts) lengths[mesh.from(h)] = length;
  for (const auto& [start, length] : starts) {
    for (Index h = mesh.vertex_out[mesh.to(start)]; lengths[mesh.from(h)] == 0;
         h = mesh.vertex_out[mesh.to(h)]) {
      lengths[mesh.from(h)] = lengths[mesh.from(start)];
    }
  }
  return lengths;
}

/// The course of ragged boundaries for vertices as far apart as those of a result.
BorderCourse course_for(const TriMesh& mesh, const QuadMesh& quads) {
  if (ragged_directions(mesh).empty()) return {};
  return border_course(mesh, lengths_on_boundary(mesh, quads),
                       std::numeric_limits<double>::infinity());
}

}  // namespace

VertexPlaces::VertexPlaces(const TriMesh& mesh, const SurfaceDistance& surface,
                           const QuadMesh& quads, const PrincipalField* field)
    : mesh_(mesh),
      surface_(surface),
      components_(mesh),
      borders_(course_for(mesh, quads)),
      face_normals_(mesh),
      own_normals_(field == nullptr ? strake::wedge_normals(mesh, face_normals_)
                                    : std::vector<Vec3>()),
      wedge_normals_(field == nullptr ? own_normals_ : field->normal),
      positions_(quads.mesh.positions),
      normals_(positions_.size()),
      lines_(positions_.size()) {
  for (Vec3& p : positions_) p -= mesh.origin;
  for (Index v = 0; v < quads.mesh.vertex_count(); ++v) {
    feet_.push_back(foot_of(quads.provenance, v));
  }
  const std::vector<std::uint8_t> is_of_input =
      vertices_of_input(mesh, quads, vertex_components(quads.mesh));
  const std::vector<std::optional<Vec3>> ways =
      ways_to_guides(mesh, quads, field == nullptr ? LaidGuides() : field->guides);
  tbb::parallel_for(Index{0}, quads.mesh.vertex_count(), [&](Index v) {
    if (is_of_input[v] != 0) {
      lines_[v].kind = Kind::fixed;
    } else {
      place_on_line(v);
      if (lines_[v].kind == Kind::free && ways[v]) put_on_guide(v, *ways[v]);
      lines_[v].is_on_course = lines_[v].kind == Kind::line && is_off_boundary(v);
    }
    normals_[v] = normal_at_foot(v);
  });
}

void VertexPlaces::put_on_guide(Index v, const Vec3& way) {
  lines_[v].kind = Kind::guided;
  const Vec3 foot = place_of(mesh_, feet_[v]) + way;
  const ClosestPoint nearest = nearest_foot(v, foot);
  feet_[v] = {nearest.triangle, nearest.barycentric};
  positions_[v] += way;
}

void VertexPlaces::place_on_line(Index v) {
  LinePlace& place = lines_[v];
  const Index corner = corner_at(feet_[v]);
  if (corner == kNone) {
    const Index h = edge_at(feet_[v], [&](Index side) { return mesh_.is_barrier(side); });
    if (h != kNone) place = {Kind::line, h, share_along(feet_[v], h)};
    return;
  }
  const Index vertex = mesh_.from(corner);
  const std::vector<Index> barriers = barriers_around(vertex);
  if (!is_corner(vertex) && barriers.empty()) return;
  if (is_corner(vertex) || barriers.size() != 2) {
    place.kind = Kind::fixed;
  } else {
    place = {Kind::line, barriers[0], mesh_.from(barriers[0]) == vertex ? 0.0 : 1.0};
  }
}

/// A half-edge of each feature or boundary edge at a vertex.
std::vector<Index> VertexPlaces::barriers_around(Index vertex) const {
  std::vector<Index> barriers;
  for_each_outgoing(mesh_, vertex, [&](Index h) {
    if (mesh_.is_barrier(h)) barriers.push_back(h);
    if (mesh_.is_boundary(TriMesh::prev(h))) barriers.push_back(TriMesh::prev(h));
  });
  return barriers;
}

/// The barrier by which a line goes on beyond a vertex; kNone where it ends there.
Index VertexPlaces::other_barrier(Index vertex, Index halfedge) const {
  if (is_corner(vertex)) return kNone;
  const std::vector<Index> barriers = barriers_around(vertex);
  if (barriers.size() != 2) return kNone;
  return mesh_.edge_of(barriers[0]) == mesh_.edge_of(halfedge) ? barriers[1] : barriers[0];
}

bool VertexPlaces::is_off_boundary(Index v) const {
  if (!borders_.is_off(mesh_, lines_[v].halfedge)) return false;
  return (positions_[v] - place_of(mesh_, feet_[v])).norm() > kOnBoundary * mesh_.diagonal;
}

Vec3 VertexPlaces::line_end(const LinePlace& place, Index vertex) const {
  return place.is_on_course ? borders_.place(mesh_, vertex) : mesh_.positions[vertex];
}

Vec3 VertexPlaces::tangent(const LinePlace& place) const {
  if (place.is_on_course && borders_.is_off(mesh_, place.halfedge)) {
    const Vec3& direction = borders_.direction[mesh_.from(place.halfedge)];
    if (!direction.isZero(0)) return direction;
  }
  return (mesh_.positions[mesh_.to(place.halfedge)] - mesh_.positions[mesh_.from(place.halfedge)])
      .normalized();
}

Vec3 VertexPlaces::at(const LinePlace& place) const {
  const Vec3 a = line_end(place, mesh_.from(place.halfedge));
  return a + place.along * (line_end(place, mesh_.to(place.halfedge)) - a);
}

VertexPlaces::LinePlace VertexPlaces::slide(LinePlace place, double distance) const {
  const Index start = mesh_.edge_of(place.halfedge);
  bool forward = distance >= 0;
  double left = std::abs(distance);
  while (true) {
    const double length =
        (line_end(place, mesh_.to(place.halfedge)) - line_end(place, mesh_.from(place.halfedge)))
            .norm();
    const double ahead = length * (forward ? 1 - place.along : place.along);
    if (left <= ahead) {
      if (length > 0) place.along += (forward ? left : -left) / length;
      place.along = std::clamp(place.along, 0.0, 1.0);
      return place;
    }
    left -= ahead;
    place.along = forward ? 1 : 0;
    const Index vertex = forward ? mesh_.to(place.halfedge) : mesh_.from(place.halfedge);
    const Index next = other_barrier(vertex, place.halfedge);
    // Around a loop it comes back: one of no length would be gone around for ever.
    if (next == kNone || mesh_.edge_of(next) == start) return place;
    forward = mesh_.from(next) == vertex;
    place.halfedge = next;
    place.along = forward ? 0 : 1;
  }
}

Index VertexPlaces::boundary_at(Index v) const {
  Index h = lines_[v].halfedge;
  const Index corner = corner_at(feet_[v]);
  if (h == kNone && corner != kNone) h = mesh_.vertex_out[mesh_.from(corner)];
  return h != kNone && mesh_.is_boundary(h) ? h : kNone;
}

std::vector<Vec3> VertexPlaces::boundary_between(Index a, Index b) const {
  const Index first = boundary_at(a);
  const Index last = boundary_at(b);
  if (first == kNone || last == kNone || !(is_on_line(a) || is_on_line(b))) return {};
  const LinePlace& slides = lines_[is_on_line(a) ? a : b];
  std::vector<Vec3> places;
  for (Index h = first; h != last;) {
    const Index vertex = mesh_.to(h);
    places.push_back(line_end(slides, vertex));
    h = mesh_.vertex_out[vertex];
    if (h == first) return {};
  }
  if (places.size() <= kMostBetween) return places;
  std::vector<Vec3> some;
  for (std::size_t i = 0; i < kMostBetween; ++i) {
    some.push_back(places[(2 * i + 1) * places.size() / (2 * kMostBetween)]);
  }
  return some;
}

Mat3 VertexPlaces::freedom(Index v) const {
  switch (lines_[v].kind) {
    case Kind::free:
      return Mat3::Identity();
    case Kind::line: {
      const Vec3 t = tangent(lines_[v]);
      return t * t.transpose();
    }
    case Kind::guided:
      return normals_[v] * normals_[v].transpose();
    case Kind::fixed:
      break;
  }
  return Mat3::Zero();
}

void VertexPlaces::move(Index v, const Vec3& move) {
  LinePlace& line = lines_[v];
  if (line.kind == Kind::fixed) return;
  if (line.kind == Kind::free) {
    positions_[v] += move;
    return;
  }
  if (line.kind == Kind::guided) {
    positions_[v] += freedom(v) * move;
    return;
  }
  line = slide(line, move.dot(tangent(line)));
  positions_[v] = at(line);
}

Vec3 VertexPlaces::normal_at_foot(Index v) const {
  Vec3 normal = Vec3::Zero();
  const SurfacePoint& foot = feet_[v];
  for (int i = 0; i < 3; ++i) {
    normal += foot.barycentric[i] * wedge_normals_[mesh_.face_wedges[foot.face][i]];
  }
  return normal.norm() > 0 ? Vec3(normal.normalized()) : face_normals_[foot.face];
}

double VertexPlaces::height(Index v) const {
  return (positions_[v] - place_of(mesh_, feet_[v])).dot(normals_[v]);
}

Vec3 VertexPlaces::cross_arm(const PrincipalField& field, Index v) const {
  const TangentFrame frame = tangent_frame(normals_[v]);
  std::complex<double> sum = 0;
  for (int i = 0; i < 3; ++i) {
    const Index w = mesh_.face_wedges[feet_[v].face][i];
    sum += feet_[v].barycentric[i] * cross_power(frame.tangent_from_world(rotate_between(
                                         field.normal[w], normals_[v], field.cross[w])));
  }
  if (std::abs(sum) < 1e-6) return Vec3::Zero();
  return frame.world_from_tangent(strake::cross_arm(sum, Vec2(1, 0)));
}

ClosestPoint VertexPlaces::nearest_foot(Index v, const Vec3& p) const {
  const Index face = feet_[v].face;
  const auto& [a, b, c] = mesh_.faces[face];
  const double bound =
      closest_point_on_triangle(p, mesh_.positions[a], mesh_.positions[b], mesh_.positions[c])
          .distance;
  const Vec3 side = face_normals_[face];
  return surface_.closest_if(p, bound, [&](Index f) {
    return f == face || (face_normals_[f].dot(side) > kSameSheet && components_.has_both(f, face));
  });
}

void VertexPlaces::update_feet() {
  tbb::parallel_for(std::size_t{0}, positions_.size(), [&](std::size_t v) {
    if (lines_[v].kind == Kind::line) {
      feet_[v] = point_along(lines_[v].halfedge, lines_[v].along);
    } else if (lines_[v].kind != Kind::fixed) {
      const ClosestPoint nearest = nearest_foot(static_cast<Index>(v), positions_[v]);
      feet_[v] = {nearest.triangle, nearest.barycentric};
    }
    normals_[v] = normal_at_foot(static_cast<Index>(v));
  });
}

double VertexPlaces::anisotropy(const PrincipalField& field, Index v) const {
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    const Index w = mesh_.face_wedges[feet_[v].face][i];
    sum += feet_[v].barycentric[i] * std::abs(field.k_max[w] - field.k_min[w]);
  }
  return sum;
}

std::vector<VertexPlaces::State> VertexPlaces::states() const {
  std::vector<State> states;
  for (std::size_t v = 0; v < positions_.size(); ++v) {
    states.push_back(state(static_cast<Index>(v)));
  }
  return states;
}

VertexPlaces::State VertexPlaces::state(Index v) const { return {positions_[v], lines_[v]}; }

void VertexPlaces::restore(Index v, const State& state) {
  positions_[v] = state.position;
  lines_[v] = state.line;
}

void VertexPlaces::store(QuadMesh& quads) const {
  for (std::size_t v = 0; v < positions_.size(); ++v) {
    quads.mesh.positions[v] = positions_[v] + mesh_.origin;
    set_foot(quads.provenance, static_cast<Index>(v), feet_[v]);
  }
}

}  // namespace strake::fitting
