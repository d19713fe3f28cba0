#include "stages/import/import.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/geometry/topology/closed_components.h"
#include "common/geometry/topology/topology.h"
#include "stages/import/assemble.h"
#include "stages/import/carry.h"
#include "stages/import/divide_long_edges.h"
#include "stages/import/features.h"
#include "stages/import/listed_edges.h"
#include "stages/import/noise.h"
#include "stages/import/openings.h"
#include "stages/import/repair.h"
#include "stages/import/turn_outwards.h"
#include "stages/import/voxel_steps.h"

namespace strake {
namespace {

using import::FeatureCounts;
using import::FeatureRules;

void report_census(const TriMesh& mesh, const Census& counts, Report& report) {
  report.set("census.vertices", mesh.vertex_count());
  report.set("census.faces", mesh.face_count());
  report.set("census.components", counts.components);
  report.set("census.boundary_loops", counts.boundary_loops);
  report.set("census.euler_characteristic", counts.euler_characteristic);
  report.set("census.genus", counts.genus);
  report.set("census.diagonal", mesh.diagonal);
}

void report_features(const FeatureCounts& counts, Report& report) {
  report.set("features.strong_edges", counts.strong_edges);
  report.set("features.shallow_edges", counts.shallow_edges);
  report.set("features.bridging_edges", counts.bridging_edges);
  report.set("features.dropped_edges", counts.dropped_edges);
  report.set("features.ridge_edges", counts.ridge_edges);
  report.set("features.facet_edges", counts.facet_edges);
  report.set("features.label_edges", counts.label_edges);
  report.set("features.open_label_edges", counts.open_label_edges);
  report.set("features.seam_edges", counts.seam_edges);
  report.set("features.open_seam_edges", counts.open_seam_edges);
  report.set("features.listed_edges", counts.listed_edges);
  report.set("features.edges", counts.edges);
  report.set("features.corners", counts.corners);
  report.set("features.sharp_points", counts.sharp_points);
}

void report_noise(const TriMesh& mesh, Report& report) {
  const import::Noise noise = import::measure_noise(mesh);
  report.set("noise.median_bend_deg", noise.median_bend_deg);
  report.set("noise.to_and_fro", noise.to_and_fro);
  if (!noise.is_much()) return;
  report.warn(
      fmt::format("the surface is rough: half of its edges are bent by more than {:.0f} degrees, "
                  "to and fro, so directions of curvature mean little; --denoise 10 takes "
                  "noise of a scan off",
                  noise.median_bend_deg));
}

void warn_of_steps(const TriMesh& mesh, const FeatureCounts& counts, Report& report) {
  constexpr double kFew = 0.01;  // share of the edges: not worth a look
  if (counts.strong_edges < kFew * 1.5 * mesh.face_count() || !import::has_voxel_steps(mesh)) {
    return;
  }
  report.warn(
      "all vertices lie on a grid, as those of a segmented volume do, and its steps are kept as "
      "features; --denoise 20 takes them off");
}

FeatureRules feature_rules(const ImportOptions& options, double diagonal) {
  const auto wants = [&](const char* kind) {
    return options.attribute_features == "all" || options.attribute_features == kind;
  };
  const auto height = [&](const std::optional<Length>& length) {
    return length ? length->resolve(diagonal) : std::numeric_limits<double>::infinity();
  };
  return {.angle_deg = options.feature_angle_deg,
          .all_creases = options.all_creases,
          .height = height(options.feature_height),
          .facet_height = height(options.facet_height),
          .labels = wants("labels"),
          .seams = wants("seams")};
}

/// Listed edges are held, and creases where noise leaves them to be seen; those of a grid are none.
void take_noise_off(TriMesh& mesh, const ImportOptions& options, const import::ListedEdges* listed,
                    Report& report) {
  /// Share of the diagonal that noise is hardly larger than on a surface that is not rough.
  constexpr double kFar = 0.01;
  const bool is_rough = import::measure_noise(mesh).is_much() || import::has_voxel_steps(mesh);
  FeatureRules rules =
      is_rough ? FeatureRules{.angle_deg = 180} : feature_rules(options, mesh.diagonal);
  rules.labels = rules.seams = false;
  import::find_features(mesh, rules, listed);
  const import::Moves moves = import::take_noise_off(mesh, options.denoise);
  report.set("noise.moved_rms_share", moves.rms / mesh.diagonal);
  report.set("noise.moved_largest_share", moves.largest / mesh.diagonal);
  if (is_rough || moves.largest <= kFar * mesh.diagonal) return;
  report.warn(fmt::format(
      "--denoise moved a surface that is not rough by up to {:.2f} % of the diagonal ({:.2f} % "
      "RMS), and distances are those to what it became; leave it out, or use fewer rounds",
      100 * moves.largest / mesh.diagonal, 100 * moves.rms / mesh.diagonal));
}

void divide_long_edges(TriMesh& mesh, const ImportOptions& options, Report& report) {
  /// What it may cost, in vertices.
  constexpr Index kMostVertices = 8000;
  const double longest = options.longest_edge.resolve(mesh.diagonal);
  report.set("division.inserted_vertices",
             import::divide_long_edges(mesh, longest, mesh.vertex_count() + kMostVertices));
}

/// Faces all around may be turned over on purpose, as those of a mould are.
void report_orientation(const TriMesh& mesh, const Census& counts, Report& report) {
  const ClosedComponents closed = judge_closed_components(mesh);
  report.set("census.closed_components", closed.count);
  report.set("census.inside_out_components", closed.inside_out);
  report.set("census.cavities", closed.cavities);
  if (closed.inside_out == 0) return;
  const std::string what = counts.components == 1
                               ? "the surface is inside out: its faces look"
                               : fmt::format("{} of {} components are inside out: their faces look",
                                             closed.inside_out, counts.components);
  report.warn(what + " inwards, and those of the result will; --outwards turns them over");
}

/// Edges of walls that stand among measured points are as jagged as noise is.
void warn_of_dropped_creases(double diagonal, const FeatureCounts& counts, Report& report) {
  constexpr double kMostLength = 30;  ///< in diagonals; folds and tufts of a scan have less
  constexpr double kMost = 0.8;
  if (counts.dropped_share < kMost || counts.dropped_length < kMostLength * diagonal) return;
  report.warn(fmt::format(
      "{:.0f} % of the creases look like noise, {} edges that are jagged or short on rough ground, "
      "and are no features; if they are meant, --all-creases keeps them",
      100 * counts.dropped_share, counts.dropped_edges));
}

/// Seams of an atlas of many small charts would leave no room for anything but features.
void warn_of_many_seams(const TriMesh& mesh, const FeatureCounts& counts, Report& report) {
  constexpr double kMany = 0.05;
  const double share = double(counts.seam_edges) / (1.5 * mesh.face_count());
  if (share <= kMany) return;
  report.warn(
      fmt::format("{:.0f} % of the edges are seams of texture coordinates and are kept as "
                  "features; --attribute-features none leaves them out",
                  100 * share));
}

/// A border that no line follows comes out along the cells, as a staircase.
void warn_of_open_labels(const FeatureCounts& counts, Report& report) {
  if (counts.open_label_edges == 0) return;
  report.warn(
      fmt::format("{} edges between faces of different labels (groups, materials) are no features, "
                  "so these borders will be as ragged as cells are large; --attribute-features all "
                  "keeps them as lines",
                  counts.open_label_edges));
}

/// A cell across a seam takes its corners' coordinates from both charts.
void warn_of_open_seams(const FeatureCounts& counts, Report& report) {
  if (counts.open_seam_edges == 0) return;
  report.warn(fmt::format(
      "{} edges are seams of texture coordinates and no features, so the texture will be wrong in "
      "the faces across them; --attribute-features seams keeps them as lines",
      counts.open_seam_edges));
}

void report_attributes(const Attributes& attributes, Report& report) {
  report.set("attributes.colours", !attributes.colour.empty());
  report.set("attributes.texture_coordinates", !attributes.texture.empty());
  std::string kinds;
  for (const FaceLabels& labels : attributes.labels)
    kinds += (kinds.empty() ? "" : ", ") + labels.name;
  report.set("attributes.labels", kinds);
}

/// Finds features by the options' rules, and those listed.
FeatureCounts mark_features(TriMesh& mesh, const ImportOptions& options,
                            const import::ListedEdges* listed, Report& report) {
  const FeatureCounts features =
      import::find_features(mesh, feature_rules(options, mesh.diagonal), listed);
  if (options.no_attributes) mesh.attributes = {};
  warn_of_dropped_creases(mesh.diagonal, features, report);
  warn_of_many_seams(mesh, features, report);
  if (!options.no_attributes) {
    warn_of_open_labels(features, report);
    warn_of_open_seams(features, report);
  }
  report_noise(mesh, report);
  warn_of_steps(mesh, features, report);
  return features;
}

}  // namespace

ImportResult import_mesh(const PolyMesh& soup, const ImportOptions& options, Observer& observer,
                         const EdgeList* listed) {
  ImportResult result;
  const import::Repaired given = import::repair(soup, options, observer);
  std::optional<import::ListedEdges> edges;
  if (listed != nullptr) edges.emplace(*listed, soup, given.triangles);
  const import::ListedEdges* listed_edges = edges ? &*edges : nullptr;
  observer.report("ordering", 0.5);
  result.mesh = import::assemble(given.triangles);
  if (options.outwards)
    result.report.set("repairs.turned_components", import::turn_outwards(result.mesh));
  const import::Openness repaired = import::openness(result.mesh);
  import::carry_attributes(soup, result.mesh);
  result.mesh.origin = given.frame.origin;
  result.mesh.diagonal = given.frame.diagonal;
  if (options.denoise > 0) {
    observer.report("taking noise off", 0.6);
    take_noise_off(result.mesh, options, listed_edges, result.report);
  }
  observer.report("finding features", 0.7);
  const FeatureCounts features = mark_features(result.mesh, options, listed_edges, result.report);
  divide_long_edges(result.mesh, options, result.report);
  build_wedges(result.mesh);
  observer.report("checking", 0.8);
  validate(result.mesh);
  result.mesh.id = content_id(result.mesh);

  result.report.set("input.vertices", soup.vertex_count());
  result.report.set("input.faces", soup.face_count());
  const Census counts = census(result.mesh);
  report_census(result.mesh, counts, result.report);
  report_orientation(result.mesh, counts, result.report);
  import::report_repairs(given, repaired, counts.boundary_loops, result.report);
  report_features(features, result.report);
  report_attributes(result.mesh.attributes, result.report);
  observer.report("done", 1);
  return result;
}

}  // namespace strake
