#include "stages/import/repair.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "common/core/error.h"
#include "stages/import/copied_pieces.h"
#include "stages/import/flat_faces.h"
#include "stages/import/gaps.h"
#include "stages/import/sew.h"
#include "stages/import/sew_divided.h"
#include "stages/import/sheets.h"
#include "stages/import/triangulate.h"
#include "stages/import/weld.h"

namespace strake::import {
namespace {

Eigen::AlignedBox3d box_of_faces(const Soup& soup) {
  Eigen::AlignedBox3d box;
  for (const Triangle& face : soup.faces) {
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
  if (total_area(soup) <= kThinnest * frame.diagonal * frame.diagonal) {
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

void report_counts(const Repairs& repairs, double removed_percent, double diagonal,
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

void report_openings(const Openness& given, const Openness& repaired, Report& report) {
  report.set("repairs.boundary_edges_before", given.boundary_edges);
  report.set("repairs.boundary_edges_after", repaired.boundary_edges);
  report.set("repairs.components_before", given.components);
  report.set("repairs.components_after", repaired.components);
  std::string warning = describe_openings(given, repaired);
  if (!warning.empty()) report.warn(std::move(warning));
}

/// What stays open here is a crack in the result.
void report_near_borders(const NearBorders& near, double diagonal, Report& report) {
  report.set("borders.near_edges", near.edges);
  report.set("borders.near_widest", near.widest / diagonal);
  if (near.edges == 0) return;
  const bool is_one = near.edges == 1;
  const std::string where =
      near.widest <= kCoincident * diagonal
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
void report_holes(const FilledHoles& holes, double diagonal, Report& report) {
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
  const Index holes = count_holes(triangles, kSmall * diagonal);
  if (holes < kMany) return;
  report.warn(
      fmt::format("{} holes are at most {:.0f} % of the diagonal across, and will be in the "
                  "result; --fill-holes {:.0f}% fills them",
                  holes, 100 * kSmall, 100 * kSmall));
}

std::int64_t count_unreferenced(const PolyMesh& mesh) {
  std::vector<std::uint8_t> used(mesh.positions.size(), 0);
  for (const Index v : mesh.corners) {
    if (v >= 0 && v < mesh.vertex_count()) used[v] = 1;
  }
  return std::count(used.begin(), used.end(), 0);
}

}  // namespace

Repaired repair(const PolyMesh& soup, const ImportOptions& options, Observer& observer) {
  Repaired result;
  auto& [triangles, frame, repairs, removed_percent, near, holes, openness] = result;
  observer.report("triangulating", 0);
  triangles = triangulate(soup, repairs);
  drop_degenerate_faces(triangles, repairs);
  place(triangles, frame);
  const double area = total_area(triangles);
  repairs.unreferenced_vertices = count_unreferenced(soup);

  observer.report("repairing", 0.1);
  drop_copied_pieces(triangles, repairs);
  std::vector<Index> border = weld_borders(triangles, frame.diagonal, repairs);
  border = sew_gaps(triangles, border, frame.diagonal, repairs);
  border = sew_divided_borders(triangles, border, frame.diagonal, repairs);
  near = find_near_borders(triangles, border, frame.diagonal);
  drop_degenerate_faces(triangles, repairs);
  openness = import::openness(triangles);
  drop_duplicate_faces(triangles, frame.diagonal, repairs);
  remove_flat_faces(triangles, make_manifold(triangles, repairs), frame.diagonal, repairs);
  drop_pieces_without_area(triangles, frame.diagonal, repairs);
  if (triangles.faces.empty()) throw InputError("the mesh has no face left after the repairs");
  if (options.strict) refuse_repairs(repairs, frame.diagonal);
  removed_percent =
      100 * std::max(0.0, 1 - total_area(triangles) / (area - repairs.duplicate_area));
  check_removed(removed_percent, options.most_removed_percent, repairs, frame.diagonal);
  if (options.fill_holes) {
    observer.report("filling holes", 0.4);
    holes = fill_holes(triangles, options.fill_holes->resolve(frame.diagonal));
  }
  return result;
}

void report_repairs(const Repaired& repaired, const Openness& after, Index boundary_loops,
                    Report& report) {
  const double diagonal = repaired.frame.diagonal;
  report_counts(repaired.repairs, repaired.removed_percent, diagonal, report);
  report_openings(repaired.openness, after, report);
  report_near_borders(repaired.near, diagonal, report);
  if (repaired.holes) {
    report_holes(*repaired.holes, diagonal, report);
  } else {
    warn_of_small_holes(repaired.triangles, diagonal, boundary_loops, report);
  }
}

}  // namespace strake::import
