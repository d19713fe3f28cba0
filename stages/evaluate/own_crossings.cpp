#include "stages/evaluate/own_crossings.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "common/core/place_text.h"
#include "common/geometry/face_crossings/box_tree.h"
#include "common/geometry/face_crossings/face_crossings.h"
#include "common/geometry/face_crossings/penetration.h"
#include "common/geometry/topology/topology.h"

namespace strake::evaluation {
namespace {

/// Share of the diagonal up to which faces touch: what files of single precision leave of a common
/// edge.
constexpr double kTouchingDepth = 1e-6;

std::array<Vec3, 3> places_of(const std::vector<Vec3>& positions,
                              const std::array<Index, 3>& corners) {
  return {positions[corners[0]], positions[corners[1]], positions[corners[2]]};
}

BoxTree::Box box_of(const std::array<Vec3, 3>& triangle) {
  BoxTree::Box box(triangle[0]);
  return box.extend(triangle[1]).extend(triangle[2]);
}

/// Whether triangles lie on each other as sides of solids that touch do: in a plane, but for
/// `within`, and looking opposite ways.
bool lie_against(const std::array<Vec3, 3>& t, const std::array<Vec3, 3>& u, double within) {
  const auto normal = [](const std::array<Vec3, 3>& of) -> Vec3 {
    return (of[1] - of[0]).cross(of[2] - of[0]).stableNormalized();
  };
  const auto is_in_plane = [&](const std::array<Vec3, 3>& one, const std::array<Vec3, 3>& other) {
    return std::ranges::all_of(
        one, [&](const Vec3& p) { return std::abs(normal(other).dot(p - other[0])) <= within; });
  };
  return normal(t).dot(normal(u)) < 0 && (is_in_plane(t, u) || is_in_plane(u, t));
}

/// How deep triangles pass through each other; 0 where they only touch.
double crossing_depth(const std::array<Vec3, 3>& t, const std::array<Vec3, 3>& u, double touching) {
  if (!triangles_cross(t, u) || lie_against(t, u, touching)) return 0;
  const double depth = penetration_depth(t, u);
  return depth > touching ? depth : 0;
}

/// Number of these pairs of which no triangles cross.
std::int64_t count_touching(const std::vector<Vec3>& positions, const FaceTriangles& triangles,
                            const std::vector<std::array<Index, 2>>& pairs, double touching) {
  const auto triangles_of = [&](Index face) {
    const auto first = std::ranges::lower_bound(triangles.face, face);
    const auto last = std::ranges::upper_bound(triangles.face, face);
    return std::span(triangles.corners.begin() + (first - triangles.face.begin()),
                     static_cast<std::size_t>(last - first));
  };
  return std::ranges::count_if(pairs, [&](const std::array<Index, 2>& pair) {
    return std::ranges::none_of(triangles_of(pair[0]), [&](const std::array<Index, 3>& one) {
      return std::ranges::any_of(triangles_of(pair[1]), [&](const std::array<Index, 3>& other) {
        return crossing_depth(places_of(positions, one), places_of(positions, other), touching) > 0;
      });
    });
  });
}

/// [components] 1: has a boundary. \param component  [F]
std::vector<std::uint8_t> open_components(const TriMesh& mesh,
                                          const std::vector<Index>& component) {
  std::vector<std::uint8_t> is_open(*std::ranges::max_element(component) + 1, 0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (mesh.is_boundary(h)) is_open[component[TriMesh::face_of(h)]] = 1;
  }
  return is_open;
}

/// What to do about crossing parts.
const char* remedy(const OwnCrossings& own) {
  if (!own.between_parts) return "repair the model first";
  return own.between_open_parts
             ? "make one surface of the sheets first (of scans that overlap by a surface "
               "reconstruction)"
             : "unite the parts of the model first (a boolean union), or repair it";
}

}  // namespace

OwnCrossings find_own_crossings(const TriMesh& mesh) {
  FaceTriangles triangles{mesh.faces, std::vector<Index>(mesh.faces.size())};
  std::iota(triangles.face.begin(), triangles.face.end(), Index{0});
  OwnCrossings own;
  const double touching = kTouchingDepth * mesh.diagonal;
  double deepest = touching;
  const auto pairs = find_crossing_faces(mesh.positions, triangles);
  if (pairs.empty()) return own;
  const std::vector<Index> component = face_components(mesh);
  const std::vector<std::uint8_t> is_open = open_components(mesh, component);
  for (const auto& [f, g] : pairs) {
    const std::array<Vec3, 3> one = places_of(mesh.positions, mesh.faces[f]);
    const std::array<Vec3, 3> two = places_of(mesh.positions, mesh.faces[g]);
    const double depth = crossing_depth(one, two, touching);
    if (depth == 0) {
      ++own.touching;
      continue;
    }
    ++own.pairs;
    if (component[f] != component[g]) {
      own.between_parts = true;
      own.between_open_parts |= is_open[component[f]] != 0 && is_open[component[g]] != 0;
    }
    if (depth <= deepest) continue;
    deepest = depth;
    own.place = box_of(one).intersection(box_of(two)).center();
  }
  return own;
}

void report_own_crossings(const TriMesh& reference, const std::vector<Vec3>& positions,
                          const FaceTriangles& triangles,
                          const std::vector<std::array<Index, 2>>& pairs, Report& report) {
  const std::int64_t touching =
      count_touching(positions, triangles, pairs, kTouchingDepth * reference.diagonal);
  report.set("shape.touching_pairs", touching);
  const std::int64_t crossing = std::ssize(pairs) - touching;
  if (crossing == 0) return;
  const OwnCrossings own = find_own_crossings(reference);
  report.set("shape.reference_crossing_pairs", own.pairs);
  if (own.pairs == 0 && own.touching > 0) {
    report.warn(fmt::format(
        "{} pair{} of faces of the result cross{}, where the input has {} that only touch, as "
        "parts against each other do: their cells differ there, and so pass through each other a "
        "little; where they should not, unite the parts of the model first (a boolean union)",
        crossing, crossing == 1 ? "" : "s", crossing == 1 ? "es" : "", own.touching));
  }
  if (own.pairs == 0) return;
  const Vec3 place = own.place + reference.origin;
  report.warn(fmt::format(
      "{} pair{} of faces of the result cross{}, and the input itself has {} such pair{}, one near "
      "{}: there the result crosses itself, too; where it should not, {}",
      crossing, crossing == 1 ? "" : "s", crossing == 1 ? "es" : "", own.pairs,
      own.pairs == 1 ? "" : "s", place_text(place, reference.diagonal), remedy(own)));
}

}  // namespace strake::evaluation
