#include "stages/evaluate/evaluate.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "common/core/error.h"
#include "common/core/place_text.h"
#include "common/core/tolerance_error.h"
#include "common/geometry/poly_topology/face_shape.h"
#include "common/geometry/poly_topology/poly_edges.h"
#include "common/geometry/poly_topology/poly_topology.h"
#include "common/geometry/topology/topology.h"
#include "stages/evaluate/alignment.h"
#include "stages/evaluate/deviation.h"
#include "stages/evaluate/kept_edges.h"
#include "stages/evaluate/measured_surface.h"
#include "stages/evaluate/own_crossings.h"
#include "stages/evaluate/shape.h"
#include "stages/evaluate/thickness.h"

namespace strake {
namespace {

/// Samples of distances for one of thickness.
constexpr std::int64_t kDistancesPerThickness = 10;

/// Of an oriented manifold, as every TriMesh is one.
PolyTopology topology_of(const TriMesh& mesh) {
  const Census counts = census(mesh);
  PolyTopology result;
  result.used_vertices = mesh.vertex_count();
  result.faces = mesh.face_count();
  result.edges = mesh.vertex_count() + mesh.face_count() - counts.euler_characteristic;
  result.components = counts.components;
  result.boundary_loops = counts.boundary_loops;
  result.euler = counts.euler_characteristic;
  result.genus = counts.genus;
  return result;
}

void require_finite(const PolyMesh& mesh) {
  for (std::size_t c = 0; c < mesh.corners.size(); ++c) {
    if (!mesh.positions[mesh.corners[c]].allFinite()) {
      throw PreconditionError("the candidate's vertex " + std::to_string(mesh.corners[c]) +
                              " has coordinates that are no finite numbers; repair the mesh first");
    }
  }
}

/// Times that one of two surfaces may be as large as the other one, and they may be apart. Beyond,
/// every face is equally near to every sample, and a place not known better than the smaller one's
/// size.
constexpr double kMostUnlike = 1000;

void require_comparable(const TriMesh& reference, const PolyMesh& candidate) {
  Eigen::AlignedBox3d box;
  for (const Index v : candidate.corners) box.extend(candidate.positions[v] - reference.origin);
  Eigen::AlignedBox3d around;
  for (const Vec3& p : reference.positions) around.extend(p);
  const double size = box.diagonal().norm();
  if (!(size > reference.diagonal / kMostUnlike && size < reference.diagonal * kMostUnlike)) {
    throw PreconditionError(
        fmt::format("the candidate is {:.3g} times as large as the reference, as in another unit; "
                    "give both in the same one",
                    size / reference.diagonal));
  }
  const double apart = box.exteriorDistance(around);
  if (apart <= kMostUnlike * std::min(size, reference.diagonal)) return;
  throw PreconditionError(
      fmt::format("the candidate lies {:.3g} diagonals away from the reference; give both in the "
                  "same place",
                  apart / reference.diagonal));
}

void require_within(const Length& tolerance, const evaluation::Farthest& farthest,
                    const TriMesh& reference) {
  const double wanted = tolerance.resolve(reference.diagonal);
  if (farthest.distance <= wanted) return;
  const Vec3 place = farthest.place + reference.origin;
  throw ToleranceError(
      fmt::format("measured afterwards, the result and the surface are {:.6g} apart at {}, more "
                  "than the {:.6g} allowed; a larger --evaluate-tolerance allows more, and "
                  "--tolerance makes a result that is within one",
                  farthest.distance, place_text(place, reference.diagonal), wanted),
      {farthest.place});
}

/// Distance from which on a detail is missing, in mean lengths of edges: of 170 results none with
/// more had all of its shape, and none with less looked wrong.
constexpr double kMissing = 0.35;

/// \param edge  mean length
void warn_of_missing_details(const evaluation::Farthest& farthest, double edge,
                             const TriMesh& reference, Report& report) {
  if (!(farthest.distance > kMissing * edge)) return;
  report.warn(fmt::format(
      "a place near {} is {:.3g} % of the diagonal off, {:.2g} times as far as an edge is long on "
      "average: a detail is missing there; more vertices show it, and a tolerance any",
      place_text(farthest.place + reference.origin, reference.diagonal),
      100 * farthest.distance / reference.diagonal, farthest.distance / edge));
}

void report_one_topology(const std::string& prefix, const PolyTopology& topology, Report& report) {
  report.set(prefix + "vertices", std::int64_t{topology.used_vertices});
  report.set(prefix + "unused_vertices", std::int64_t{topology.unused_vertices});
  report.set(prefix + "edges", std::int64_t{topology.edges});
  report.set(prefix + "faces", std::int64_t{topology.faces});
  report.set(prefix + "components", std::int64_t{topology.components});
  report.set(prefix + "boundary_loops", std::int64_t{topology.boundary_loops});
  report.set(prefix + "euler", topology.euler);
  if (topology.genus) report.set(prefix + "genus", *topology.genus);
  report.set(prefix + "oriented_manifold", topology.is_oriented_manifold());
}

void report_topology(const PolyTopology& reference, const PolyTopology& candidate, Report& report) {
  report_one_topology("topology.candidate.", candidate, report);
  report.set("topology.candidate.nonmanifold_edges",
             std::int64_t{candidate.nonmanifold_edges.count});
  report.set("topology.candidate.nonmanifold_vertices",
             std::int64_t{candidate.nonmanifold_vertices.count});
  report.set("topology.candidate.misoriented_edges",
             std::int64_t{candidate.misoriented_edges.count});
  report.set("topology.candidate.repeated_corner_faces",
             std::int64_t{candidate.repeated_corners.count});
  report_one_topology("topology.reference.", reference, report);
  const bool equal = candidate.is_oriented_manifold() == reference.is_oriented_manifold() &&
                     candidate.components == reference.components &&
                     candidate.boundary_loops == reference.boundary_loops &&
                     candidate.euler == reference.euler;
  report.set("topology.equal", equal);
  const std::string defects = candidate.defects();
  if (!defects.empty()) report.warn("the candidate has " + defects);
  if (!equal) report.warn("the candidate's topology is not the reference's");
}

}  // namespace

EvaluateResult evaluate_mesh(const TriMesh& reference, const PrincipalField* field,
                             const PolyMesh& candidate, const EvaluateOptions& options,
                             Observer& observer) {
  EvaluateResult result;
  Report& report = result.report;

  observer.report("topology", 0);
  const PolyEdges edges = collect_edges(candidate);
  const PolyTopology topology = analyse(candidate, edges);
  require_finite(candidate);
  require_comparable(reference, candidate);
  report_topology(topology_of(reference), topology, report);

  observer.report("shape", 0);
  PolyMesh local = candidate;
  for (Vec3& p : local.positions) p -= reference.origin;
  const FaceTriangles triangles = triangulate_faces(local);
  const auto crossing = evaluation::report_shape(local, topology, triangles, edges, report);
  evaluation::report_own_crossings(reference, local.positions, triangles, crossing, report);
  evaluation::report_valence(local, edges, report);

  const evaluation::MeasuredSurface reference_surface(reference.positions, reference.faces,
                                                      "the reference");
  const evaluation::MeasuredSurface candidate_surface(local.positions, triangles.corners,
                                                      "the candidate");
  const std::vector<Vec3> reference_vertices = reference_surface.vertices();
  const std::vector<Vec3> candidate_vertices = candidate_surface.vertices();
  const evaluation::Farthest farthest = evaluation::report_deviation(
      {reference_surface, reference_vertices}, {candidate_surface, candidate_vertices},
      reference.diagonal, options.samples, observer, report);
  report.set("distance.max_place",
             place_text(farthest.place + reference.origin, reference.diagonal));
  if (options.tolerance) {
    require_within(*options.tolerance, farthest, reference);
  } else {
    warn_of_missing_details(farthest, report.number("edges.length_mean").value_or(0), reference,
                            report);
  }

  observer.report("thickness", 0);
  evaluation::report_thickness(
      {.reference = reference_surface,
       .candidate = candidate_surface,
       .origin = reference.origin,
       .diagonal = reference.diagonal,
       .cell = std::sqrt(reference_surface.area() / local.face_count()),
       .samples = std::max<std::int64_t>(options.samples / kDistancesPerThickness, 1)},
      report);

  observer.report("features and alignment", 0);
  evaluation::report_kept_edges(reference, local, edges, report);
  if (field != nullptr) {
    evaluation::report_alignment(reference, reference_surface, *field, local, edges, report);
  }
  observer.report("features and alignment", 1);
  return result;
}

}  // namespace strake
