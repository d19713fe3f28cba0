#include "stages/trace/proximity.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <set>

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

/// Wanted distances that are the same everywhere.
Spacing even_spacing(const TriMesh& mesh, double distance) {
  Spacing spacing;
  spacing.along.assign(mesh.wedge_count(), distance);
  spacing.across.assign(mesh.wedge_count(), distance);
  return spacing;
}

/// An index with random segments, some of them of a line being traced, and the same in plain lists.
class RandomSegments {
 public:
  /// \param distance  of lines, on which the size of blocks depends
  RandomSegments(const TriMesh& mesh, double distance, int count, std::uint64_t seed)
      : mesh_(mesh),
        barriers_(mesh.halfedge_count(), 0),
        blocks_(mesh, even_spacing(mesh, distance), barriers_),
        index_(blocks_, barriers_),
        probe_(index_),
        random_(seed) {
    for (int i = 0; i < count; ++i) add();
  }

  ProximityProbe& probe() { return probe_; }

  /// Adds a finished segment.
  void add() {
    all_.push_back({random_segment(), 0});
    all_.back().segment.line = static_cast<Index>(random_() % 20);
    index_.insert({&all_.back().segment, 1}, all_.back().segment.line);
  }
  /// Adds one to the line that looks around.
  void record() {
    own_.push_back({random_segment(), uniform(-2, 2)});
    probe_.record(own_.back().segment, own_.back().arc);
  }
  void shrink(std::size_t count) {
    probe_.shrink(count);
    own_.resize(count);
  }

  ProximityQuery random_query(double largest_distance) {
    ProximityQuery query;
    query.face = random_face();
    query.point = point_in(query.face);
    query.direction = (point_in(query.face) - query.point).normalized();
    query.distance = uniform(0.01, largest_distance);
    query.family = random_() % 2 == 0 ? LineFamily::minimum : LineFamily::maximum;
    query.by_family = random_() % 2 == 0;
    query.own_arc = uniform(-2, 2);
    query.own_skip = uniform(0, 0.5);
    return query;
  }

  /// The nearest segment that counts, over all of them; nothing where none is close enough.
  [[nodiscard]] std::optional<LineSegment> nearest(const ProximityQuery& query) const {
    std::optional<LineSegment> best;
    double best_distance = query.distance;
    const auto consider = [&](const LineSegment& s) {
      const bool alike = query.by_family
                             ? s.family == query.family
                             : std::abs(s.direction.dot(query.direction)) > std::cos(M_PI / 4);
      if (!alike || distance_to(s, query.point) >= best_distance) return;
      best_distance = distance_to(s, query.point);
      best = s;
    };
    for (const Placed& placed : all_) consider(placed.segment);
    for (const auto& [s, arc] : own_) {
      if (std::abs(arc - query.own_arc) - (s.b - s.a).norm() / 2 >= query.own_skip) consider(s);
    }
    return best;
  }

  /// Compares many queries with the list. \return how many found a conflict
  int compare(int queries, double largest_distance) {
    int conflicts = 0;
    for (int i = 0; i < queries; ++i) {
      const ProximityQuery query = random_query(largest_distance);
      const ProximityHit hit = probe_.query(query);
      const std::optional<LineSegment> expected = nearest(query);
      EXPECT_EQ(hit.conflict, expected.has_value());
      if (!hit.conflict || !expected) continue;
      ++conflicts;
      EXPECT_NEAR(hit.distance, distance_to(*expected, query.point), 1e-12);
      EXPECT_EQ(hit.line, expected->line);
    }
    return conflicts;
  }

 private:
  struct Placed {
    LineSegment segment;
    double arc;
  };

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  Index random_face() { return static_cast<Index>(random_() % mesh_.face_count()); }
  LineSegment random_segment() {
    LineSegment segment;
    segment.face = random_face();
    segment.a = point_in(segment.face);
    segment.b = point_in(segment.face);
    segment.direction = (segment.b - segment.a).normalized();
    segment.family = random_() % 2 == 0 ? LineFamily::minimum : LineFamily::maximum;
    return segment;
  }
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
  FaceBlocks blocks_;
  ProximityIndex index_;
  ProximityProbe probe_;
  std::mt19937_64 random_;
  std::vector<Placed> all_;
  std::vector<Placed> own_;
};

// On a convex surface every face within reach in space is within reach over the surface: what a
// ball cuts out of it is connected.

TEST(Proximity, AgreesWithBruteForceOnAPlane) {
  const TriMesh mesh = sample_mesh(SampleKind::plane, 600, 1);
  for (const double distance : {0.01, 0.3, 1.0}) {
    RandomSegments segments(mesh, distance, 300, 1);
    EXPECT_GT(segments.compare(2000, 0.4), 500);
  }
}

TEST(Proximity, AgreesWithBruteForceOnASphere) {
  const TriMesh mesh = sample_mesh(SampleKind::sphere, 600, 1);
  for (const double distance : {0.01, 0.4, 1.5}) {
    RandomSegments segments(mesh, distance, 300, 2);
    EXPECT_GT(segments.compare(2000, 0.6), 500);
  }
}

TEST(Proximity, SeesItsOwnLineAndForgetsWhatIsTakenBack) {
  const TriMesh mesh = sample_mesh(SampleKind::plane, 600, 1);
  RandomSegments segments(mesh, 0.3, 40, 3);
  for (int i = 0; i < 160; ++i) segments.record();
  EXPECT_GT(segments.compare(500, 0.4), 50);
  segments.shrink(60);
  EXPECT_EQ(segments.probe().recorded().size(), 60);
  EXPECT_GT(segments.compare(500, 0.4), 50);
  for (int i = 0; i < 40; ++i) segments.record();
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

LineSegment segment_along_y(const TriMesh& mesh, const Vec3& middle) {
  LineSegment segment;
  segment.face = face_at(mesh, middle);
  segment.a = middle - 0.01 * Vec3::UnitY();
  segment.b = middle + 0.01 * Vec3::UnitY();
  segment.direction = Vec3::UnitY();
  return segment;
}

ProximityQuery query_along_y(const TriMesh& mesh, const Vec3& point) {
  ProximityQuery query;
  query.face = face_at(mesh, point);
  query.point = point;
  query.direction = Vec3::UnitY();
  query.distance = 0.2;
  return query;
}

/// A hairpin with segments along y, and what a line sees there.
class Hairpin {
 public:
  Hairpin(double gap, double distance, const std::vector<std::uint8_t>& barriers)
      : mesh_(hairpin(gap)),
        barriers_(barriers),
        blocks_(mesh_, even_spacing(mesh_, distance), barriers_),
        index_(blocks_, barriers_),
        probe_(index_) {}

  void insert(const Vec3& middle) {
    const LineSegment segment = segment_along_y(mesh_, middle);
    index_.insert({&segment, 1}, 1);
  }
  ProximityHit query(const Vec3& point) { return probe_.query(query_along_y(mesh_, point)); }
  ProximityHit query(const ProximityQuery& query) { return probe_.query(query); }

 private:
  TriMesh mesh_;
  std::vector<std::uint8_t> barriers_;
  FaceBlocks blocks_;
  ProximityIndex index_;
  ProximityProbe probe_;
};

TEST(Proximity, ReachesOverTheSurfaceAndNeverThroughSpace) {
  const double gap = 0.01;
  for (const double distance : {0.02, 0.2}) {  // blocks of one face, and of several
    Hairpin surface(gap, distance, std::vector<std::uint8_t>(hairpin(gap).halfedge_count(), 0));
    surface.insert(Vec3(0.3, 0, gap));  // on the upper sheet, 1.4 away over the surface
    EXPECT_FALSE(surface.query(Vec3(0.3, 0, 0)).conflict);
    EXPECT_TRUE(surface.query(Vec3(0.35, 0, gap)).conflict);
    surface.insert(Vec3(0.97, 0, gap));
    EXPECT_TRUE(surface.query(Vec3(0.95, 0, 0)).conflict) << "over the end the way is short";
  }
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
  for (const double distance : {0.02, 0.2, 1.0}) {
    Hairpin surface(0.5, distance, wall(mesh, 0.5));
    surface.insert(Vec3(0.52, 0, 0));
    ProximityQuery query = query_along_y(mesh, Vec3(0.44, 0.02, 0));
    const ProximityHit wall_hit = surface.query(query);
    EXPECT_TRUE(wall_hit.conflict);
    EXPECT_EQ(wall_hit.line, kNone);
    EXPECT_NEAR(wall_hit.distance, 0.06, 1e-12);
    query.ignore_barriers = true;
    EXPECT_FALSE(surface.query(query).conflict) << "nothing is seen across it all the same";
    query.ignore_barriers = false;
    query.direction = Vec3::UnitX();
    EXPECT_FALSE(surface.query(query).conflict) << "a line that meets it at a right angle goes on";
    EXPECT_NEAR(surface.query(Vec3(0.56, 0, 0)).distance, 0.04, 1e-12)
        << "on its own side the segment counts";
  }
}

// What each block is for: it holds together, is small, and ends at barriers.
TEST(FaceBlocks, DivideAMeshIntoSmallConnectedPieces) {
  const TriMesh mesh = hairpin(0.5);
  const std::vector<std::uint8_t> barriers = wall(mesh, 0.5);
  for (const double distance : {0.02, 0.2, 0.6}) {
    const FaceBlocks blocks(mesh, even_spacing(mesh, distance), barriers);
    std::vector<int> seen(mesh.face_count(), 0);
    for (Index block = 0; block < blocks.count(); ++block) {
      std::set<Index> left(blocks.faces(block).begin(), blocks.faces(block).end());
      std::vector<Index> reached = {*left.begin()};
      left.erase(left.begin());
      while (!reached.empty()) {
        const Index f = reached.back();
        reached.pop_back();
        ++seen[f];
        EXPECT_EQ(blocks.block_of(f), block);
        for (Index h = 3 * f; h < 3 * f + 3; ++h) {
          if (barriers[h] != 0 || mesh.twin[h] == kNone) continue;
          const Index other = TriMesh::face_of(mesh.twin[h]);
          if (left.erase(other) > 0) reached.push_back(other);
        }
      }
      EXPECT_TRUE(left.empty()) << "connected without crossing the wall";
    }
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), mesh.face_count());
    EXPECT_EQ(blocks.count() < mesh.face_count() / 2, distance > 0.1);
  }
}

}  // namespace
}  // namespace strake
