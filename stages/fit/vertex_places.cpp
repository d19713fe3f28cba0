#include "stages/fit/vertex_places.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "common/geometry/frames.h"
#include "common/geometry/surface_point.h"
#include "stages/fit/result_components.h"

namespace strake::fitting {
namespace {

/// A foot stays on a sheet whose normal is within 60 degrees of the last one.
constexpr double kLeastAgreement = 0.5;

}  // namespace

VertexPlaces::VertexPlaces(const TriMesh& mesh, const SurfaceDistance& surface,
                           const QuadMesh& quads, const PrincipalField* field)
    : mesh_(mesh),
      surface_(surface),
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
    if (mesh_.is_corner[vertex] != 0) {
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
  if (mesh_.is_corner[vertex] != 0) return kNone;
  const std::vector<Index> barriers = barriers_around(vertex);
  if (barriers.size() != 2) return kNone;
  return mesh_.edge_of(barriers[0]) == mesh_.edge_of(halfedge) ? barriers[1] : barriers[0];
}

Vec3 VertexPlaces::tangent(const LinePlace& place) const {
  return (mesh_.positions[mesh_.to(place.halfedge)] - mesh_.positions[mesh_.from(place.halfedge)])
      .normalized();
}

Vec3 VertexPlaces::at(const LinePlace& place) const {
  const Vec3& a = mesh_.positions[mesh_.from(place.halfedge)];
  return a + place.along * (mesh_.positions[mesh_.to(place.halfedge)] - a);
}

VertexPlaces::LinePlace VertexPlaces::slide(LinePlace place, double distance) const {
  const Index start = mesh_.edge_of(place.halfedge);
  bool forward = distance >= 0;
  double left = std::abs(distance);
  while (true) {
    const double length =
        (mesh_.positions[mesh_.to(place.halfedge)] - mesh_.positions[mesh_.from(place.halfedge)])
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
