#include "stages/trace/proximity.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace strake {
namespace {

/// Share of the largest coordinate by which single precision may round a place, doubled.
constexpr double kTileRounding = 2.5e-7;

/// From p to the nearest point of segment a-b.
Vec3 way_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a;
  const double length = d.squaredNorm();
  const double t = length > 0 ? std::clamp((p - a).dot(d) / length, 0.0, 1.0) : 0.0;
  return a + t * d - p;
}

double squared_distance(const Vec3& p, const Vec3& a, const Vec3& b) {
  return way_to_segment(p, a, b).squaredNorm();
}

/// How far along its line a segment is from the point at `arc`.
double way_along(const LineSegment& segment, double arc) {
  return std::abs(segment.arc - arc) - 0.5 * (segment.b - segment.a).norm();
}

}  // namespace

ProximityIndex::ProximityIndex(const TriMesh& mesh, const std::vector<std::uint8_t>& barriers)
    : mesh_(mesh), barriers_(barriers), tiles_(mesh.face_count()), stamp_(mesh.face_count(), 0) {
  double largest = 0;
  for (const Vec3& p : mesh.positions) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const auto& [a, b, c] = mesh.faces[f];
    const Vec3 centre = (mesh.positions[a] + mesh.positions[b] + mesh.positions[c]) / 3;
    double radius = 0;
    for (const Index v : mesh.faces[f]) {
      radius = std::max(radius, (mesh.positions[v] - centre).norm());
    }
    Tile& tile = tiles_[f];
    tile.radius = static_cast<float>(radius + kTileRounding * largest);
    for (int i = 0; i < 3; ++i) {
      tile.centre[i] = static_cast<float>(centre[i]);
      const Index h = 3 * f + i;
      tile.neighbour[i] = barriers[h] != 0 ? kNone : TriMesh::face_of(mesh.twin[h]);
    }
  }
}

void ProximityIndex::insert(Index face, LineSegment segment) {
  segment.next = tiles_[face].head;
  tiles_[face].head = static_cast<Index>(segments_.size());
  segments_.push_back(segment);
  segment_face_.push_back(face);
}

void ProximityIndex::remove_last(std::size_t count) {
  for (; count > 0; --count) {
    tiles_[segment_face_.back()].head = segments_.back().next;
    segments_.pop_back();
    segment_face_.pop_back();
  }
}

bool ProximityIndex::is_occupied(const Tile& tile) {
  return tile.head != kNone || std::ranges::find(tile.neighbour, kNone) != tile.neighbour.end();
}

/// Collects the faces that can be reached over edges within the radius.
void ProximityIndex::collect_cell(Index face, const Vec3& point, double radius) {
  if (++current_ == 0) {
    std::fill(stamp_.begin(), stamp_.end(), 0U);
    current_ = 1;
  }
  cell_.assign(1, face);
  stamp_[face] = current_;
  const double limit = radius * radius;
  for (std::size_t at = 0; at < cell_.size(); ++at) {
    const Index f = cell_[at];
    const Tile& tile = tiles_[f];
    const double room = radius - tile.radius;
    const Vec3 centre(tile.centre[0], tile.centre[1], tile.centre[2]);
    const bool is_within = room > 0 && (centre - point).squaredNorm() <= room * room;
    for (int i = 0; i < 3; ++i) {
      const Index other = tile.neighbour[i];
      if (other == kNone || stamp_[other] == current_) continue;
      // The edge, not its end points alone: large faces have none within reach.
      if (!is_within && squared_distance(point, mesh_.positions[mesh_.faces[f][i]],
                                         mesh_.positions[mesh_.faces[f][(i + 1) % 3]]) > limit) {
        continue;
      }
      stamp_[other] = current_;
      cell_.push_back(other);
    }
  }
}

void ProximityIndex::grow_cell(Index face, const Vec3& point, double radius) {
  if (face != cell_face_ || point != cell_point_ || radius != cell_radius_) {
    collect_cell(face, point, radius);
    cell_face_ = face;
    cell_point_ = point;
    cell_radius_ = radius;
  }
  occupied_.clear();
  for (const Index f : cell_) {
    if (is_occupied(tiles_[f])) occupied_.push_back(f);
  }
}

ProximityHit ProximityIndex::query(const ProximityQuery& query) {
  ++query_count_;
  grow_cell(query.face, query.point, query.radius);
  ProximityHit hit;
  double best = query.distance * query.distance;
  const auto same_direction = [&](const Vec3& d) {
    return std::abs(d.dot(query.direction)) > M_SQRT1_2;
  };
  for (const Index f : occupied_) {
    for (Index s = tiles_[f].head; s != kNone; s = segments_[s].next) {
      const LineSegment& segment = segments_[s];
      const bool own = segment.line == query.own_line;
      if (own && way_along(segment, query.own_arc) < query.own_skip) continue;
      const bool alike =
          query.by_family ? segment.family == query.family : same_direction(segment.direction);
      if (!alike) continue;
      const double d = squared_distance(query.point, segment.a, segment.b);
      if (d < best) {
        best = d;
        hit = {true, segment.line, 0};
      }
    }
    for (Index h = 3 * f; h < 3 * f + 3 && !query.ignore_barriers; ++h) {
      if (barriers_[h] == 0) continue;
      const Vec3& a = mesh_.positions[mesh_.from(h)];
      const Vec3& b = mesh_.positions[mesh_.to(h)];
      if (!same_direction((b - a).normalized())) continue;
      const double d = squared_distance(query.point, a, b);
      if (d < best) {
        best = d;
        hit = {true, kNone, 0};
      }
    }
  }
  hit.distance = std::sqrt(best);
  return hit;
}

std::pair<double, double> ProximityIndex::distances_beside(const ProximityQuery& query,
                                                           const Vec3& left) {
  ++query_count_;
  grow_cell(query.face, query.point, query.radius);
  std::pair<double, double> nearest{query.radius, query.radius};
  const auto consider = [&](const Vec3& a, const Vec3& b, const Vec3& direction) {
    if (!(std::abs(direction.dot(query.direction)) > M_SQRT1_2)) return;
    const Vec3 way = way_to_segment(query.point, a, b);
    double& side = way.dot(left) > 0 ? nearest.first : nearest.second;
    side = std::min(side, way.norm());
  };
  for (const Index f : occupied_) {
    for (Index s = tiles_[f].head; s != kNone; s = segments_[s].next) {
      if (segments_[s].line == query.own_line) continue;
      consider(segments_[s].a, segments_[s].b, segments_[s].direction);
    }
    for (Index h = 3 * f; h < 3 * f + 3; ++h) {
      if (barriers_[h] == 0) continue;
      const Vec3& a = mesh_.positions[mesh_.from(h)];
      const Vec3& b = mesh_.positions[mesh_.to(h)];
      consider(a, b, (b - a).normalized());
    }
  }
  return nearest;
}

}  // namespace strake
