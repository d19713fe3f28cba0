#include "stages/trace/proximity.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace strake {
namespace {

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
    : mesh_(mesh),
      barriers_(barriers),
      head_(mesh.face_count(), kNone),
      stamp_(mesh.face_count(), 0) {}

void ProximityIndex::insert(Index face, LineSegment segment) {
  segment.next = head_[face];
  head_[face] = static_cast<Index>(segments_.size());
  segments_.push_back(segment);
  segment_face_.push_back(face);
}

void ProximityIndex::remove_last(std::size_t count) {
  for (; count > 0; --count) {
    head_[segment_face_.back()] = segments_.back().next;
    segments_.pop_back();
    segment_face_.pop_back();
  }
}

void ProximityIndex::grow_cell(Index face, const Vec3& point, double radius) {
  if (++current_ == 0) {
    std::fill(stamp_.begin(), stamp_.end(), 0U);
    current_ = 1;
  }
  cell_.assign(1, face);
  stamp_[face] = current_;
  const double limit = radius * radius;
  for (std::size_t at = 0; at < cell_.size(); ++at) {
    const Index f = cell_[at];
    std::array<const Vec3*, 3> corner{};
    std::array<bool, 3> within{};
    for (int i = 0; i < 3; ++i) {
      corner[i] = &mesh_.positions[mesh_.faces[f][i]];
      within[i] = (*corner[i] - point).squaredNorm() <= limit;
    }
    for (int i = 0; i < 3; ++i) {
      const Index h = 3 * f + i;
      if (barriers_[h] != 0) continue;
      const Index other = TriMesh::face_of(mesh_.twin[h]);
      if (stamp_[other] == current_) continue;
      // The edge, not its end points alone: large faces have none within reach.
      const int j = (i + 1) % 3;
      if (!within[i] && !within[j] && squared_distance(point, *corner[i], *corner[j]) > limit) {
        continue;
      }
      stamp_[other] = current_;
      cell_.push_back(other);
    }
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
  for (const Index f : cell_) {
    for (Index s = head_[f]; s != kNone; s = segments_[s].next) {
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
  for (const Index f : cell_) {
    for (Index s = head_[f]; s != kNone; s = segments_[s].next) {
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
