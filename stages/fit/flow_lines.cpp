#include "stages/fit/flow_lines.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "common/geometry/angles.h"
#include "common/geometry/poly_topology/face_shape.h"
#include "common/geometry/poly_topology/poly_edges.h"

namespace strake::fitting {
namespace {

/// Corners above this are the straight side of a T-joint.
constexpr double kJointAngle = 150 * kDegree;
/// What it costs to leave the field's direction, to bend, and to leave the middle between
/// neighbours; for the same angle.
constexpr double kAlong = 150;
constexpr double kStraight = 25;
constexpr double kEven = 5;
/// T-joints that are corners of quads bend out of them where directions mean little, to an angle of
/// 140 degrees: by this share of the way between their neighbours, and at this cost.
constexpr double kBend = 0.18;
constexpr double kBent = kAlong;
/// Directions mean little where turning a line moves it by less than this off the surface, in root
/// mean squares of the distance.
constexpr double kNoticed = 3;
/// Importance of directions that counts as none.
constexpr double kUnimportant = 0.1;
/// Edges steeper than this against the surface have no direction on it.
constexpr double kLeastTangential = 0.3;

/// The wish that a sum of positions, each times its factor, had no part along `side`.
struct DirectionTerm {
  std::array<Index, 3> vertices = {0, 0, 0};
  std::array<double, 3> factors = {0, 0, 0};
  Vec3 side = Vec3::Zero();  ///< unit
  double weight = 0;
  double residual = 0;  ///< the part there is
};

/// The wish of an edge to have no part along one of two directions, if that part is the smaller
/// one: none where both are as large, so that diagonals of a cross stay what they are.
DirectionTerm turned(const std::array<Index, 2>& edge, const Vec3& side, double part, double other,
                     double square) {
  const double square_length = other * other + part * part;
  if (!(square_length > 0)) return {};
  const double clear = std::max(0.0, other * other - part * part) / square_length;
  return {{edge[0], edge[1], edge[0]},
          {-1, 1, 0},
          side,
          kAlong * square * clear * clear * clear * clear,  // cosine of the double angle
          part};
}

/// The wish of an edge to run along the cross at its end `v`. \param arm  one of the cross's arms
DirectionTerm along_cross(const VertexPlaces& places, const Vec3& arm,
                          const std::array<Index, 2>& edge, Index v, double square) {
  const Vec3 way = places.positions()[edge[1]] - places.positions()[edge[0]];
  const Vec3 other = places.normal(v).cross(arm);
  const double x = way.dot(arm);
  const double y = way.dot(other);
  if (!(x * x + y * y > kLeastTangential * kLeastTangential * way.squaredNorm())) return {};
  return std::abs(x) >= std::abs(y) ? turned(edge, other, y, x, square)
                                    : turned(edge, arm, x, y, square);
}

/// How much directions matter to a way along the surface at a vertex, from 0 to 1: by how far the
/// surface leaves the way's chord more in one direction than in the other.
double importance(const VertexPlaces& places, const PrincipalField& field, Index vertex,
                  const Vec3& way, double square) {
  const double sag = places.anisotropy(field, vertex) * way.squaredNorm() / 8;
  const double unnoticed = kNoticed * std::sqrt(square);
  return sag + unnoticed > 0 ? sag / (sag + unnoticed) : 1.0;
}

/// The wish of an edge that leaves a feature or boundary line to do so at a right angle.
DirectionTerm across_line(const VertexPlaces& places, const Vec3& tangent,
                          const std::array<Index, 2>& edge, double square) {
  const Vec3 way = places.positions()[edge[1]] - places.positions()[edge[0]];
  const double along = way.dot(tangent);
  return turned(edge, tangent, along, (way - along * tangent).norm(), square);
}

}  // namespace

FlowLines::FlowLines(const PolyMesh& mesh) : mesh_(mesh) {
  PolyEdges edges = collect_edges(mesh);
  const std::vector<Index> opposite = opposite_sides(edges);
  edges_ = std::move(edges.vertices);
  face_of_ = std::move(edges.corner_face);
  std::vector<Index> corner_at(mesh.positions.size(), kNone);
  for (std::size_t c = 0; c < mesh.corners.size(); ++c) {
    corner_at[mesh.corners[c]] = static_cast<Index>(c);
  }
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (corner_at[v] != kNone) follow_lines(v, corners_around(opposite, corner_at[v]));
  }
}

/// The corners at a vertex counter-clockwise; none on the boundary.
std::vector<Index> FlowLines::corners_around(const std::vector<Index>& opposite,
                                             Index first) const {
  std::vector<Index> corners;
  Index c = first;
  do {
    corners.push_back(c);
    c = opposite[mesh_.previous_corner(face_of_[c], c)];
    if (c == kNone) return {};
  } while (c != first);
  return corners;
}

void FlowLines::follow_lines(Index vertex, const std::vector<Index>& around) {
  std::vector<Index> ends;
  for (const Index c : around) ends.push_back(mesh_.corners[mesh_.next_corner(face_of_[c], c)]);
  if (ends.size() == 4) {
    through_.push_back({ends[0], vertex, ends[2]});
    through_.push_back({ends[1], vertex, ends[3]});
    return;
  }
  if (ends.size() != 3) return;
  for (int i = 0; i < 3; ++i) {
    Through line{ends[(i + 1) % 3], vertex, ends[i]};
    const Vec3& p = mesh_.positions[vertex];
    if (angle_between(mesh_.positions[line.before] - p, mesh_.positions[line.after] - p) <
        kJointAngle) {
      continue;
    }
    const Index face = face_of_[around[i]];
    line.is_quad_corner = mesh_.face(face).size() == 4;
    through_.push_back(line);
    if (mesh_.face(face).size() > 3) joints_.push_back({face, line});
    return;
  }
}

std::vector<std::vector<Index>> FlowLines::neighbours() const {
  std::vector<std::vector<Index>> rows(mesh_.positions.size());
  for (Index f = 0; f < mesh_.face_count(); ++f) {
    for (const Index v : mesh_.face(f)) {
      for (const Index w : mesh_.face(f)) {
        if (v != w) rows[v].push_back(w);
      }
    }
  }
  for (const Through& line : through_) {
    rows[line.before].push_back(line.after);
    rows[line.after].push_back(line.before);
  }
  for (std::vector<Index>& row : rows) {
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
  }
  return rows;
}

std::vector<double> FlowLines::shares_for_lines(const VertexPlaces& places,
                                                const PrincipalField& field,
                                                const std::vector<double>& squares) const {
  const std::vector<Vec3>& p = places.positions();
  std::vector<double> share(edges_.size(), 1.0);
  std::vector<double> most(p.size(), 0.0);  // importance of an edge at a vertex of a line
  const auto ends = [&](const std::array<Index, 2>& edge) {  // on the line, free
    return places.is_free(edge[0]) ? std::pair{edge[1], edge[0]} : std::pair{edge[0], edge[1]};
  };
  const auto is_shared = [&](const std::array<Index, 2>& edge) {
    return places.is_free(edge[0]) != places.is_free(edge[1]);
  };
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    if (!is_shared(edges_[e])) continue;
    const auto [on_line, free] = ends(edges_[e]);
    share[e] = importance(places, field, free, p[free] - p[on_line], squares[free]);
    most[on_line] = std::max(most[on_line], share[e]);
  }
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    if (!is_shared(edges_[e])) continue;
    share[e] = (share[e] + kUnimportant) / (most[ends(edges_[e]).first] + kUnimportant);
  }
  return share;
}

template <class Use>
void FlowLines::for_terms(const VertexPlaces& places, const PrincipalField* field,
                          const std::vector<double>& squares, const Use& use) const {
  const std::vector<Vec3>& p = places.positions();
  std::vector<double> freedom(p.size(), 0.0);  // of edges of a T-joint to leave the field
  std::vector<std::array<Index, 2>> beside(p.size(), {kNone, kNone});
  for (const Through& line : through_) {
    const auto& [before, vertex, after, is_quad_corner] = line;
    const Vec3 way = p[after] - p[before];
    DirectionTerm term{{vertex, before, after}, {-1, 0.5, 0.5}};
    const Vec3 off = 0.5 * (p[before] + p[after]) - p[vertex];
    term.side = places.normal(vertex).cross(way).normalized();
    term.residual = term.side.dot(off);
    term.weight = kStraight * squares[vertex];
    if (is_quad_corner && field != nullptr) {
      freedom[vertex] = 1 - importance(places, *field, vertex, way, squares[vertex]);
      beside[vertex] = {before, after};
      term.residual -= freedom[vertex] * kBend * way.norm();
      term.weight += freedom[vertex] * kBent * squares[vertex];
    }
    use(term);
    term.side = term.side.cross(places.normal(vertex));
    term.residual = term.side.dot(off);
    term.weight = kEven * squares[vertex];
    use(term);
  }
  if (field == nullptr) return;
  std::vector<Vec3> arms(p.size());
  tbb::parallel_for(Index{0}, mesh_.vertex_count(),
                    [&](Index v) { arms[v] = places.cross_arm(*field, v); });
  const std::vector<double> shares = shares_for_lines(places, *field, squares);
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    const std::array<Index, 2>& edge = edges_[e];
    const double share = shares[e];
    const auto use_shared = [&](DirectionTerm term) {
      const double weight = term.weight;
      term.weight = share * weight;
      use(term);
      if (share == 1) return;
      term.weight = (1 - share) * weight;
      term.factors[places.is_free(edge[0]) ? 1 : 0] = 0;  // moves the free end alone
      use(term);
    };
    double bound = 1;
    for (int i = 0; i < 2; ++i) {
      if (std::ranges::count(beside[edge[i]], edge[1 - i]) > 0) bound *= 1 - freedom[edge[i]];
    }
    for (const Index v : edge) {
      if (places.is_free(v)) {
        use_shared(along_cross(places, arms[v], edge, v, bound * squares[v] / 2));
      } else if (places.is_on_line(v)) {
        use_shared(across_line(places, places.line_tangent(v), edge, squares[v] / 2));
      }
    }
  }
}

double FlowLines::cost(const VertexPlaces& places, const PrincipalField* field,
                       const std::vector<double>& squares) const {
  double sum = 0;
  for_terms(places, field, squares,
            [&](const DirectionTerm& term) { sum += term.weight * term.residual * term.residual; });
  return sum;
}

void FlowLines::add_to(BlockSystem& system, const VertexPlaces& places, const PrincipalField* field,
                       const std::vector<double>& squares) const {
  for_terms(places, field, squares, [&](const DirectionTerm& term) {
    const Mat3 across = term.weight * term.side * term.side.transpose();
    for (int i = 0; i < 3; ++i) {
      if (term.factors[i] == 0) continue;
      system.add_right(term.vertices[i],
                       -term.weight * term.factors[i] * term.residual * term.side);
      for (int j = 0; j < 3; ++j) {
        if (term.factors[j] == 0) continue;
        system.add(term.vertices[i], term.vertices[j], term.factors[i] * term.factors[j] * across);
      }
    }
  });
}

void FlowLines::straighten_joints(VertexPlaces& places) const {
  for (const auto& [face, along] : joints_) {
    const std::vector<Vec3>& p = places.positions();
    const Vec3 inward =
        newell_normal(p, mesh_.face(face)).normalized().cross(p[along.after] - p[along.before]);
    const double length2 = inward.squaredNorm();
    const double dent = inward.dot(p[along.vertex] - p[along.before]);
    if (dent > 0 && length2 > 0) places.move(along.vertex, -(dent / length2) * inward);
  }
}

}  // namespace strake::fitting
