#include "stages/trace/proximity.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include "common/core/poly_mesh.h"
#include "tests/support/mesh_support.h"
#include "tests/unit/trace/fields.h"

namespace strake {
namespace {

double distance_to(const LineSegment& segment, const Vec3& p) {
  const Vec3 d = segment.b - segment.a;
  const double t = std::clamp((p - segment.a).dot(d) / d.squaredNorm(), 0.0, 1.0);
  return (segment.a + t * d - p).norm();
}

/// An index with random segments, and the same segments in a plain list.
class RandomSegments {
 public:
  RandomSegments(const TriMesh& mesh, int count, std::uint64_t seed)
      : mesh_(mesh), barriers_(mesh.halfedge_count(), 0), index_(mesh, barriers_), random_(seed) {
    for (int i = 0; i < count; ++i) add();
  }

  ProximityIndex& index() { return index_; }

  void add() {
    const Index face = random_face();
    LineSegment segment;
    segment.a = point_in(face);
    segment.b = point_in(face);
    segment.direction = (segment.b - segment.a).normalized();
    segment.line = static_cast<Index>(random_() % 20);
    segment.arc = uniform(-2, 2);
    segment.family = random_() % 2 == 0 ? LineFamily::minimum : LineFamily::maximum;
    index_.insert(face, segment);
    all_.push_back(segment);
  }

  void remove_last(std::size_t count) {
    index_.remove_last(count);
    all_.resize(all_.size() - count);
  }

  ProximityQuery random_query(double largest_radius) {
    ProximityQuery query;
    query.face = random_face();
    query.point = point_in(query.face);
    query.direction = (point_in(query.face) - query.point).normalized();
    query.radius = uniform(0.01, largest_radius);
    query.distance = uniform(0.2, 1) * query.radius;
    query.family = random_() % 2 == 0 ? LineFamily::minimum : LineFamily::maximum;
    query.by_family = random_() % 2 == 0;
    query.own_line = static_cast<Index>(random_() % 20);
    query.own_arc = uniform(-2, 2);
    query.own_skip = uniform(0, 0.5);
    return query;
  }

  /// The nearest segment that counts, over all of them; nothing where none is close enough.
  [[nodiscard]] std::optional<LineSegment> nearest(const ProximityQuery& query) const {
    std::optional<LineSegment> best;
    double best_distance = query.distance;
    for (const LineSegment& s : all_) {
      const double way = std::abs(s.arc - query.own_arc) - (s.b - s.a).norm() / 2;
      if (s.line == query.own_line && way < query.own_skip) continue;
      const bool alike = query.by_family
                             ? s.family == query.family
                             : std::abs(s.direction.dot(query.direction)) > std::cos(M_PI / 4);
      if (!alike || distance_to(s, query.point) >= best_distance) continue;
      best_distance = distance_to(s, query.point);
      best = s;
    }
    return best;
  }

  /// Compares many queries with the list. \return how many found a conflict
  int compare(int queries, double largest_radius) {
    int conflicts = 0;
    for (int i = 0; i < queries; ++i) {
      const ProximityQuery query = random_query(largest_radius);
      const ProximityHit hit = index_.query(query);
      const std::optional<LineSegment> expected = nearest(query);
      EXPECT_EQ(hit.conflict, expected.has_value());
      EXPECT_TRUE(index_.in_cell(query.face));
      if (!hit.conflict || !expected) continue;
      ++conflicts;
      EXPECT_NEAR(hit.distance, distance_to(*expected, query.point), 1e-12);
      EXPECT_EQ(hit.line, expected->line);
    }
    return conflicts;
  }

 private:
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  Index random_face() { return static_cast<Index>(random_() % mesh_.face_count()); }
  Vec3 point_in(Index face) {
    std::exponential_distribution<double> exponential;
    const Vec3 b(exponential(random_), exponential(random_), exponential(random_));
    const auto& f = mesh_.faces[face];
    return (b[0] * mesh_.positions[f[0]] + b[1] * mesh_.positions[f[1]] +
            b[2] * mesh_.positions[f[2]]) /
           b.sum();
  }

  const TriMesh& mesh_;
  std::vector<std::uint8_t> barriers_;
  ProximityIndex index_;
  std::mt19937_64 random_;
  std::vector<LineSegment> all_;
};

// On a convex surface every face within reach in space is within reach over the surface: what a
// ball cuts out of it is connected.

TEST(Proximity, AgreesWithBruteForceOnAPlane) {
  const TriMesh mesh = sample_mesh(SampleKind::plane, 600, 1);
  RandomSegments segments(mesh, 300, 1);
  EXPECT_GT(segments.compare(3000, 0.4), 500);
}

TEST(Proximity, AgreesWithBruteForceOnASphere) {
  const TriMesh mesh = sample_mesh(SampleKind::sphere, 600, 1);
  RandomSegments segments(mesh, 300, 2);
  EXPECT_GT(segments.compare(3000, 0.6), 500);
}

TEST(Proximity, ForgetsWhatIsTakenBack) {
  const TriMesh mesh = sample_mesh(SampleKind::plane, 600, 1);
  RandomSegments segments(mesh, 100, 3);
  for (int i = 0; i < 60; ++i) segments.add();
  segments.remove_last(60);
  EXPECT_EQ(segments.index().segment_count(), 100);
  EXPECT_GT(segments.compare(500, 0.4), 50);
  for (int i = 0; i < 40; ++i) segments.add();
  EXPECT_GT(segments.compare(500, 0.4), 50);
}

/// A strip along x that turns back over itself at x = 1: two sheets, `gap` apart, joined at the
/// end.
TriMesh hairpin(double gap) {
  constexpr Index kCells = 20;
  PolyMesh soup;
  const auto add_row = [&](double x, double z) {
    for (const double y : {-0.1, 0.0, 0.1}) soup.positions.emplace_back(x, y, z);
  };
  for (Index i = 0; i <= kCells; ++i) add_row(double(i) / kCells, 0);
  for (Index i = kCells; i >= 0; --i) add_row(double(i) / kCells, gap);
  for (Index i = 0; i < 2 * kCells + 1; ++i) {
    for (Index j = 0; j < 2; ++j) {
      const Index v = 3 * i + j;
      soup.add_face(std::array<Index, 3>{v, v + 3, v + 4});
      soup.add_face(std::array<Index, 3>{v, v + 4, v + 1});
    }
  }
  return support::plain_tri_mesh(soup);
}

Index face_at(const TriMesh& mesh, const Vec3& point) {
  Index best = kNone;
  double least = 1e30;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const auto& c = mesh.faces[f];
    const Vec3 middle = (mesh.positions[c[0]] + mesh.positions[c[1]] + mesh.positions[c[2]]) / 3;
    if ((middle - point).norm() < least) {
      least = (middle - point).norm();
      best = f;
    }
  }
  return best;
}

LineSegment segment_along_y(const Vec3& middle) {
  LineSegment segment;
  segment.a = middle - 0.01 * Vec3::UnitY();
  segment.b = middle + 0.01 * Vec3::UnitY();
  segment.direction = Vec3::UnitY();
  segment.line = 1;
  return segment;
}

ProximityQuery query_along_y(const TriMesh& mesh, const Vec3& point) {
  ProximityQuery query;
  query.face = face_at(mesh, point);
  query.point = point;
  query.direction = Vec3::UnitY();
  query.radius = 0.2;
  query.distance = 0.2;
  query.own_line = 0;
  return query;
}

TEST(Proximity, ReachesOverTheSurfaceAndNeverThroughSpace) {
  const double gap = 0.01;
  const TriMesh mesh = hairpin(gap);
  const std::vector<std::uint8_t> barriers(mesh.halfedge_count(), 0);
  ProximityIndex index(mesh, barriers);
  const Vec3 far(0.3, 0, gap);  // on the upper sheet, 1.4 away over the surface
  index.insert(face_at(mesh, far), segment_along_y(far));
  EXPECT_FALSE(index.query(query_along_y(mesh, Vec3(0.3, 0, 0))).conflict);
  EXPECT_TRUE(index.query(query_along_y(mesh, Vec3(0.35, 0, gap))).conflict);
  const Vec3 round_the_bend(0.97, 0, gap);
  index.insert(face_at(mesh, round_the_bend), segment_along_y(round_the_bend));
  const ProximityHit hit = index.query(query_along_y(mesh, Vec3(0.95, 0, 0)));
  EXPECT_TRUE(hit.conflict) << "over the end the way is short";
}

/// Marks the edges across a flat strip at x = where as barriers, on both sides.
std::vector<std::uint8_t> wall(const TriMesh& mesh, double where) {
  std::vector<std::uint8_t> barriers(mesh.halfedge_count(), 0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    const Vec3& a = mesh.positions[mesh.from(h)];
    const Vec3& b = mesh.positions[mesh.to(h)];
    if (std::abs(a.x() - where) < 1e-9 && std::abs(b.x() - where) < 1e-9 && a.z() == 0 &&
        b.z() == 0) {
      barriers[h] = 1;
      if (mesh.twin[h] != kNone) barriers[mesh.twin[h]] = 1;
    }
  }
  return barriers;
}

TEST(Proximity, EndsAtBarriersWhichCountAsLines) {
  const TriMesh mesh = hairpin(0.5);
  const std::vector<std::uint8_t> barriers = wall(mesh, 0.5);
  ProximityIndex index(mesh, barriers);
  const Vec3 beyond(0.52, 0, 0);
  index.insert(face_at(mesh, beyond), segment_along_y(beyond));
  ProximityQuery query = query_along_y(mesh, Vec3(0.44, 0.02, 0));
  const ProximityHit wall_hit = index.query(query);
  EXPECT_TRUE(wall_hit.conflict);
  EXPECT_EQ(wall_hit.line, kNone);
  EXPECT_NEAR(wall_hit.distance, 0.06, 1e-12);
  query.ignore_barriers = true;
  EXPECT_FALSE(index.query(query).conflict) << "nothing is seen across it all the same";
  query.ignore_barriers = false;
  query.direction = Vec3::UnitX();
  EXPECT_FALSE(index.query(query).conflict) << "a line that meets it at a right angle goes on";
  query = query_along_y(mesh, Vec3(0.56, 0, 0));
  EXPECT_NEAR(index.query(query).distance, 0.04, 1e-12) << "on its own side the segment counts";
}

}  // namespace
}  // namespace strake
