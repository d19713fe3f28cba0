#include "stages/import/import.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/core/error.h"
#include "common/geometry/topology/closed_components.h"
#include "common/geometry/topology/topology.h"
#include "stages/import/assemble.h"
#include "stages/import/carry.h"
#include "stages/import/copied_pieces.h"
#include "stages/import/divide_long_edges.h"
#include "stages/import/features.h"
#include "stages/import/fill_holes.h"
#include "stages/import/flat_faces.h"
#include "stages/import/gaps.h"
#include "stages/import/listed_edges.h"
#include "stages/import/noise.h"
#include "stages/import/openings.h"
#include "stages/import/sew.h"
#include "stages/import/sew_divided.h"
#include "stages/import/sheets.h"
#include "stages/import/soup.h"
#include "stages/import/triangulate.h"
#include "stages/import/turn_outwards.h"
#include "stages/import/voxel_steps.h"
#include "stages/import/weld.h"

namespace strake {
namespace {

using import::FeatureCounts;
using import::FeatureRules;
using import::Repairs;
using import::Soup;

Eigen::AlignedBox3d box_of_faces(const Soup& soup) {
  Eigen::AlignedBox3d box;
  for (const import::Triangle& face : soup.faces) {
    for (const Index v : face) box.extend(soup.positions[v]);
  }
  return box;
}

/// Where to put the origin: the middle of the box where it is far away compared to its size,
/// rounded so that no coordinate loses a digit when it is subtracted.
Vec3 choose_origin(const Eigen::AlignedBox3d& box) {
  constexpr double kFar = 10;
  const double diagonal = box.diagonal().norm();
  if (box.center().norm() <= kFar * diagonal) return Vec3::Zero();
  const double grid = std::exp2(std::floor(std::log2(diagonal)));
  return (box.center() / grid).array().round().matrix() * grid;
}

/// Diagonals between which products of several lengths, also of edges, are numbers.
constexpr double kSmallest = 1e-30;
constexpr double kLargest = 1e60;

/// Moves the soup to its origin. \throw InputError where it has no extent or area
void place(Soup& soup, TriMesh& frame) {
  if (soup.faces.empty()) throw InputError("the mesh has no usable face");
  const Eigen::AlignedBox3d box = box_of_faces(soup);
  frame.diagonal = box.diagonal().norm();
  if (!(frame.diagonal > 0)) throw InputError("all vertices of the mesh lie in one point");
  if (!(frame.diagonal <= kLargest)) {
    throw InputError("the coordinates of the mesh are too large; scale the model down");
  }
  if (frame.diagonal < kSmallest) throw InputError("the mesh is too small; scale the model up");
  frame.origin = choose_origin(box);
  for (Vec3& p : soup.positions) p -= frame.origin;
  if (import::total_area(soup) <= import::kThinnest * frame.diagonal * frame.diagonal) {
    throw InputError("the mesh has no area: all its vertices lie on a line");
  }
}

/// What was repaired, as sentences; what is no defect is not among them.
std::vector<std::string> describe(const Repairs& repairs, double diagonal) {
  std::vector<std::string> sentences;
  const auto add = [&](std::int64_t count, const char* what) {
    if (count > 0) sentences.push_back(fmt::format("{}: {}", what, count));
  };
  add(repairs.unusable_faces, "faces dropped that have no usable corners");
  add(repairs.degenerate_faces, "faces dropped that use a vertex twice");
  add(repairs.duplicate_faces, "faces dropped that were there twice");
  add(repairs.inner_faces, "faces dropped that were walls between touching solids");
  add(repairs.folded_slivers, "faces dropped that were slivers folded onto each other");
  add(repairs.faces_without_area, "faces dropped that belong to pieces without area");
  add(repairs.welded_vertices, "vertices merged where borders coincide");
  if (repairs.sewn_vertices > 0) {
    sentences.push_back(
        fmt::format("vertices merged across gaps between borders, of up to {:.2g} % of the "
                    "diagonal: {}",
                    100 * repairs.widest_gap / diagonal, repairs.sewn_vertices));
  }
  if (repairs.sewn_into_edges > 0) {
    sentences.push_back(
        fmt::format("vertices put into edges of borders that are divided differently, across gaps "
                    "of up to {:.2g} % of the diagonal: {}",
                    100 * repairs.widest_divided_gap / diagonal, repairs.sewn_into_edges));
  }
  add(repairs.non_orientable_cuts, "edges cut because the surface has only one side");
  add(repairs.flipped_faces, "faces turned over to agree with their neighbours");
  add(repairs.non_manifold_edges, "edges of more than two faces taken apart");
  add(repairs.split_vertices, "vertices copied where sheets or fans meet");
  add(repairs.inserted_vertices, "vertices inserted into edges with the same ends as another");
  add(repairs.collapsed_edges, "edges of no length collapsed");
  add(repairs.flipped_edges, "edges flipped to remove triangles without area");
  return sentences;
}

std::string list_repairs(const Repairs& repairs, double diagonal) {
  std::string list;
  for (const std::string& sentence : describe(repairs, diagonal)) list += "\n  " + sentence;
  return list;
}

void refuse_repairs(const Repairs& repairs, double diagonal) {
  const std::string list = list_repairs(repairs, diagonal);
  if (list.empty()) return;
  throw InputError("the mesh needs repairs, which --strict forbids:" + list);
}

/// Refuses repairs that take away too much of the surface.
void check_removed(double removed_percent, double most_removed_percent, const Repairs& repairs,
                   double diagonal) {
  if (removed_percent <= most_removed_percent) return;
  throw InputError(fmt::format(
      "repairs would remove {:.1f} % of the surface, and only {} % are allowed; let them "
      "with --most-removed {:.0f}, or repair the mesh before:{}",
      removed_percent, most_removed_percent, std::ceil(removed_percent),
      list_repairs(repairs, diagonal)));
}

void report_repairs(const Repairs& repairs, double removed_percent, double diagonal,
                    Report& report) {
  report.set("repairs.unusable_faces", repairs.unusable_faces);
  report.set("repairs.triangulated_faces", repairs.triangulated_faces);
  report.set("repairs.degenerate_faces", repairs.degenerate_faces);
  report.set("repairs.duplicate_faces", repairs.duplicate_faces);
  report.set("repairs.inner_faces", repairs.inner_faces);
  report.set("repairs.folded_slivers", repairs.folded_slivers);
  report.set("repairs.faces_without_area", repairs.faces_without_area);
  report.set("repairs.removed_percent", removed_percent);
  report.set("repairs.welded_vertices", repairs.welded_vertices);
  report.set("repairs.weld_tolerance", repairs.weld_tolerance / diagonal);
  report.set("repairs.sewn_vertices", repairs.sewn_vertices);
  report.set("repairs.sewn_into_edges", repairs.sewn_into_edges);
  report.set("repairs.widest_gap", repairs.widest_gap / diagonal);
  report.set("repairs.widest_divided_gap", repairs.widest_divided_gap / diagonal);
  report.set("repairs.farthest_moved", repairs.farthest_moved / diagonal);
  report.set("repairs.flipped_faces", repairs.flipped_faces);
  report.set("repairs.non_orientable_cuts", repairs.non_orientable_cuts);
  report.set("repairs.non_manifold_edges", repairs.non_manifold_edges);
  report.set("repairs.split_vertices", repairs.split_vertices);
  report.set("repairs.inserted_vertices", repairs.inserted_vertices);
  report.set("repairs.collapsed_edges", repairs.collapsed_edges);
  report.set("repairs.flipped_edges", repairs.flipped_edges);
  report.set("repairs.unreferenced_vertices", repairs.unreferenced_vertices);
  for (std::string& sentence : describe(repairs, diagonal)) report.warn(std::move(sentence));
}

void report_openings(const import::Openness& given, const import::Openness& repaired,
                     Report& report) {
  report.set("repairs.boundary_edges_before", given.boundary_edges);
  report.set("repairs.boundary_edges_after", repaired.boundary_edges);
  report.set("repairs.components_before", given.components);
  report.set("repairs.components_after", repaired.components);
  std::string warning = import::describe_openings(given, repaired);
  if (!warning.empty()) report.warn(std::move(warning));
}

/// What stays open here is a crack in the result.
void report_near_borders(const import::NearBorders& near, double diagonal, Report& report) {
  report.set("borders.near_edges", near.edges);
  report.set("borders.near_widest", near.widest / diagonal);
  if (near.edges == 0) return;
  const bool is_one = near.edges == 1;
  const std::string where =
      near.widest <= import::kCoincident * diagonal
          ? fmt::format("touch{} another border", is_one ? "es" : "")
          : fmt::format("{} within {:.2g} % of the diagonal of another border",
                        is_one ? "lies" : "lie", 100 * near.widest / diagonal);
  report.warn(fmt::format(
      "{} border edge{} {} without being joined, so the result may have cracks there: ends "
      "do not lie side by side, or the gap is wide, or open all along like a slit; where the "
      "surface should go on, close it before (merge vertices by distance, divide both sides "
      "alike, or export with a finer tolerance)",
      near.edges, is_one ? "" : "s", where));
}

/// What is made up where the file has nothing is told of.
void report_holes(const import::FilledHoles& holes, double diagonal, Report& report) {
  report.set("holes.filled", holes.filled);
  report.set("holes.left", holes.left);
  report.set("holes.widest", holes.widest / diagonal);
  if (holes.filled > 0) {
    report.warn(fmt::format("holes filled, of up to {:.2g} % of the diagonal across: {}",
                            100 * holes.widest / diagonal, holes.filled));
  }
  if (holes.left > 0) {
    report.warn(fmt::format("holes left open that no faces fit into: {}", holes.left));
  }
}

/// Many small holes are hardly meant, and each takes three vertices of a result.
void warn_of_small_holes(const Soup& triangles, double diagonal, Index loops, Report& report) {
  constexpr Index kMany = 10;
  constexpr double kSmall = 0.01;  ///< share of the diagonal
  if (loops < kMany) return;
  const Index holes = import::count_holes(triangles, kSmall * diagonal);
  if (holes < kMany) return;
  report.warn(
      fmt::format("{} holes are at most {:.0f} % of the diagonal across, and will be in the "
                  "result; --fill-holes {:.0f}% fills them",
                  holes, 100 * kSmall, 100 * kSmall));
}

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

std::int64_t count_unreferenced(const PolyMesh& mesh) {
  std::vector<std::uint8_t> used(mesh.positions.size(), 0);
  for (const Index v : mesh.corners) {
    if (v >= 0 && v < mesh.vertex_count()) used[v] = 1;
  }
  return std::count(used.begin(), used.end(), 0);
}

/// The triangles of a mesh once they are a manifold, and what that took.
struct Repaired {
  Soup triangles;
  TriMesh frame;  ///< origin and diagonal alone
  Repairs repairs;
  double removed_percent = 0;  ///< of the surface
  import::NearBorders near;    ///< that stay open
  import::FilledHoles holes;
  import::Openness openness;  ///< before faces were taken out
};

/// \throw InputError where repairs are forbidden or would take too much away, or nothing is left
Repaired repair(const PolyMesh& soup, const ImportOptions& options, Observer& observer) {
  Repaired result;
  auto& [triangles, frame, repairs, removed_percent, near, holes, openness] = result;
  observer.report("triangulating", 0);
  triangles = import::triangulate(soup, repairs);
  import::drop_degenerate_faces(triangles, repairs);
  place(triangles, frame);
  const double area = import::total_area(triangles);
  repairs.unreferenced_vertices = count_unreferenced(soup);

  observer.report("repairing", 0.1);
  import::drop_copied_pieces(triangles, repairs);
  std::vector<Index> border = import::weld_borders(triangles, frame.diagonal, repairs);
  border = import::sew_gaps(triangles, border, frame.diagonal, repairs);
  border = import::sew_divided_borders(triangles, border, frame.diagonal, repairs);
  near = import::find_near_borders(triangles, border, frame.diagonal);
  import::drop_degenerate_faces(triangles, repairs);
  openness = import::openness(triangles);
  import::drop_duplicate_faces(triangles, frame.diagonal, repairs);
  import::remove_flat_faces(triangles, import::make_manifold(triangles, repairs), frame.diagonal,
                            repairs);
  import::drop_pieces_without_area(triangles, frame.diagonal, repairs);
  if (triangles.faces.empty()) throw InputError("the mesh has no face left after the repairs");
  if (options.strict) refuse_repairs(repairs, frame.diagonal);
  removed_percent =
      100 * std::max(0.0, 1 - import::total_area(triangles) / (area - repairs.duplicate_area));
  check_removed(removed_percent, options.most_removed_percent, repairs, frame.diagonal);
  if (options.fill_holes) {
    observer.report("filling holes", 0.4);
    holes = import::fill_holes(triangles, options.fill_holes->resolve(frame.diagonal));
  }
  return result;
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
  const Repaired given = repair(soup, options, observer);
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
  report_repairs(given.repairs, given.removed_percent, given.frame.diagonal, result.report);
  report_openings(given.openness, repaired, result.report);
  report_near_borders(given.near, given.frame.diagonal, result.report);
  if (options.fill_holes) {
    report_holes(given.holes, given.frame.diagonal, result.report);
  } else {
    warn_of_small_holes(given.triangles, given.frame.diagonal, counts.boundary_loops,
                        result.report);
  }
  report_features(features, result.report);
  report_attributes(result.mesh.attributes, result.report);
  observer.report("done", 1);
  return result;
}

}  // namespace strake
