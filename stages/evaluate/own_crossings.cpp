#include "stages/evaluate/own_crossings.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "common/core/place_text.h"
#include "common/geometry/face_crossings/box_tree.h"
#include "common/geometry/face_crossings/face_crossings.h"
#include "common/geometry/face_crossings/penetration.h"
#include "common/geometry/poly_topology/face_shape.h"

namespace strake::evaluation {
namespace {

/// Share of the diagonal up to which faces touch: what files of single precision leave of a common
/// edge.
constexpr double kTouchingDepth = 1e-6;

std::array<Vec3, 3> corners_of(const TriMesh& mesh, Index face) {
  const auto& [a, b, c] = mesh.faces[face];
  return {mesh.positions[a], mesh.positions[b], mesh.positions[c]};
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

}  // namespace

OwnCrossings find_own_crossings(const TriMesh& mesh) {
  FaceTriangles triangles{mesh.faces, std::vector<Index>(mesh.faces.size())};
  std::iota(triangles.face.begin(), triangles.face.end(), Index{0});
  OwnCrossings own;
  const double touching = kTouchingDepth * mesh.diagonal;
  double deepest = touching;
  for (const auto& [f, g] : find_crossing_faces(mesh.positions, triangles)) {
    const std::array<Vec3, 3> one = corners_of(mesh, f);
    const std::array<Vec3, 3> two = corners_of(mesh, g);
    if (lie_against(one, two, touching)) continue;
    const double depth = penetration_depth(one, two);
    if (depth <= touching) continue;
    ++own.pairs;
    if (depth <= deepest) continue;
    deepest = depth;
    own.place = box_of(one).intersection(box_of(two)).center();
  }
  return own;
}

void report_own_crossings(const TriMesh& reference, std::int64_t pairs, Report& report) {
  if (pairs == 0) return;
  const OwnCrossings own = find_own_crossings(reference);
  report.set("shape.reference_crossing_pairs", own.pairs);
  if (own.pairs == 0) return;
  const Vec3 place = own.place + reference.origin;
  report.warn(fmt::format(
      "{} pair{} of faces of the result cross{}, and the input itself has {} such pair{}, one near "
      "{}: the result follows it and crosses itself there, too; where it "
      "should not, unite the parts of the model first (a boolean union), or repair it",
      pairs, pairs == 1 ? "" : "s", pairs == 1 ? "es" : "", own.pairs, own.pairs == 1 ? "" : "s",
      place_text(place, reference.diagonal)));
}

}  // namespace strake::evaluation
