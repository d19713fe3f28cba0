#include "stages/fit/fit.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "common/geometry/carry_attributes.h"
#include "common/geometry/patch_fill/mendable_crossings.h"
#include "common/geometry/patch_fill/refill_crossing.h"
#include "common/geometry/poly_topology/face_shape.h"
#include "common/geometry/poly_topology/poly_topology.h"
#include "common/geometry/poly_topology/same_topology.h"
#include "common/geometry/surface_distance/surface_distance.h"
#include "stages/fit/block_system.h"
#include "stages/fit/deviation.h"
#include "stages/fit/divide_crossing.h"
#include "stages/fit/even_flats.h"
#include "stages/fit/face_guard.h"
#include "stages/fit/flow_lines.h"
#include "stages/fit/move_apart.h"
#include "stages/fit/outline.h"
#include "stages/fit/result_components.h"
#include "stages/fit/vertex_places.h"

namespace strake {
namespace {

using fitting::BlockPattern;
using fitting::BlockSystem;
using fitting::Deviation;
using fitting::FaceGuard;
using fitting::FlowLines;
using fitting::Outline;
using fitting::VertexPlaces;

/// Weight that holds a vertex back along the normal, as a share of the samples' around it: what
/// they hardly tell about stays.
constexpr double kHold = 0.02;
/// Weight that holds it back on the surface: squared distance, in mean ones, that a move by the
/// length of an edge is worth.
constexpr double kHoldOnSurface = 10;
/// Root mean square of the distance, as a share of the length of a mean cell, below which it is no
/// reason to bend lines: they would snap to the edges of a tessellation, and what is flat goes by
/// directions and even steps alone.
constexpr double kUnseen = 0.007;
/// The least hold on the surface, in squares of that: no vertex is entirely free.
constexpr double kLeastHold = 0.03;
/// A vertex moves by at most this share of the way to a neighbour in a round, and of its shortest
/// edge along the normal.
constexpr double kLongestMove = 0.25;
/// Moves by a smaller share of its shortest edge, along the normal or altogether, are rounding:
/// they would only spoil what lies exactly in a plane.
constexpr double kShortestMove = 1e-8;
/// The least share of the mean area of a cell that counts: without any, nothing would hold a
/// vertex.
constexpr double kLeastShare = 1e-12;
/// Share of `kUnseen` by which a flat may be off a plane where the root mean square of the distance
/// is less than that, and by which evening it out may make it farther off.
constexpr double kLeastFlat = 1e-4;
/// Times the largest and the mean squared distance that evening out flats may end at.
constexpr double kMostFarther = 1.005;
constexpr std::array<double, 3> kSteps = {1, 0.5, 0.25};  ///< shares of the moves that are tried
constexpr double kLeastOfMove = 0.3;  ///< share of it that is made where faces would cross
constexpr int kMostRetreats = 14;     ///< times that vertices are put back for one step
/// Times the largest distance up to which faces may be parted.
constexpr double kPartedFarther = 1.5;

/// Triangles that faces are cut into by diagonals.
std::size_t triangle_count(const PolyMesh& mesh) {
  return mesh.corners.size() - 2 * static_cast<std::size_t>(mesh.face_count());
}

bool has_only_quads(const PolyMesh& mesh) {
  for (Index f = 0; f < mesh.face_count(); ++f) {
    if (mesh.face(f).size() != 4) return false;
  }
  return true;
}

class Fit {
 public:
  Fit(const TriMesh& mesh, const PrincipalField* field, const QuadMesh& quads)
      : quads_(quads),
        field_(field),
        surface_(mesh.positions, mesh.faces),
        places_(mesh, surface_, quads, field),
        deviation_(mesh, surface_, places_.face_normals(), places_.wedge_normals(),
                   triangle_count(quads.mesh)),
        outline_(quads.mesh, places_),
        lines_(quads.mesh),
        guard_(quads.mesh, places_),
        pattern_(lines_.neighbours()) {
    measure();
    double area = 0;
    for (const double share : vertex_areas()) area += share;
    const double mean_area = area / quads.mesh.face_count();
    unseen_ = kUnseen * std::sqrt(mean_area);
    cell_area_ = share_of_mean_cell(mean_area);
  }

  /// Whether nothing can be moved without harm.
  [[nodiscard]] bool is_tangled() const { return guard_.is_tangled(); }

  /// Moves vertices once. \return whether any was moved
  bool improve() {
    guard_.set_start(places_);
    const std::vector<VertexPlaces::State> start = places_.states();
    const std::vector<double> squares = for_cells(std::max(deviation_.mean(), unseen_ * unseen_));
    const double cost_before = cost(squares);
    const std::vector<Vec3> moves = solve(squares);
    if (std::ranges::all_of(moves, [](const Vec3& move) { return move.isZero(0); })) return false;
    for (const double step : kSteps) {
      for (Index v = 0; v < size(); ++v) {
        places_.restore(v, start[v]);
        places_.move(v, step * moves[v]);
      }
      lines_.straighten_joints(places_);
      if (!retreat(start, moves, step)) continue;
      measure();
      if (!(cost(squares) < cost_before)) continue;
      places_.update_feet();
      return true;
    }
    for (Index v = 0; v < size(); ++v) places_.restore(v, start[v]);
    measure();
    return false;
  }

  /// Evens out the vertices inside flats, unless the surface is not as flat there as it seems.
  /// \return number of vertices moved
  Index even_flats() {
    const std::vector<VertexPlaces::State> start = places_.states();
    const double largest = deviation_.largest();
    const double mean = deviation_.mean();
    const double least = kLeastFlat * unseen_;
    const Index moved =
        fitting::even_flats(quads_.mesh, field_, std::max(std::sqrt(mean), least), places_);
    if (moved == 0) return 0;
    places_.update_feet();
    measure();
    if (deviation_.mean() <= kMostFarther * mean + least * least &&
        deviation_.largest() <= kMostFarther * largest + least) {
      return moved;
    }
    put_back(start);
    return 0;
  }

  /// Moves vertices of crossing faces off each other, unless that takes some much farther off the
  /// surface: faces cross for good where the surface does.
  /// \return number of vertices moved
  Index part() {
    const std::vector<VertexPlaces::State> start = places_.states();
    const double largest = deviation_.largest();
    const Index moved = fitting::move_apart(quads_.mesh, guard_, places_);
    if (moved == 0) return 0;
    places_.update_feet();
    measure();
    if (deviation_.largest() <= kPartedFarther * largest) return moved;
    put_back(start);
    return 0;
  }

  /// Makes crossing faces of a result with these places anew. \return number of faces
  Index refill(const TriMesh& mesh, QuadMesh& quads) const {
    return refill_crossing_faces(mesh, surface_, quads, deviation_.largest());
  }

  /// Integral of the squared distance over result and surface.
  [[nodiscard]] double error() const { return deviation_.sum(); }
  [[nodiscard]] const VertexPlaces& places() const { return places_; }

 private:
  [[nodiscard]] Index size() const { return quads_.mesh.vertex_count(); }

  /// What is minimised. \param squares  [V] squared distance that a turn by a radian is worth
  [[nodiscard]] double cost(const std::vector<double>& squares) const {
    return deviation_.cost() + outline_.cost() + lines_.cost(places_, field_, squares);
  }

  /// [V] of a squared distance, what it is for cells as large as those of the vertex's component.
  [[nodiscard]] std::vector<double> for_cells(double square) const {
    std::vector<double> squares = cell_area_;
    for (double& share : squares) share *= square;
    return squares;
  }

  /// [V] mean area of the cells of the vertex's component, as a share of that of all cells, up
  /// to 1.
  [[nodiscard]] std::vector<double> share_of_mean_cell(double mean_area) const {
    const PolyMesh& mesh = quads_.mesh;
    const std::vector<Index> component = fitting::vertex_components(mesh);
    const std::vector<double> areas = vertex_areas();
    std::vector<double> area(component.size(), 0.0);  // of components, by their name
    std::vector<double> faces(component.size(), 0.0);
    for (Index v = 0; v < mesh.vertex_count(); ++v) area[component[v]] += areas[v];
    for (Index f = 0; f < mesh.face_count(); ++f) ++faces[component[mesh.face(f)[0]]];
    std::vector<double> share;
    share.reserve(component.size());
    for (const Index c : component) {
      share.push_back(std::clamp(area[c] / faces[c] / mean_area, kLeastShare, 1.0));
    }
    return share;
  }

  void measure() {
    triangles_ = triangulate_faces(quads_.mesh, places_.positions()).corners;
    deviation_.measure(places_.positions(), triangles_);
  }

  /// [V] a third of the triangles around.
  [[nodiscard]] std::vector<double> vertex_areas() const {
    const std::vector<Vec3>& p = places_.positions();
    std::vector<double> area(p.size(), 0.0);
    for (const auto& [a, b, c] : triangles_) {
      const double third = (p[b] - p[a]).cross(p[c] - p[a]).norm() / 6;
      for (const Index v : {a, b, c}) area[v] += third;
    }
    return area;
  }

  /// Puts all vertices back, after their feet were found.
  void put_back(const std::vector<VertexPlaces::State>& start) {
    for (Index v = 0; v < size(); ++v) places_.restore(v, start[v]);
    places_.update_feet();
    measure();
  }

  /// Puts vertices back where faces have got worse.
  /// \param moves  [V] of which the share `step` was made from `start`
  /// \return whether no face has got worse at the end
  bool retreat(const std::vector<VertexPlaces::State>& start, const std::vector<Vec3>& moves,
               double step) {
    std::vector<double> shares(start.size(), step);
    const auto none = [](Index) { return 0.0; };
    // So faces come near to others that they would cross.
    const auto less = [&](Index v) {
      return shares[v] = shares[v] > kLeastOfMove ? shares[v] / 2 : 0;
    };
    for (int i = 0; i < kMostRetreats; ++i) {
      if (move_less(guard_.spoilt(places_), start, moves, none)) continue;
      if (!move_less(guard_.newly_crossing(places_), start, moves, less)) return true;
    }
    return false;
  }

  /// Makes a smaller share of the moves of vertices that have moved.
  /// \param which  [V] 1: of these
  /// \param share  (Index vertex) -> share of its move, 0 where it is put back
  /// \return whether any had
  template <class Share>
  bool move_less(const std::vector<std::uint8_t>& which,
                 const std::vector<VertexPlaces::State>& start, const std::vector<Vec3>& moves,
                 const Share& share) {
    bool any = false;
    for (Index v = 0; v < size(); ++v) {
      if (which[v] == 0 || places_.positions()[v] == start[v].position) continue;
      places_.restore(v, start[v]);
      if (const double left = share(v); left > 0) places_.move(v, left * moves[v]);
      any = true;
    }
    return any;
  }

  /// [V] the moves that would be best if the surface were flat around each sample.
  [[nodiscard]] std::vector<Vec3> solve(const std::vector<double>& squares) {
    BlockSystem system(pattern_);  // made anew: searching for crossing faces takes as much memory
    deviation_.add_to(system);
    outline_.add_to(system);
    lines_.add_to(system, places_, field_, squares);
    const std::vector<double> area = vertex_areas();
    const std::vector<double> on_surface =
        for_cells(kHoldOnSurface * deviation_.mean() + kLeastHold * unseen_ * unseen_);
    std::vector<Mat3> freedom;
    for (Index v = 0; v < size(); ++v) {
      const Mat3 along = places_.normal(v) * places_.normal(v).transpose();
      const double hold = std::max(kHold * area[v], std::numeric_limits<double>::min());
      system.add(v, v, hold * along + on_surface[v] * (Mat3::Identity() - along));
      freedom.push_back(places_.freedom(v));
    }
    system.restrict_to(freedom);
    std::vector<Vec3> moves = system.solve();
    limit(moves);
    return moves;
  }

  /// Takes the part off a move towards a neighbour that is too long for one round, so that a vertex
  /// that is near another one does not stay behind otherwise.
  void shorten_towards_neighbours(std::vector<Vec3>& moves) const {
    const std::vector<Vec3>& p = places_.positions();
    for (const auto& [a, b, c] : triangles_) {
      for (const auto& [v, w] : {std::pair{a, b}, std::pair{b, c}, std::pair{c, a}}) {
        const Vec3 way = p[w] - p[v];
        const double square = way.squaredNorm();
        if (!(square > 0)) continue;
        moves[v] -= std::max(moves[v].dot(way) / square - kLongestMove, 0.0) * way;
        moves[w] -= std::min(moves[w].dot(way) / square + kLongestMove, 0.0) * way;
      }
    }
  }

  /// Shortens moves that are too long for one round, and leaves out those that are not worth it.
  void limit(std::vector<Vec3>& moves) const {
    const std::vector<Vec3>& p = places_.positions();
    shorten_towards_neighbours(moves);
    guard_.keep_apart(places_, moves);
    std::vector<double> shortest(p.size(), std::numeric_limits<double>::infinity());
    std::vector<double> nearing(p.size(), 0.0);  // share of the way to a neighbour
    for (const auto& [a, b, c] : triangles_) {
      for (const auto& [v, w] : {std::pair{a, b}, std::pair{b, c}, std::pair{c, a}}) {
        const Vec3 way = p[w] - p[v];
        const double square = way.squaredNorm();
        for (const Index end : {v, w}) shortest[end] = std::min(shortest[end], std::sqrt(square));
        if (!(square > 0)) continue;
        nearing[v] = std::max(nearing[v], moves[v].dot(way) / square);
        nearing[w] = std::max(nearing[w], -moves[w].dot(way) / square);
      }
    }
    for (Index v = 0; v < size(); ++v) {
      const Vec3& normal = places_.normal(v);
      const double up = moves[v].dot(normal);
      if (std::abs(up) < kShortestMove * shortest[v]) moves[v] -= up * normal;
      const double length = moves[v].norm();
      const double excess = std::max(nearing[v], std::abs(up) / shortest[v]) / kLongestMove;
      if (!(length >= kShortestMove * shortest[v]) || !std::isfinite(excess)) {
        moves[v].setZero();
      } else if (excess > 1) {
        moves[v] /= excess;
      }
    }
  }

  const QuadMesh& quads_;
  const PrincipalField* field_;
  double unseen_ = 0;  ///< length
  SurfaceDistance surface_;
  VertexPlaces places_;
  Deviation deviation_;
  Outline outline_;
  FlowLines lines_;
  FaceGuard guard_;
  BlockPattern pattern_;
  /// [V] see share_of_mean_cell: in this ratio to the squared distances of all, those of the
  /// component are to be expected.
  std::vector<double> cell_area_;
  std::vector<std::array<Index, 3>> triangles_;  ///< of the result, at the present places
};

}  // namespace

FitResult fit_vertices(const TriMesh& mesh, const PrincipalField* field, const QuadMesh& quads,
                       const FitOptions& options, Observer& observer) {
  FitResult result{quads, {}};
  if (options.rounds == 0 || quads.mesh.face_count() == 0) return result;
  observer.report("measuring distances", 0);
  Fit fit(mesh, field, quads);
  const double before = fit.error();
  std::int64_t rounds = 0;
  for (bool going = !fit.is_tangled(); going && rounds < options.rounds; ++rounds) {
    going = fit.improve();
    observer.report("moving vertices", double(rounds + 1) / static_cast<double>(options.rounds));
  }
  const Index evened = options.keep_flats || fit.is_tangled() ? 0 : fit.even_flats();
  const Index parted = fit.is_tangled() ? 0 : fit.part();
  fit.places().store(result.quads);
  double moved = 0;
  for (std::size_t v = 0; v < quads.mesh.positions.size(); ++v) {
    moved = std::max(moved, (result.quads.mesh.positions[v] - quads.mesh.positions[v]).norm());
  }
  Index divided = 0;
  Index refilled = 0;
  if (!has_only_quads(quads.mesh) && !fit.is_tangled() &&
      !mendable_crossings(result.quads.mesh, result.quads.mesh.positions).empty()) {
    divided = fitting::divide_crossing_faces(result.quads.mesh);
    refilled = fit.refill(mesh, result.quads);
    require_same_topology(quads.mesh, analyse(result.quads.mesh), "the fitted mesh");
  }
  begin_faces_at_fans(result.quads.mesh);
  result.quads.mesh.attributes = carry_attributes(mesh, result.quads.mesh, result.quads.provenance);
  result.report.set("fit.evened_vertices", std::int64_t{evened});
  result.report.set("fit.parted_vertices", std::int64_t{parted});
  result.report.set("fit.divided_faces", std::int64_t{divided});
  result.report.set("fit.refilled_faces", std::int64_t{refilled});
  result.report.set("fit.rounds", rounds);
  result.report.set("fit.rms_ratio", before > 0 ? std::sqrt(fit.error() / before) : 1.0);
  result.report.set("fit.longest_move", moved);
  return result;
}

}  // namespace strake
