#include "stages/refine/refine.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/core/error.h"
#include "common/core/place_text.h"
#include "common/core/tolerance_error.h"
#include "common/geometry/carry_attributes.h"
#include "common/geometry/cell_error/cell_error.h"
#include "common/geometry/cell_error/tolerance_check.h"
#include "common/geometry/nearest_on_surface.h"
#include "common/geometry/poly_topology/face_shape.h"
#include "common/geometry/poly_topology/poly_edges.h"
#include "common/geometry/poly_topology/poly_topology.h"
#include "common/geometry/poly_topology/same_topology.h"
#include "stages/refine/cells_beyond.h"
#include "stages/refine/changes_within.h"
#include "stages/refine/division_faults.h"
#include "stages/refine/edges_across_bend.h"
#include "stages/refine/flat_faces.h"
#include "stages/refine/inlays.h"
#include "stages/refine/split_cells.h"
#include "stages/refine/surface_points.h"
#include "stages/refine/turned_ears.h"

namespace strake {
namespace {

/// Of the tolerance, kept for the rounding of whoever measures again.
constexpr double kMargin = 1e-3;
constexpr const char* kFinishing = "finishing cells";
constexpr std::int64_t kMostSides = 5;
constexpr std::size_t kNamedPlaces = 5;
/// Where edges are measured.
constexpr std::array<double, 3> kPlacesOnEdge = {0.25, 0.5, 0.75};
/// Rounds in which the cell nearest to a place of the input is divided. What is left after that is
/// mostly nearest to a cell that does not lie over it.
constexpr std::int64_t kRoundsInSpace = 3;
/// Rounds after which vertices are moved to the places that are left, where dividing did not help.
constexpr std::int64_t kRoundsOfDividing = 6;
/// Rounds that may leave more places than one before. What is reached at all is reached with fewer
/// from round to round.
constexpr std::int64_t kRoundsInVain = 4;
/// Rounds in which the worst cells are divided up to a count.
constexpr std::int64_t kRoundsOfCount = 4;
/// Times that cells are left out because of what dividing them would do.
constexpr int kMostRetreats = 8;
/// Share of the faces that cross once the tolerance is reached, from which on cells are divided
/// anew without that: sheets are nearer to each other than cells are off there.
constexpr double kTangledShare = 0.1;
/// An edge below this share of the mean one of its cell is not divided for the others' sake: half
/// of it would be next to nothing, and half of that after another round.
constexpr double kShortSide = 0.05;
/// Vertices that dividing a cell gives, about.
constexpr double kVerticesPerCell = 1.5;

class Refinement {
 public:
  Refinement(const TriMesh& mesh, QuadMesh quads, std::int64_t most_sides)
      : mesh_(mesh),
        quads_(std::move(quads)),
        points_(mesh),
        crossing_(mesh, Tangles::kFaults),
        max_sides_(static_cast<std::size_t>(most_sides)) {
    for (Index f = 0; f < quads_.mesh.face_count(); ++f) {
      max_sides_ = std::max(max_sides_, quads_.mesh.face(f).size());
    }
  }

  [[nodiscard]] const QuadMesh& quads() const { return quads_; }
  CrossingPlaces& crossing() { return crossing_; }
  /// Goes on from another result.
  void take(QuadMesh quads) { quads_ = std::move(quads); }

  /// Puts vertices that are farther than this off the surface back onto it.
  void put_back(const SurfaceDistance& input, double tolerance) {
    for (Index v = 0; v < quads_.mesh.vertex_count(); ++v) {
      Vec3& p = quads_.mesh.positions[v];
      if (input.closest_within(p - mesh_.origin, tolerance).triangle != kNone) continue;
      p = mesh_.origin + place_of(mesh_, foot_of(v));
    }
  }

  void drop_turned_ears() {
    quads_.mesh.attributes = {};  // carried over anew at the end
    strake::drop_turned_ears(points_, quads_);
  }

  /// Moves the vertex nearest on the surface to each of these places of the input there, so that
  /// they are reached for certain. Vertices on feature and boundary lines stay.
  void reach(const std::vector<Excess>& excess) {
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

  /// Changes what may be better in a result that is within the tolerance.
  void finish(ToleranceProof& proof) {
    refill_within(proof, quads_);
    mend_flat_faces_within(proof, quads_);  // what has no area crosses nothing, and hides what does
    inlay_crossing(proof, crossing_, proof.tolerance(), quads_);
    mend_flat_faces_within(proof, quads_);
    pair_odd_cells_within(proof, points_, {}, quads_);
    cut_cells_in_doubt(proof, quads_);
  }

  /// Divides cells. \param tolerance  that edges are to keep
  void divide(const ComparedSurfaces& surfaces, const std::vector<Target>& targets,
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

 private:
  [[nodiscard]] SurfacePoint foot_of(Index v) const {
    return strake::foot_of(quads_.provenance, v);
  }

  Index add(const SurfacePoint& point) {
    positions_.push_back(place_of(mesh_, point));
    normals_.push_back(Vec3::Zero());
    add_foot(quads_.provenance, point);
    return static_cast<Index>(positions_.size()) - 1;
  }

  void find_boundary() {
    boundary_ = {};
    const PolyEdges edges = collect_edges(quads_.mesh);
    for (Index e = 0; e < edges.edge_count(); ++e) {
      if (edges.sides_of(e).size() > 1) continue;
      boundary_.set(edges.vertices[e][0], edges.vertices[e][1], e);
    }
  }
  [[nodiscard]] bool is_boundary(Index a, Index b) const { return boundary_.at(a, b) != kNone; }

  /// Puts all corners of a jagged boundary on the edges of a cell that stand for it. One after the
  /// other they would come to lie across what divides the cell by then.
  /// \return whether there are any
  bool add_jags(Index cell, double tolerance, EdgeMarks& marks) {
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

  /// \param a, b  in the sense of a face
  Index add_on_edge(Index a, Index b) {
    if (is_boundary(a, b)) {
      if (const auto point = points_.between_on_boundary(foot_of(a), foot_of(b)))
        return add(*point);
    }
    return add_between(a, b, normals_[a] + normals_[b]);
  }

  Index add_between(Index a, Index b, const Vec3& normal) {
    const Vec3 middle = 0.5 * (positions_[a] + positions_[b]);
    return add(points_.between(foot_of(a), foot_of(b), middle, normal));
  }

  /// Whether an edge is farther from the surface than the tolerance, or on the boundary from what
  /// it stands for: the surface may reach beyond it there.
  [[nodiscard]] bool is_beyond(const SurfaceDistance& input, Index a, Index b,
                               double tolerance) const {
    if (is_boundary(a, b) && points_.boundary_height(foot_of(a), foot_of(b)) > tolerance) {
      return true;
    }
    return std::ranges::any_of(kPlacesOnEdge, [&](double share) {
      const Vec3 p = positions_[a] + share * (positions_[b] - positions_[a]);
      return input.closest_within(p, tolerance).triangle == kNone;
    });
  }

  /// Whether an edge of a face is short against the others.
  [[nodiscard]] bool is_short(std::span<const Index> face, std::size_t edge) const {
    const auto length = [&](std::size_t i) {
      return (positions_[face[(i + 1) % face.size()]] - positions_[face[i]]).norm();
    };
    double around = 0;
    for (std::size_t i = 0; i < face.size(); ++i) around += length(i);
    return length(edge) * static_cast<double>(face.size()) < kShortSide * around;
  }

  /// Which edges of a cell get a vertex: those that are beyond the tolerance, of a quad with the
  /// ones opposite unless they are short; where none is, those across the direction that the cell
  /// is bent in.
  [[nodiscard]] std::vector<std::size_t> edges_to_divide(const ComparedSurfaces& surfaces,
                                                         const Target& target,
                                                         double tolerance) const {
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

  const TriMesh& mesh_;
  QuadMesh quads_;
  SurfacePoints points_;
  CrossingPlaces crossing_;
  std::size_t max_sides_;
  EdgeMarks boundary_;           ///< edges of one face
  std::vector<Vec3> positions_;  ///< [V] relative to the mesh's origin
  std::vector<Vec3> normals_;    ///< [V] sums over the faces around
};

/// The worst places, for a message. \param tolerance  model units
std::string describe(std::vector<Excess> excess, const TriMesh& mesh, double tolerance) {
  std::stable_sort(excess.begin(), excess.end(),
                   [](const Excess& a, const Excess& b) { return a.distance > b.distance; });
  std::string text;
  std::vector<Vec3> named;
  for (const Excess& e : excess) {
    const auto is_near = [&](const Vec3& p) { return (p - e.place).norm() < tolerance; };
    if (std::any_of(named.begin(), named.end(), is_near)) continue;
    const Vec3 p = e.place + mesh.origin;
    text += fmt::format("{}{:.3g} at {}", named.empty() ? "" : ", ", e.distance,
                        place_text(p, mesh.diagonal));
    named.push_back(e.place);
    if (named.size() == kNamedPlaces) break;
  }
  return text;
}

/// Divides the first cells, leaving out those around which faces come to cross that did not before,
/// or to be concave. \return whether any is left to be divided
bool divide_without_faults(Refinement& refinement, const ComparedSurfaces& surfaces,
                           std::vector<Target> targets, std::size_t wanted, double tolerance) {
  const QuadMesh before = refinement.quads();
  const std::vector<std::uint8_t> known = vertices_of_faults(before.mesh, {});
  for (int i = 0; i < kMostRetreats && !targets.empty(); ++i) {
    const auto last =
        targets.begin() + static_cast<std::ptrdiff_t>(std::min(wanted, targets.size()));
    refinement.divide(surfaces, {targets.begin(), last}, tolerance);
    const std::vector<std::uint8_t> faulty = vertices_of_faults(refinement.quads().mesh, known);
    if (std::ranges::find(faulty, 1) == faulty.end()) return true;
    refinement.take(before);
    const auto is_to_blame = [&](const Target& t) {
      return has_any(before.mesh.face(t.face), faulty);
    };
    targets.erase(std::remove_if(targets.begin(), last, is_to_blame), last);
  }
  return false;
}

/// Adds to cells, ascending, those that faces would come to cross if only these were divided: a
/// sheet beside, whose cells are off by more than it is away.
void add_crossed(Refinement& refinement, const ComparedSurfaces& surfaces, double tolerance,
                 std::vector<Target>& targets) {
  if (targets.empty()) return;
  const QuadMesh before = refinement.quads();
  const std::vector<std::uint8_t> known = vertices_of_faults(before.mesh, {});
  refinement.divide(surfaces, targets, tolerance);
  const std::vector<std::uint8_t> faulty = vertices_of_faults(refinement.quads().mesh, known);
  refinement.take(before);
  std::vector<char> is_target(static_cast<std::size_t>(before.mesh.face_count()), 0);
  for (const Target& target : targets) is_target[target.face] = 1;
  for (Index f = 0; f < before.mesh.face_count(); ++f) {
    if (is_target[f] != 0 || !has_any(before.mesh.face(f), faulty)) continue;
    targets.push_back({f, tolerance});
  }
  std::ranges::sort(targets, {}, &Target::face);
}

/// How far dividing cells comes.
struct Divided {
  std::int64_t rounds = 0;
  std::vector<Excess> left;  ///< places beyond the tolerance; none: it is reached
};

/// Divides cells until all are within the tolerance. Where that ends in vain the result is the one
/// with the fewest places beyond, or the last one where it may miss it.
/// \param without_faults  cells stay as they are where dividing them would make faces cross
Divided divide_until_within(ToleranceProof& proof, Refinement& refinement,
                            const RefineOptions& options, bool without_faults, Observer& observer) {
  const TriMesh& mesh = proof.input()->mesh;
  std::size_t last = std::numeric_limits<std::size_t>::max();  // places before the last division
  std::vector<Excess> fewest;  // where dividing came nearest, of all rounds
  std::int64_t fewest_round = 0;
  QuadMesh best;  // the result then
  bool is_stuck = false;
  for (std::int64_t round = 0;; ++round) {
    observer.report("dividing cells", double(round) / double(options.rounds + 1));
    refinement.drop_turned_ears();
    const ComparedSurfaces surfaces(proof.input(), refinement.quads());
    std::vector<Excess> excess = proof.check(surfaces);
    if (excess.empty()) return {round, {}};
    if (round == 0 || excess.size() < fewest.size()) {
      fewest = excess;
      fewest_round = round;
      if (!options.partly) best = refinement.quads();
    }
    if (is_stuck || round == options.rounds || round - fewest_round == kRoundsInVain) {
      if (!options.partly) refinement.take(std::move(best));
      return {round, options.partly ? std::move(excess) : std::move(fewest)};
    }
    std::vector<Target> targets =
        large_enough(surfaces, refinement.quads().mesh, excess, proof.tolerance(),
                     cells_beyond(mesh, refinement.quads(), excess, round >= kRoundsInSpace));
    if (without_faults) {
      add_crossed(refinement, surfaces, proof.tolerance(), targets);
      is_stuck =
          !divide_without_faults(refinement, surfaces, targets, targets.size(), proof.tolerance());
    } else if (targets.empty() || (round >= kRoundsOfDividing && excess.size() >= last)) {
      refinement.reach(excess);
      last = std::numeric_limits<std::size_t>::max();
    } else {
      last = excess.size();
      refinement.divide(surfaces, targets, proof.tolerance());
    }
  }
}

/// Brings what dividing has left within the tolerance. \return whether it could be
bool inlay_left(ToleranceProof& proof, Refinement& refinement, const std::vector<Excess>& left,
                Observer& observer) {
  proof.report_to(observer, kFinishing);
  if (left.empty()) return true;
  QuadMesh inlaid = refinement.quads();
  if (!inlay_beyond(proof, left, refinement.crossing(), inlaid)) return false;
  refinement.take(std::move(inlaid));
  return true;
}

/// Where dividing made many faces cross, which is what inlays would replace, divides anew what it
/// can without that, and inlays what is left.
/// \param start  before anything was divided
/// \return the rounds it took; nothing, and the result as it was, where it is no better
std::optional<std::int64_t> divide_untangled(ToleranceProof& proof, Refinement& refinement,
                                             const QuadMesh& start, const RefineOptions& options,
                                             Observer& observer) {
  const auto crossing = [&](const QuadMesh& quads) {
    return refinement.crossing().meeting(quads.mesh).crossing.size();
  };
  const QuadMesh tangled = refinement.quads();
  const std::size_t faults = crossing(tangled);
  if (static_cast<double>(faults) < kTangledShare * tangled.mesh.face_count()) return std::nullopt;
  if (2 * crossing(start) > faults) return std::nullopt;
  refinement.take(start);
  const Divided divided = divide_until_within(proof, refinement, options, true, observer);
  if (inlay_left(proof, refinement, divided.left, observer) &&
      crossing(refinement.quads()) < faults) {
    return divided.rounds;
  }
  refinement.take(tangled);
  return std::nullopt;
}

/// Divides cells until all are within the tolerance, and inlays what is left.
/// \return the rounds it took
std::int64_t refine_to_tolerance(const TriMesh& mesh, Refinement& refinement,
                                 const RefineOptions& options, Observer& observer, Report& report) {
  const double wanted = options.tolerance->resolve(mesh.diagonal);
  ToleranceProof proof(std::make_shared<const InputSurface>(mesh), (1 - kMargin) * wanted);
  refinement.put_back(proof.input()->distance, proof.tolerance());
  const QuadMesh start = refinement.quads();
  Divided divided = divide_until_within(proof, refinement, options, false, observer);
  report.set("refine.places_beyond", divided.left.size());
  if (options.partly && !divided.left.empty()) return divided.rounds;
  const bool may_inlay = !options.partly && options.rounds > 0;
  std::optional<std::int64_t> rounds;
  if (may_inlay) rounds = divide_untangled(proof, refinement, start, options, observer);
  const bool may_do = may_inlay || divided.left.empty();
  if (!rounds && may_do && inlay_left(proof, refinement, divided.left, observer)) {
    rounds = divided.rounds;
  }
  if (rounds) {
    report.set("refine.places_beyond", std::size_t{0});
    refinement.finish(proof);
    return *rounds;
  }
  std::vector<Vec3> places;
  for (const Excess& e : divided.left) places.push_back(e.place);
  throw ToleranceError(
      fmt::format("the result is farther than {:.6g} from the surface, after {} rounds of "
                  "dividing cells: {}; use a larger tolerance, closer lines or more "
                  "--refine-rounds",
                  wanted, divided.rounds,
                  describe(std::move(divided.left), mesh, proof.tolerance())),
      std::move(places));
}

/// Divides the worst cells until there are enough vertices. \return the rounds it took
std::int64_t refine_to_count(const TriMesh& mesh, Refinement& refinement,
                             const RefineOptions& options, Observer& observer) {
  const auto input = std::make_shared<const InputSurface>(mesh);
  std::int64_t round = 0;
  for (; round < std::min(options.rounds, kRoundsOfCount); ++round) {
    observer.report("dividing cells", double(round) / double(kRoundsOfCount));
    const std::int64_t missing = *options.vertices - refinement.quads().mesh.vertex_count();
    const auto cells = static_cast<double>(missing) / kVerticesPerCell;
    if (cells < 1) break;
    const ComparedSurfaces surfaces(input, refinement.quads());
    divide_without_faults(refinement, surfaces, cells_by_distance(surfaces),
                          static_cast<std::size_t>(cells), std::numeric_limits<double>::infinity());
  }
  return round;
}

}  // namespace

RefineResult refine_cells(const TriMesh& mesh, const QuadMesh& quads, const RefineOptions& options,
                          Observer& observer) {
  if (options.tolerance && options.vertices) {
    throw UsageError("give only one of --refine-tolerance and --refine-vertices");
  }
  Refinement refinement(mesh, quads, options.sides.value_or(kMostSides));
  RefineResult result;
  std::int64_t rounds = 0;
  if (options.tolerance) {
    rounds = refine_to_tolerance(mesh, refinement, options, observer, result.report);
  } else if (options.vertices) {
    rounds = refine_to_count(mesh, refinement, options, observer);
  }
  result.quads = refinement.quads();
  require_same_topology(quads.mesh, analyse(result.quads.mesh), "the mesh of divided cells");
  begin_faces_at_fans(result.quads.mesh);
  result.quads.mesh.attributes = carry_attributes(mesh, result.quads.mesh, result.quads.provenance);
  result.report.set("refine.rounds", rounds);
  result.report.set(
      "refine.added_vertices",
      static_cast<std::int64_t>(result.quads.mesh.vertex_count() - quads.mesh.vertex_count()));
  return result;
}

}  // namespace strake
