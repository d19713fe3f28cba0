#include "stages/fit/face_guard.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/geometry/angles.h"
#include "common/geometry/face_crossings/face_crossings.h"

namespace strake::fitting {
namespace {

constexpr double kSmallAngle = 20 * kDegree;
/// Angles that differ by less are equal: rounding.
constexpr double kSameAngle = 1e-9;

/// Share of a face's longest side, up to which a side has no length.
constexpr double kNoLength = 1e-9;
/// Share of a face's mean side below which a side must not get shorter: vertices that slide along
/// a line would come to lie on each other, a quarter of the way in each round.
constexpr double kShortSide = 0.05;
/// Share of its length at first from which on a side is not short: the face is narrow.
constexpr double kLikeAtFirst = 0.5;
/// Times the length at which a side is short that moves leave it: faces grow meanwhile.
constexpr double kRoom = 1.1;
/// Lengths that differ by a smaller share are equal: rounding.
constexpr double kSameLength = 1e-9;

/// Pairs that cross, for each face: results that only fold over have less than one.
constexpr std::size_t kTangledPairs = 8;

}  // namespace

template <class Use>
void FaceGuard::for_sides(const VertexPlaces& places, Index face, const Use& use) const {
  const std::vector<Vec3>& p = places.positions();
  const std::span<const Index> corners = mesh_.face(face);
  const auto length = [&](std::size_t i) {
    return (p[corners[(i + 1) % corners.size()]] - p[corners[i]]).norm();
  };
  double mean = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) mean += length(i);
  mean /= static_cast<double>(corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const std::size_t corner = static_cast<std::size_t>(mesh_.offsets[face]) + i;
    const double like_at_first = kLikeAtFirst * first_sides_[corner];
    use(corner, Side{length(i), std::min(kShortSide * mean, like_at_first)});
  }
}

FaceGuard::FaceGuard(const PolyMesh& mesh, const VertexPlaces& places)
    : mesh_(mesh),
      allowed_(
          find_crossing_faces(places.positions(), triangulate_faces(mesh, places.positions()))),
      looked_at_(places.positions()),
      first_sides_(mesh.corners.size(), 0) {
  for (Index f = 0; f < mesh.face_count(); ++f) {
    for_sides(places, f,
              [&](std::size_t corner, const Side& side) { first_sides_[corner] = side.length; });
  }
}

bool FaceGuard::is_tangled() const {
  return allowed_.size() > kTangledPairs * static_cast<std::size_t>(mesh_.face_count());
}

FaceGuard::Form FaceGuard::form(const VertexPlaces& places, Index face) const {
  const std::vector<Vec3>& p = places.positions();
  const std::span<const Index> corners = mesh_.face(face);
  Form form;
  form.is_concave = is_concave_face(p, corners);
  form.least_angle = std::numbers::pi;
  Vec3 outward = Vec3::Zero();
  double shortest = std::numeric_limits<double>::infinity();
  double longest = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3 ahead = p[corners[(i + 1) % corners.size()]] - p[corners[i]];
    const Vec3 back = p[corners[(i + corners.size() - 1) % corners.size()]] - p[corners[i]];
    form.least_angle = std::min(form.least_angle, angle_between(ahead, back));
    outward += places.normal(corners[i]);
    shortest = std::min(shortest, ahead.norm());
    longest = std::max(longest, ahead.norm());
  }
  // Beside a side of no length, as where a vertex slides to a corner that has one, angles are those
  // of rounding.
  if (shortest <= kNoLength * longest) form.least_angle = 0;
  form.faces_away = newell_normal(p, corners).dot(outward) < 0;
  return form;
}

void FaceGuard::set_start(const VertexPlaces& places) {
  start_.resize(static_cast<std::size_t>(mesh_.face_count()));
  start_sides_.resize(mesh_.corners.size());
  tbb::parallel_for(Index{0}, mesh_.face_count(), [&](Index f) {
    start_[f] = form(places, f);
    for_sides(places, f,
              [&](std::size_t corner, const Side& side) { start_sides_[corner] = side.length; });
  });
}

bool FaceGuard::is_too_short(std::size_t corner, const Side& side) const {
  return side.length < side.least && side.length < (1 - kSameLength) * start_sides_[corner];
}

void FaceGuard::keep_apart(const VertexPlaces& places, std::vector<Vec3>& moves) const {
  for (Index f = 0; f < mesh_.face_count(); ++f) {
    const std::span<const Index> corners = mesh_.face(f);
    for_sides(places, f, [&](std::size_t corner, const Side& side) {
      const std::size_t i = corner - static_cast<std::size_t>(mesh_.offsets[f]);
      const Index v = corners[i];
      const Index w = corners[(i + 1) % corners.size()];
      if (!(side.length > 0)) return;
      const Vec3 way = (places.positions()[w] - places.positions()[v]) / side.length;
      const double room = std::max(side.length - kRoom * side.least, 0.0);
      const double excess = (moves[v] - moves[w]).dot(way) - room;
      if (!(excess > 0)) return;
      moves[v] -= excess / 2 * way;
      moves[w] += excess / 2 * way;
    });
  }
}

bool FaceGuard::is_spoilt(const VertexPlaces& places, Index face) const {
  bool has_short_side = false;
  for_sides(places, face, [&](std::size_t corner, const Side& side) {
    has_short_side = has_short_side || is_too_short(corner, side);
  });
  return has_short_side || is_worse(places, face);
}

bool FaceGuard::is_worse(const VertexPlaces& places, Index face) const {
  const Form now = form(places, face);
  const Form& start = start_[face];
  return (now.is_concave && !start.is_concave) || (now.faces_away && !start.faces_away) ||
         (now.least_angle < kSmallAngle && now.least_angle < start.least_angle - kSameAngle);
}

std::vector<std::uint8_t> FaceGuard::spoilt(const VertexPlaces& places) const {
  std::vector<std::uint8_t> is_spoilt_face(start_.size());
  tbb::parallel_for(Index{0}, mesh_.face_count(),
                    [&](Index f) { is_spoilt_face[f] = is_worse(places, f) ? 1 : 0; });
  std::vector<std::uint8_t> spoilt(mesh_.positions.size(), 0);
  for (Index f = 0; f < mesh_.face_count(); ++f) {
    const std::span<const Index> corners = mesh_.face(f);
    for_sides(places, f, [&](std::size_t corner, const Side& side) {
      if (!is_too_short(corner, side)) return;
      const std::size_t i = corner - static_cast<std::size_t>(mesh_.offsets[f]);
      for (const Index v : {corners[i], corners[(i + 1) % corners.size()]}) spoilt[v] = 1;
    });
    if (is_spoilt_face[f] == 0) continue;
    for (const Index v : corners) spoilt[v] = 1;
  }
  return spoilt;
}

std::vector<std::uint8_t> FaceGuard::newly_crossing(const VertexPlaces& places) {
  std::vector<std::uint8_t> has_moved(static_cast<std::size_t>(mesh_.face_count()), 0);
  for (Index f = 0; f < mesh_.face_count(); ++f) {
    has_moved[f] = std::ranges::any_of(
        mesh_.face(f), [&](Index v) { return places.positions()[v] != looked_at_[v]; });
  }
  looked_at_ = places.positions();
  std::vector<std::uint8_t> crossing(mesh_.positions.size(), 0);
  const FaceTriangles triangles = triangulate_faces(mesh_, looked_at_);
  for (const auto& pair : find_crossing_faces(looked_at_, triangles, has_moved, allowed_)) {
    for (const Index f : pair) {
      for (const Index v : mesh_.face(f)) crossing[v] = 1;
    }
  }
  // Less of a move may lead to the same place, at the end of a line: its faces are looked at again.
  for (std::size_t v = 0; v < crossing.size(); ++v) {
    if (crossing[v] != 0) looked_at_[v].setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  return crossing;
}

}  // namespace strake::fitting
