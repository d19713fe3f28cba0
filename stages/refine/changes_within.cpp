#include "stages/refine/changes_within.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "common/geometry/carry_attributes.h"
#include "common/geometry/cell_error/cell_error.h"
#include "common/geometry/cell_error/tolerance_check.h"
#include "common/geometry/face_crossings/face_crossings.h"
#include "common/geometry/patch_fill/redivide_faces.h"
#include "common/geometry/patch_fill/refill_crossing.h"
#include "common/geometry/poly_topology/face_shape.h"
#include "common/geometry/poly_topology/poly_edges.h"
#include "common/geometry/poly_topology/poly_topology.h"
#include "common/geometry/poly_topology/same_topology.h"
#include "stages/refine/double_edge.h"

namespace strake {
namespace {

/// Times that faces are made anew: where that is beyond the tolerance they stay the next time.
constexpr int kMostRefills = 4;
/// Times that a result with odd faces paired is proven.
constexpr int kMostPairings = 80;
/// Distance that is usual, in root mean squares.
constexpr double kUsual = 2;
/// Distance, of the diagonal, that rounding alone may make.
constexpr double kRounding = 1e-9;

/// Changes of a result that are tried at once.
struct Trial {
  const QuadMesh& before;
  const QuadMesh& changed;
  std::span<const Redivision> changes;
  const std::vector<Index>& change_of_face;  ///< [F of the changed one] kNone: of none
};

/// Marks the changes that bring faces to cross others. \return whether any do
bool mark_crossing(const Trial& trial, std::vector<char>& harmful) {
  std::vector<std::uint8_t> is_new(trial.change_of_face.size(), 0);
  for (std::size_t f = 0; f < is_new.size(); ++f) {
    is_new[f] = trial.change_of_face[f] != kNone ? 1 : 0;
  }
  const PolyMesh& mesh = trial.changed.mesh;
  const auto crossing = find_crossing_faces(mesh.positions, triangulate_faces(mesh), is_new, {});
  for (const auto& pair : crossing) {
    for (const Index f : pair) {
      if (trial.change_of_face[f] != kNone) harmful[trial.change_of_face[f]] = 1;
    }
  }
  return !crossing.empty();
}

/// The changes that bring faces farther off than those were that they take the place of, and than
/// is usual, or to cross others.
/// \param rounding  distance that it may make, model units
/// \return [changes] 1: one of them
std::vector<char> changes_farther_off(const ErrorMap& before, const ErrorMap& after,
                                      double rounding, const Trial& trial) {
  std::vector<char> harmful(trial.changes.size(), 0);
  mark_crossing(trial, harmful);
  std::vector<double> allowed(trial.changes.size(), std::max(kUsual * before.rms, rounding));
  for (std::size_t c = 0; c < allowed.size(); ++c) {
    for (const Index f : trial.changes[c].removed) {
      allowed[c] = std::max(allowed[c], before.cells[f].largest);
    }
  }
  for (std::size_t f = 0; f < after.cells.size(); ++f) {
    const Index change = trial.change_of_face[f];
    if (change != kNone && after.cells[f].largest > allowed[change]) harmful[change] = 1;
  }
  return harmful;
}

/// The changes that bring faces beyond the tolerance, or to cross others.
/// \return [changes] 1: one of them; all where it is none of them alone
std::vector<char> harmful_changes(ToleranceProof& proof, const Trial& trial) {
  const auto& [before, changed, changes, change_of_face] = trial;
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
  const bool crosses = mark_crossing(trial, harmful);
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const auto& outline = changes[i].outline;
    if (std::ranges::any_of(outline, [&](Index v) { return is_near[v] != 0; })) harmful[i] = 1;
  }
  const bool is_sound = excess.empty() && !crosses;
  if (!is_sound && std::ranges::find(harmful, 1) == harmful.end()) std::ranges::fill(harmful, 1);
  return harmful;
}

/// Makes quads of odd faces near each other.
/// \param may_change  as of pair_odd_cells_within
/// \param harm_of     (Trial) -> [changes] 1: not this one
template <class HarmOf>
void pair_odd_cells(const SurfacePoints& points, const std::vector<char>& may_change,
                    const HarmOf& harm_of, QuadMesh& quads) {
  const auto may_remove = [&](Index a, Index b) {
    if (!may_change.empty() && (may_change[a] == 0 || may_change[b] == 0)) return false;
    return !points.has_line_along(foot_of(quads.provenance, a), foot_of(quads.provenance, b));
  };
  std::set<std::vector<Index>> refused;
  std::vector<Redivision> changes = find_redivisions(quads.mesh, may_remove, refused);
  for (int i = 0; i < kMostPairings && !changes.empty(); ++i) {
    QuadMesh changed = quads;
    std::vector<Index> change_of_face;
    changed.mesh = redivide_faces(quads.mesh, changes, change_of_face);
    const std::vector<char> harmful = harm_of(Trial{quads, changed, changes, change_of_face});
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

}  // namespace

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

void pair_odd_cells_within(ToleranceProof& proof, const SurfacePoints& points,
                           const std::vector<char>& may_change, QuadMesh& quads) {
  pair_odd_cells(
      points, may_change, [&](const Trial& trial) { return harmful_changes(proof, trial); }, quads);
}

void pair_odd_cells_as_near(const std::shared_ptr<const InputSurface>& input,
                            const SurfacePoints& points, QuadMesh& quads) {
  CellMeasure measure(kCompared);
  std::optional<ErrorMap> errors;  // before changes; not measured where there are none
  const auto harm_of = [&](const Trial& trial) {
    if (!errors) errors = measure.measure(ComparedSurfaces(input, trial.before));
    ErrorMap after = measure.measure(ComparedSurfaces(input, trial.changed));
    const std::vector<char> harmful =
        changes_farther_off(*errors, after, kRounding * input->mesh.diagonal, trial);
    if (std::ranges::find(harmful, 1) == harmful.end()) errors = std::move(after);
    return harmful;
  };
  pair_odd_cells(points, {}, harm_of, quads);
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

void end_changes(const TriMesh& mesh, const PolyMesh& before, const std::string& what,
                 QuadMesh& quads) {
  require_same_topology(before, analyse(quads.mesh), what);
  begin_faces_at_fans(quads.mesh);
  quads.mesh.attributes = carry_attributes(mesh, quads.mesh, quads.provenance);
}

}  // namespace strake
