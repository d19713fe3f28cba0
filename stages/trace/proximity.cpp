#include "stages/trace/proximity.h"

#include <algorithm>
#include <cmath>

#include "common/geometry/segment.h"

namespace strake {
namespace {

/// Share of the largest coordinate by which places may be rounded.
constexpr double kRounding = 1e-12;

double squared_distance(const Vec3& p, const Vec3& a, const Vec3& b) {
  return way_to_segment(p, a, b).squaredNorm();
}

}  // namespace

void SegmentLists::push(const LineSegment& segment) {
  const auto number = static_cast<Index>(segments_.size());
  segments_.push_back(segment);
  const auto [first, last] = blocks_.slabs(blocks_.block_of(segment.face), segment.a, segment.b, 0);
  for (Index slab = first; slab < last; ++slab) {
    nodes_.push_back({number, slab, head_[slab]});
    head_[slab] = static_cast<Index>(nodes_.size()) - 1;
  }
}

void SegmentLists::shrink(std::size_t count) {
  for (; segments_.size() > count; segments_.pop_back()) {
    const auto number = static_cast<Index>(segments_.size()) - 1;
    for (; !nodes_.empty() && nodes_.back().segment == number; nodes_.pop_back()) {
      head_[nodes_.back().slab] = nodes_.back().next;
    }
  }
}

ProximityIndex::ProximityIndex(const FaceBlocks& blocks, const std::vector<std::uint8_t>& barriers)
    : blocks_(blocks), segments_(blocks) {
  first_barrier_.reserve(static_cast<std::size_t>(blocks.count()) + 1);
  first_barrier_.push_back(0);
  for (Index block = 0; block < blocks.count(); ++block) {
    for (const Index f : blocks.faces(block)) {
      for (Index h = 3 * f; h < 3 * f + 3; ++h) {
        if (barriers[h] != 0) add_barrier(h);
      }
    }
    first_barrier_.push_back(static_cast<Index>(barriers_.size()));
  }
}

void ProximityIndex::add_barrier(Index halfedge) {
  const TriMesh& mesh = blocks_.mesh();
  const Vec3& a = mesh.positions[mesh.from(halfedge)];
  const Vec3& b = mesh.positions[mesh.to(halfedge)];
  const double largest = std::max(a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff());
  barriers_.push_back({a, b, (b - a).normalized(), (a + b) / 2,
                       (b - a).norm() / 2 + kRounding * (largest + (b - a).norm()), halfedge});
}

void ProximityIndex::insert(std::span<const LineSegment> segments, Index line) {
  for (LineSegment segment : segments) {
    segment.line = line;
    segments_.push(segment);
  }
}

ProximityProbe::ProximityProbe(const ProximityIndex& index)
    : index_(index), walk_(index.blocks()), segments_(index.blocks()) {}

void ProximityProbe::clear() {
  shrink(0);
  query_count_ = 0;
}

bool ProximityProbe::can_reach(Index face, const Vec3& point, double distance, Index target) {
  walk_.around(face, point, distance, [&](Index) { return distance; });
  return walk_.reached(target);
}

void ProximityProbe::record(const LineSegment& segment, double arc) {
  segments_.push(segment);
  arcs_.push_back(arc);
}

void ProximityProbe::shrink(std::size_t count) {
  segments_.shrink(count);
  arcs_.resize(segments_.all().size());
}

ProximityHit ProximityProbe::query(const ProximityQuery& query) {
  ++query_count_;
  ProximityHit hit;
  double best = query.distance * query.distance;
  hit.distance = query.distance;  // shrinks, and what is farther is not looked at any more
  const auto consider = [&](const Vec3& a, const Vec3& b, Index line) {
    const double d = squared_distance(query.point, a, b);
    if (!(d < best)) return;
    best = d;
    hit = {true, line, std::sqrt(d)};
  };
  walk_.around(query.face, query.point, query.distance, [&](Index block) {
    const auto for_near = [&](const SegmentLists& segments, const auto& use) {
      segments.for_near(block, query.point, hit.distance, use);
    };
    for_near(segments_, [&](const LineSegment& own, Index s) {
      const double way = std::abs(arcs_[s] - query.own_arc) - 0.5 * (own.b - own.a).norm();
      if (way >= query.own_skip && query.is_alike(own)) consider(own.a, own.b, kOwnLine);
    });
    for_near(index_.segments(), [&](const LineSegment& segment, Index) {
      if (query.is_alike(segment)) consider(segment.a, segment.b, segment.line);
    });
    if (query.ignore_barriers) return hit.distance;
    index_.for_barriers(block, query.point, hit.distance, [&](const auto& barrier) {
      if (query.is_alike(barrier.direction)) consider(barrier.a, barrier.b, kNone);
    });
    return hit.distance;
  });
  return hit;
}

std::pair<double, double> ProximityProbe::distances_beside(const ProximityQuery& query,
                                                           const Vec3& left) {
  ++query_count_;
  std::pair<double, double> nearest{query.distance, query.distance};
  const auto consider = [&](const Vec3& a, const Vec3& b) {
    const Vec3 way = way_to_segment(query.point, a, b);
    double& side = way.dot(left) > 0 ? nearest.first : nearest.second;
    side = std::min(side, way.norm());
  };
  walk_.around(query.face, query.point, query.distance, [&](Index block) {
    const double reach = std::max(nearest.first, nearest.second);
    index_.segments().for_near(block, query.point, reach, [&](const LineSegment& segment, Index) {
      if (query.is_alike(segment.direction)) consider(segment.a, segment.b);
    });
    index_.for_barriers(block, query.point, reach, [&](const auto& barrier) {
      if (query.is_alike(barrier.direction)) consider(barrier.a, barrier.b);
    });
    return std::max(nearest.first, nearest.second);
  });
  return nearest;
}

Index ProximityProbe::corner_ahead(const ProximityQuery& query, double least_cosine) {
  ++query_count_;
  const TriMesh& mesh = index_.blocks().mesh();
  Index found = kNone;
  double nearest = query.distance;
  walk_.around(query.face, query.point, query.distance, [&](Index block) {
    index_.for_barriers(block, query.point, nearest, [&](const auto& barrier) {
      for (const Index v : {mesh.from(barrier.halfedge), mesh.to(barrier.halfedge)}) {
        if (mesh.is_corner[v] == 0) continue;
        const Vec3 way = mesh.positions[v] - query.point;
        const double distance = way.norm();
        if (!(distance > 0) || distance >= nearest) continue;
        if (way.dot(query.direction) < least_cosine * distance) continue;
        nearest = distance;
        found = v;
      }
    });
    return nearest;
  });
  return found;
}

}  // namespace strake
