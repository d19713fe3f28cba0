#include "stages/fit/vertex_places.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "common/geometry/frames.h"
#include "common/geometry/poly_topology/poly_edges.h"
#include "common/geometry/surface_point.h"
#include "stages/fit/result_components.h"

namespace strake::fitting {
namespace {

/// A vertex nearer to the boundary than this share of the diagonal is on it.
constexpr double kOnBoundary = 1e-9;
/// A foot stays on a sheet whose normal is within 60 degrees of the last one.
constexpr double kLeastAgreement = 0.5;
/// A line between neighbours on it is at most this many times as long as their edge: up to half a
/// circle. The other way around a ring is longer.
constexpr double kLongestWay = 2;
/// Vertices of the input that stand for such a line.
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
      for (int i = 0; i < 3; ++i) {
        const Index h = 3 * quads.provenance.face[v] + i;
        const Index out = mesh.vertex_out[mesh.from(h)];
        if (quads.provenance.barycentric[v][(i + 2) % 3] < kOnEdge && mesh.is_boundary(h)) {
          starts.emplace_back(h, length);
        } else if (quads.provenance.barycentric[v][i] > 1 - kOnEdge && mesh.is_boundary(out)) {
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
      borders_(course_for(mesh, quads)),
      face_normals_(mesh),
      own_normals_(field == nullptr ? strake::wedge_normals(mesh, face_normals_)
                                    : std::vector<Vec3>()),
      wedge_normals_(field == nullptr ? own_normals_ : field->normal),
      positions_(quads.mesh.positions),
      normals_(positions_.size()),
      lines_(positions_.size()),
      foot_face_(quads.provenance.face),
      foot_(quads.provenance.barycentric) {
  for (Vec3& p : positions_) p -= mesh.origin;
  const std::vector<std::uint8_t> is_of_input =
      vertices_of_input(mesh, quads, vertex_components(quads.mesh));
  tbb::parallel_for(Index{0}, quads.mesh.vertex_count(), [&](Index v) {
    if (is_of_input[v] != 0) {
      lines_[v].kind = Kind::fixed;
    } else {
      place_on_line(v);
      lines_[v].is_on_course = lines_[v].kind == Kind::line && is_off_boundary(v);
    }
    normals_[v] = normal_at_foot(v);
  });
}

void VertexPlaces::place_on_line(Index v) {
  const auto& at = foot_[v];
  LinePlace& place = lines_[v];
  for (int i = 0; i < 3; ++i) {
    if (at[i] < 1 - kOnEdge) continue;
    const Index vertex = mesh_.from(3 * foot_face_[v] + i);
    const std::vector<Index> barriers = barriers_around(vertex);
    if (is_corner(vertex)) {
      place.kind = Kind::fixed;
    } else if (barriers.empty()) {
      return;
    } else if (barriers.size() != 2) {
      place.kind = Kind::fixed;
    } else {
      place = {Kind::line, barriers[0], mesh_.from(barriers[0]) == vertex ? 0.0 : 1.0};
    }
    return;
  }
  for (int i = 0; i < 3; ++i) {
    const Index opposite = 3 * foot_face_[v] + (i + 1) % 3;
    if (at[i] < kOnEdge && mesh_.is_barrier(opposite)) {
      place = {Kind::line, opposite, at[(i + 2) % 3]};
      return;
    }
  }
}

/// A half-edge of each feature or boundary edge at a vertex.
std::vector<Index> VertexPlaces::barriers_around(Index vertex) const {
  std::vector<Index> barriers;
  const Index first = mesh_.vertex_out[vertex];
  for (Index h = first; h != kNone;) {
    if (mesh_.is_barrier(h)) barriers.push_back(h);
    if (mesh_.is_boundary(TriMesh::prev(h))) barriers.push_back(TriMesh::prev(h));
    h = mesh_.rotate_ccw(h);
    if (h == first) break;
  }
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
  const Vec3 foot = place_of(mesh_, {foot_face_[v], foot_[v]});
  return (positions_[v] - foot).norm() > kOnBoundary * mesh_.diagonal;
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
  LineWay way{place.halfedge, distance >= 0};
  double left = std::abs(distance);
  while (true) {
    const double length =
        (line_end(place, mesh_.to(place.halfedge)) - line_end(place, mesh_.from(place.halfedge)))
            .norm();
    const double ahead = length * (way.is_forward ? 1 - place.along : place.along);
    if (left <= ahead) {
      if (length > 0) place.along += (way.is_forward ? left : -left) / length;
      place.along = std::clamp(place.along, 0.0, 1.0);
      return place;
    }
    left -= ahead;
    place.along = way.is_forward ? 1 : 0;
    go_on(way);
    // Around a loop it comes back: one of no length would be gone around for ever.
    if (way.halfedge == kNone || mesh_.edge_of(way.halfedge) == start) return place;
    place.halfedge = way.halfedge;
    place.along = way.is_forward ? 0 : 1;
  }
}

Index VertexPlaces::vertex_of_input(Index v) const {
  for (int i = 0; i < 3; ++i) {
    if (foot_[v][i] > 1 - kOnEdge) return mesh_.from(3 * foot_face_[v] + i);
  }
  return kNone;
}

std::vector<std::array<Index, 2>> VertexPlaces::line_steps() const {
  std::multimap<Index, Index> on_edge;  // edge of the input, vertex
  std::map<Index, Index> at_vertex;     // corner of the input, vertex
  for (Index v = 0; v < static_cast<Index>(lines_.size()); ++v) {
    if (lines_[v].kind == Kind::line) on_edge.emplace(mesh_.edge_of(lines_[v].halfedge), v);
    if (lines_[v].kind == Kind::fixed) at_vertex.emplace(vertex_of_input(v), v);
  }
  const auto next = [&](Index v, LineWay way) {
    const Index start = mesh_.edge_of(way.halfedge);
    const auto passed = [&](Index w) {  // share of the edge of `way` until there
      const LinePlace& place = lines_[w];
      return (place.halfedge == way.halfedge) == way.is_forward ? place.along : 1 - place.along;
    };
    double from = passed(v);
    do {
      Index first = kNone;
      const auto [begin, end] = on_edge.equal_range(mesh_.edge_of(way.halfedge));
      for (auto other = begin; other != end; ++other) {
        const Index w = other->second;
        if (w == v || passed(w) < from || (first != kNone && passed(w) >= passed(first))) continue;
        first = w;
      }
      if (first != kNone) return first;
      const auto corner = at_vertex.find(go_on(way));
      if (corner != at_vertex.end()) return corner->second;
      from = 0;
    } while (way.halfedge != kNone && mesh_.edge_of(way.halfedge) != start);
    return kNone;
  };
  std::set<std::array<Index, 2>> steps;
  for (Index v = 0; v < static_cast<Index>(lines_.size()); ++v) {
    if (lines_[v].kind != Kind::line) continue;
    for (const bool forward : {true, false}) {
      const Index w = next(v, {lines_[v].halfedge, forward});
      if (w != kNone) steps.insert({std::min(v, w), std::max(v, w)});
    }
  }
  return {steps.begin(), steps.end()};
}

std::vector<Vec3> VertexPlaces::line_between(Index a, Index b) const {
  if (!is_on_line(a)) std::swap(a, b);
  const PassedLine forward = line_on_to(a, b, true);
  const PassedLine back = line_on_to(a, b, false);
  const std::vector<Vec3>& line = forward.length <= back.length ? forward.places : back.places;
  if (line.size() <= kMostBetween) return line;
  std::vector<Vec3> some;
  for (std::size_t i = 0; i < kMostBetween; ++i) {
    some.push_back(line[(2 * i + 1) * line.size() / (2 * kMostBetween)]);
  }
  return some;
}

VertexPlaces::PassedLine VertexPlaces::line_on_to(Index a, Index b, bool forward) const {
  const Index corner = is_on_line(b) ? kNone : vertex_of_input(b);
  const Index edge = is_on_line(b) ? mesh_.edge_of(lines_[b].halfedge) : kNone;
  const double longest = kLongestWay * (positions_[b] - positions_[a]).norm();
  const PassedLine none{{}, std::numeric_limits<double>::infinity()};
  PassedLine passed;
  LineWay way{lines_[a].halfedge, forward};
  Vec3 last = positions_[a];
  while (mesh_.edge_of(way.halfedge) != edge) {
    const Index vertex = go_on(way);
    if (vertex == corner) break;
    if (way.halfedge == kNone) return none;
    const Vec3 place = line_end(lines_[a], vertex);
    passed.length += (place - last).norm();
    if (passed.length > longest) return none;
    passed.places.push_back(place);
    last = place;
  }
  passed.length += (positions_[b] - last).norm();
  return passed;
}

Index VertexPlaces::go_on(LineWay& way) const {
  const Index vertex = way.is_forward ? mesh_.to(way.halfedge) : mesh_.from(way.halfedge);
  way.halfedge = other_barrier(vertex, way.halfedge);
  way.is_forward = way.halfedge != kNone && mesh_.from(way.halfedge) == vertex;
  return vertex;
}

Mat3 VertexPlaces::freedom(Index v) const {
  switch (lines_[v].kind) {
    case Kind::free:
      return Mat3::Identity();
    case Kind::line: {
      const Vec3 t = tangent(lines_[v]);
      return t * t.transpose();
    }
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
  line = slide(line, move.dot(tangent(line)));
  positions_[v] = at(line);
}

Vec3 VertexPlaces::normal_at_foot(Index v) const {
  Vec3 normal = Vec3::Zero();
  for (int i = 0; i < 3; ++i) {
    normal += foot_[v][i] * wedge_normals_[mesh_.face_wedges[foot_face_[v]][i]];
  }
  return normal.norm() > 0 ? Vec3(normal.normalized()) : face_normals_[foot_face_[v]];
}

double VertexPlaces::height(Index v) const {
  Vec3 foot = Vec3::Zero();
  for (int i = 0; i < 3; ++i) {
    foot += foot_[v][i] * mesh_.positions[mesh_.faces[foot_face_[v]][i]];
  }
  return (positions_[v] - foot).dot(normals_[v]);
}

Vec3 VertexPlaces::cross_arm(const PrincipalField& field, Index v) const {
  const TangentFrame frame = tangent_frame(normals_[v]);
  std::complex<double> sum = 0;
  for (int i = 0; i < 3; ++i) {
    const Index w = mesh_.face_wedges[foot_face_[v]][i];
    sum += foot_[v][i] * cross_power(frame.tangent_from_world(
                             rotate_between(field.normal[w], normals_[v], field.cross[w])));
  }
  if (std::abs(sum) < 1e-6) return Vec3::Zero();
  return frame.world_from_tangent(strake::cross_arm(sum, Vec2(1, 0)));
}

void VertexPlaces::update_feet() {
  tbb::parallel_for(std::size_t{0}, positions_.size(), [&](std::size_t v) {
    if (lines_[v].kind == Kind::line) {
      foot_face_[v] = TriMesh::face_of(lines_[v].halfedge);
      const int i = lines_[v].halfedge % 3;
      foot_[v] = {0, 0, 0};
      foot_[v][i] = 1 - lines_[v].along;
      foot_[v][(i + 1) % 3] = lines_[v].along;
    } else if (lines_[v].kind == Kind::free) {
      const auto& [a, b, c] = mesh_.faces[foot_face_[v]];
      const double bound = closest_point_on_triangle(positions_[v], mesh_.positions[a],
                                                     mesh_.positions[b], mesh_.positions[c])
                               .distance;
      const Vec3 side = face_normals_[foot_face_[v]];
      const ClosestPoint nearest = surface_.closest_if(positions_[v], bound, [&](Index f) {
        return f == foot_face_[v] || face_normals_[f].dot(side) > kLeastAgreement;
      });
      foot_face_[v] = nearest.triangle;
      foot_[v] = nearest.barycentric;
    }
    normals_[v] = normal_at_foot(static_cast<Index>(v));
  });
}

double VertexPlaces::anisotropy(const PrincipalField& field, Index v) const {
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    const Index w = mesh_.face_wedges[foot_face_[v]][i];
    sum += foot_[v][i] * std::abs(field.k_max[w] - field.k_min[w]);
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
  }
  quads.provenance.face = foot_face_;
  quads.provenance.barycentric = foot_;
}

}  // namespace strake::fitting
