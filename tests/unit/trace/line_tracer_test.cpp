#include "stages/trace/line_tracer.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include "common/geometry/line_chord.h"
#include "common/geometry/mesh_measures.h"
#include "tests/support/mesh_support.h"
#include "tests/unit/trace/fields.h"

namespace strake {
namespace {

/// Finished lines, and a tracer that adds to them.
class Lines {
 public:
  Lines(const TraceDomain& domain, const std::vector<std::uint8_t>& barriers,
        const TracerSettings& settings = {})
      : finished_(domain, barriers), tracer_(domain, barriers, settings, finished_) {}

  LineDraft trace(const Seed& seed) {
    LineDraft draft = tracer_.trace(seed);
    finished_.add(draft, count_);
    count_ += draft.is_line ? 1 : 0;
    return draft;
  }
  [[nodiscard]] const ProximityIndex& proximity() const { return finished_.proximity(); }

 private:
  FinishedLines finished_;
  LineTracer tracer_;
  Index count_ = 0;
};

/// A plane with lines along x and y at constant distances.
class LinesOnAPlane : public ::testing::Test {
 protected:
  LinesOnAPlane() {
    turn_crosses(field_, 1);  // the arms' names must not matter
    spacing_.along.assign(mesh_.wedge_count(), kSpacing);
    spacing_.across.assign(mesh_.wedge_count(), kSpacing);
    for (Index h = 0; h < mesh_.halfedge_count(); ++h) barriers_.push_back(mesh_.is_boundary(h));
  }

  Seed seed_at(double x, double y, const Vec3& direction) const {
    for (Index f = 0; f < mesh_.face_count(); ++f) {
      const Vec3 b = field_context(domain_, f)
                         .chart.barycentric(
                             chart_direction(domain_, field_context(domain_, f),
                                             Vec3(x, y, 0) - mesh_.positions[mesh_.faces[f][0]]));
      if (b.minCoeff() >= 0) return {f, b, direction, {}};
    }
    throw std::logic_error("no such point");
  }

  static constexpr double kSpacing = 0.2;
  TriMesh mesh_ = sample_mesh(SampleKind::plane, 3000, 0.8);
  PrincipalField field_ = field_along(mesh_, [](const Vec3&) { return Vec3::UnitX(); });
  Spacing spacing_;
  TraceDomain domain_{mesh_, field_, spacing_, FaceNormals(mesh_)};
  std::vector<std::uint8_t> barriers_;
};

TEST_F(LinesOnAPlane, AreStraightFromBoundaryToBoundary) {
  Lines lines(domain_, barriers_);
  const LineDraft draft = lines.trace(seed_at(0.13, 0.21, Vec3(0.9, 0.3, 0)));
  ASSERT_TRUE(draft.is_line);
  const TracedLine& line = draft.line;
  EXPECT_EQ(line.start_reason, LineEnd::boundary);
  EXPECT_EQ(line.end_reason, LineEnd::boundary);
  // Crossings within a thousandth of an edge of a vertex go through the vertex.
  const double tolerance = 2e-3 * 2.0 / std::sqrt(3000.0 / 4);
  for (std::size_t i = 0; i < line.points.size(); ++i) {
    const Vec3 p = line_point_position(mesh_, line.points[i]);
    EXPECT_NEAR(p.y(), 0.21, 20 * tolerance);
    if (i > 0) {
      const Vec3 q = line_point_position(mesh_, line.points[i - 1]);
      EXPECT_GT(p.x(), q.x()) << "forwards all the way";
      EXPECT_TRUE(
          is_proper_chord(mesh_, line.chord_face[i - 1], line.points[i - 1], line.points[i]));
    }
  }
  EXPECT_NEAR(line_point_position(mesh_, line.points.front()).x(), -kPlaneHalfSize, 1e-12);
  EXPECT_NEAR(line_point_position(mesh_, line.points.back()).x(), kPlaneHalfSize, 1e-12);
}

TEST_F(LinesOnAPlane, SpawnCrossingLinesAtTheirDistance) {
  Lines lines(domain_, barriers_);
  const LineDraft draft = lines.trace(seed_at(0, 0, Vec3::UnitX()));
  ASSERT_TRUE(draft.is_line);
  std::vector<double> at;
  for (const Seed& seed : draft.spawned) {
    EXPECT_NEAR(std::abs(seed.direction.normalized().y()), 1, 1e-9);
    Vec3 p = Vec3::Zero();
    for (int i = 0; i < 3; ++i) {
      p += seed.barycentric[i] * mesh_.positions[mesh_.faces[seed.face][i]];
    }
    at.push_back(p.x());
  }
  std::sort(at.begin(), at.end());
  ASSERT_GT(at.size(), 6);
  const double step = kSpacing / 4;  // seeds lie at ends of integration steps
  // What passes within a thousandth of an edge from a vertex goes through it.
  const double leeway = step + 1e-3 * 2 * support::mean_edge_length(mesh_);
  for (const double x : at) {
    EXPECT_NEAR(x / kSpacing, std::round(x / kSpacing), leeway / kSpacing);
  }
  // One per distance, from the seed to the boundary on both sides.
  EXPECT_NEAR(at.front(), -kPlaneHalfSize, 1.3 * kSpacing);
  EXPECT_NEAR(at.back(), kPlaneHalfSize, 1.3 * kSpacing);
}

TEST_F(LinesOnAPlane, GoStraightThroughTheEdgeTheyAreAnchoredTo) {
  int tried = 0;
  for (Index h = 0; h < mesh_.halfedge_count(); h += 31) {
    const Vec3& a = mesh_.positions[mesh_.from(h)];
    const Vec3& b = mesh_.positions[mesh_.to(h)];
    const Vec3 edge = (b - a).normalized();
    if (mesh_.is_boundary(h) || a.cwiseAbs().maxCoeff() > 0.6 || std::abs(edge.y()) < 0.8) continue;
    ++tried;
    const Seed seed{TriMesh::face_of(h), Vec3::Constant(1.0 / 3), Vec3::UnitZ().cross(edge),
                    LinePoint{h, 0.2}};
    const double y = line_point_position(mesh_, seed.anchor).y();
    Lines lines(domain_, barriers_);
    const LineDraft draft = lines.trace(seed);
    ASSERT_TRUE(draft.is_line);
    const TracedLine& line = draft.line;
    EXPECT_EQ(line.start_reason, LineEnd::boundary);
    EXPECT_EQ(line.end_reason, LineEnd::boundary);
    for (const LinePoint& p : line.points) {
      EXPECT_NEAR(line_point_position(mesh_, p).y(), y, 0.01);
    }
    for (std::size_t i = 1; i < line.points.size(); ++i) {
      EXPECT_TRUE(
          is_proper_chord(mesh_, line.chord_face[i - 1], line.points[i - 1], line.points[i]));
    }
  }
  EXPECT_GT(tried, 10);
}

TEST_F(LinesOnAPlane, KeepTheirDistanceFromEachOther) {
  const TracerSettings settings;
  Lines lines(domain_, barriers_, settings);
  const auto traces = [&](double x, double y, const Vec3& direction) {
    return lines.trace(seed_at(x, y, direction)).is_line;
  };
  const Vec3 x = Vec3::UnitX();
  EXPECT_TRUE(traces(0, 0.05, x));
  EXPECT_FALSE(traces(0.3, 0.05, -x)) << "there is one already";
  EXPECT_FALSE(traces(0.3, 0.05 + 0.9 * settings.seed_fraction * kSpacing, x)) << "too close";
  EXPECT_TRUE(traces(0.3, 0.05 + 1.1 * settings.seed_fraction * kSpacing, x));
  EXPECT_TRUE(traces(0.3, 0.05, Vec3::UnitY())) << "lines across it do not matter";
  EXPECT_FALSE(traces(0, kPlaneHalfSize - 0.5 * kSpacing, x)) << "the boundary counts as a line";
  EXPECT_TRUE(traces(0, -kPlaneHalfSize + 1.1 * kSpacing, x));
}

TEST_F(LinesOnAPlane, LeaveNothingWhereTheyAreRefused) {
  Lines lines(domain_, barriers_);
  ASSERT_TRUE(lines.trace(seed_at(0, 0, Vec3::UnitX())).is_line);
  const Index before = lines.proximity().segment_count();
  const LineDraft refused = lines.trace(seed_at(0.1, 0.02, Vec3::UnitX()));
  EXPECT_FALSE(refused.is_line);
  EXPECT_TRUE(refused.spawned.empty());
  EXPECT_EQ(lines.proximity().segment_count(), before);
}

/// Circles on irregular triangles: on the way they turn back over edges and pass vertices, and come
/// home by any edge.
TEST_F(LinesOnAPlane, CloseWhereTheFieldGoesAround) {
  field_ = field_along(mesh_, [](const Vec3& p) { return Vec3(-p.y(), p.x(), 0); });
  const double edge = support::mean_edge_length(mesh_);
  for (int i = 0; i < 300; ++i) {
    const double radius = 0.4 + 0.4 * i / 300;
    const double angle = 2.4 * i;  // the golden angle: all around
    const Vec3 p = radius * Vec3(std::cos(angle), std::sin(angle), 0);
    Lines lines(domain_, barriers_);
    const LineDraft draft = lines.trace(seed_at(p.x(), p.y(), Vec3(-p.y(), p.x(), 0)));
    ASSERT_TRUE(draft.is_line);
    const TracedLine& line = draft.line;
    EXPECT_EQ(line.start_reason, LineEnd::closed) << "circle " << i;
    EXPECT_EQ(line.end_reason, LineEnd::closed) << "circle " << i;
    const std::size_t count = line.points.size();
    for (std::size_t k = 0; k < count; ++k) {
      EXPECT_TRUE(
          is_proper_chord(mesh_, line.chord_face[k], line.points[k], line.points[(k + 1) % count]))
          << "circle " << i << ", chord " << k;
      EXPECT_NEAR(line_point_position(mesh_, line.points[k]).norm(), radius, edge);
    }
  }
}

/// Lines y = c w(x) of a strip that narrows to a share of its width at x = 0: a line a wanted
/// distance beside the middle one goes through where the narrows are wide enough, and stops before
/// them where they are not.
TEST_F(LinesOnAPlane, PassNarrowsWhereTheyGetOutAgain) {
  const TracerSettings settings;
  for (const double narrowest : {0.42, 0.2}) {
    SCOPED_TRACE(narrowest);
    const double depth = 1 - narrowest;
    const auto width = [&](double x) { return 1 - depth * std::exp(-20 * x * x); };
    field_ = field_along(mesh_, [&](const Vec3& p) {
      const double slope = 40 * p.x() * depth * std::exp(-20 * p.x() * p.x());
      return Vec3(1, p.y() * slope / width(p.x()), 0);
    });
    ASSERT_LT(narrowest, settings.stop_fraction);
    Lines lines(domain_, barriers_, settings);
    ASSERT_TRUE(lines.trace(seed_at(-0.9, 0, Vec3::UnitX())).is_line);
    const LineDraft draft = lines.trace(seed_at(-0.9, kSpacing, Vec3::UnitX()));
    ASSERT_TRUE(draft.is_line);
    const TracedLine& line = draft.line;
    EXPECT_EQ(line.start_reason, LineEnd::boundary);
    const double end = line_point_position(mesh_, line.points.back()).x();
    if (narrowest > settings.narrow_fraction) {
      EXPECT_EQ(line.end_reason, LineEnd::boundary);
      EXPECT_NEAR(end, kPlaneHalfSize, 1e-12);
    } else {
      EXPECT_EQ(line.end_reason, LineEnd::proximity);
      EXPECT_LT(end, 0);
      // It looks after each step, and ends at the last edge before the place: a step of leeway on
      // one side, an edge and a step on the other.
      const double step = kSpacing / 4;
      const double leeway = 2 * support::mean_edge_length(mesh_) + step;
      EXPECT_GT(width(end - step), settings.stop_fraction - 0.05);
      EXPECT_LT(width(end + leeway), settings.stop_fraction + 0.05);
    }
  }
}

/// The line from a seed, where others would be so far apart and there is none.
TracedLine only_line(const TriMesh& mesh, const PrincipalField& field, double distance,
                     const Seed& seed) {
  Spacing spacing;
  spacing.along.assign(mesh.wedge_count(), distance);
  spacing.across.assign(mesh.wedge_count(), distance);
  const TraceDomain domain{mesh, field, spacing, FaceNormals(mesh)};
  std::vector<std::uint8_t> barriers(static_cast<std::size_t>(mesh.halfedge_count()), 0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) barriers[h] = mesh.is_boundary(h);
  return Lines(domain, barriers).trace(seed).line;
}

// A helix of gentle slope on a cylinder that is thinner than the distance of lines: what is left of
// it is not even two windings long, where it would have forty.
TEST(LineTracer, DoesNotWindAroundWhatIsThinnerThanTheDistanceOfLines) {
  TriMesh mesh = sample_mesh(SampleKind::open_cylinder, 3000, 0.8);
  for (Vec3& p : mesh.positions) p.z() *= 100;  // keeps the ends out of the way
  const double slope = 5 / (2 * M_PI);
  const PrincipalField field =
      field_along(mesh, [&](const Vec3& p) { return Vec3(-p.y(), p.x(), slope).normalized(); });
  Seed seed;
  seed.face = mesh.face_count() / 2;
  seed.direction = field.cross[mesh.face_wedges[seed.face][0]];
  const TracedLine line = only_line(mesh, field, 10, seed);
  double length = 0;
  for (std::size_t i = 1; i < line.points.size(); ++i) {
    length +=
        (line_point_position(mesh, line.points[i]) - line_point_position(mesh, line.points[i - 1]))
            .norm();
  }
  EXPECT_LT(length, 4 * M_PI);
}

// The same around the end of a long needle: a crossing is kept a thousandth of its edge away from
// vertices, here thousands of times farther than the needle is around.
TEST(LineTracer, DoesNotWindAroundTheTipOfANeedle) {
  constexpr Index kSides = 6;
  constexpr double kRadius = 0.01;
  PolyMesh needle;
  for (const double length : {0.0, 1e5}) {
    for (Index i = 0; i < kSides; ++i) {
      const double angle = 2 * M_PI * i / kSides;
      const double z = i % 2 == 0 ? length : 10 * length;
      needle.positions.emplace_back(kRadius * std::cos(angle), kRadius * std::sin(angle), z);
    }
  }
  needle.positions.emplace_back(0, 0, -kRadius);
  for (Index i = 0; i < kSides; ++i) {
    const Index next = (i + 1) % kSides;
    needle.add_face(std::array<Index, 3>{i, next, next + kSides});
    needle.add_face(std::array<Index, 3>{i, next + kSides, i + kSides});
    needle.add_face(std::array<Index, 3>{next, i, 2 * kSides});
  }
  const TriMesh mesh = support::plain_tri_mesh(needle);
  const PrincipalField field =
      field_along(mesh, [](const Vec3& p) { return Vec3(-p.y(), p.x(), 1e-3).normalized(); });
  Seed seed;
  seed.face = 0;
  seed.barycentric = Vec3(0.5, 0.5 - 1e-5, 1e-5);
  seed.direction = field.cross[mesh.face_wedges[0][0]];
  EXPECT_LT(only_line(mesh, field, 100, seed).points.size(), 4 * 2 * kSides);
}

// However little there is of the tube for the distance of lines: seen from where a ring has come
// too near to its start, that lies up to a quarter turn round the corner.
TEST(LineTracer, ClosesRingsAroundThinTubes) {
  TriMesh mesh = sample_mesh(SampleKind::open_cylinder, 3000, 0.8);
  for (Vec3& p : mesh.positions) p.z() *= 5;  // keeps the ends out of the way
  const PrincipalField field =
      field_along(mesh, [](const Vec3& p) { return Vec3(-p.y(), p.x(), 0).normalized(); });
  const auto height = [&](Index f) { return std::abs(mesh.positions[mesh.faces[f][0]].z()); };
  Seed seed;
  seed.face = 0;
  for (Index f = 1; f < mesh.face_count(); ++f) {
    if (height(f) < height(seed.face)) seed.face = f;
  }
  seed.direction = field.cross[mesh.face_wedges[seed.face][0]];
  for (double distance = 0.5; distance < 3; distance += 0.05) {  // steps end anywhere
    const TracedLine line = only_line(mesh, field, distance, seed);
    EXPECT_EQ(line.end_reason, LineEnd::closed) << "2 pi around, lines " << distance << " apart";
  }
}

/// A plane of triangles, and a feature along an axis with a gap from -`half_gap` to it.
class FeaturesInARow {
 public:
  /// \param roughness  by which vertices are off a grid, in its steps; at 0 the gap has edges along
  /// it
  /// \param turn  of the axis, radians: else what lies on an edge does so exactly
  FeaturesInARow(double half_gap, double roughness, double turn) {
    constexpr Index kSide = 21;
    constexpr double kStep = 0.1;
    PolyMesh soup;
    std::mt19937 random(5);
    std::uniform_real_distribution<double> jitter(-roughness * kStep, roughness * kStep);
    for (Index j = 0; j < kSide; ++j) {
      for (Index i = 0; i < kSide; ++i) {
        const double x = kStep * (i - kSide / 2);
        const double y = kStep * (j - kSide / 2);
        const bool is_free = j != kSide / 2 || std::abs(x) < half_gap - kStep / 2;
        soup.positions.emplace_back(x + (is_free ? jitter(random) : 0),
                                    y + (is_free ? jitter(random) : 0), 0);
      }
    }
    for (Index j = 0; j + 1 < kSide; ++j) {
      for (Index i = 0; i + 1 < kSide; ++i) {
        const Index v = j * kSide + i;
        soup.add_face(std::array<Index, 3>{v, v + 1, v + kSide + 1});
        soup.add_face(std::array<Index, 3>{v, v + kSide + 1, v + kSide});
      }
    }
    mesh = support::plain_tri_mesh(soup);
    const Vec3 ahead = Vec3(1, 0.02, 0).normalized();
    const auto has_on_left = [](const Vec3& way, const Vec3& other) {
      return way.cross(other).z() > 0;
    };
    barriers.assign(mesh.halfedge_count(), 0);
    for (Index h = 0; h < mesh.halfedge_count(); ++h) {
      const Vec3 a = mesh.positions[mesh.from(h)] + mesh.origin;
      const Vec3 b = mesh.positions[mesh.to(h)] + mesh.origin;
      const auto is_on_it = [&](const Vec3& p) {
        return p.y() == 0 && std::abs(p.x()) > half_gap - kStep / 2;
      };
      if (is_on_it(a) && is_on_it(b)) mesh.is_feature[h] = barriers[h] = 1;
      if (mesh.is_boundary(h)) barriers[h] = 1;
      if (!is_on_it(a) || std::abs(a.x()) > half_gap + kStep / 2) continue;
      mesh.is_corner[mesh.from(h)] = 1;
      if (a.x() > 0) {
        right = mesh.from(h);
      } else if (has_on_left(b - a, ahead) &&
                 has_on_left(ahead,
                             mesh.positions[mesh.from(TriMesh::prev(h))] + mesh.origin - a)) {
        start.anchor = {h, 0};
        start.face = TriMesh::face_of(h);
      }
    }
    const Eigen::AngleAxisd turned(turn, Vec3::UnitZ());
    for (Vec3& p : mesh.positions) p = turned * p;
    start.direction = turned * ahead;
    axis = turned * Vec3::UnitX();
  }

  TriMesh mesh;
  std::vector<std::uint8_t> barriers;
  Index right = kNone;  ///< the corner on the right of the gap
  Seed start;           ///< at the left one
  Vec3 axis;
};

/// The line that starts at the corner left of the gap, where others would be so far apart.
TracedLine line_over_the_gap(const FeaturesInARow& row, double distance) {
  const PrincipalField field = field_along(row.mesh, [&](const Vec3&) { return row.axis; });
  Spacing spacing;
  spacing.along.assign(row.mesh.wedge_count(), distance);
  spacing.across.assign(row.mesh.wedge_count(), distance);
  const TraceDomain domain{row.mesh, field, spacing, FaceNormals(row.mesh)};
  const LineDraft draft = Lines(domain, row.barriers).trace(row.start);
  EXPECT_TRUE(draft.is_line);
  for (std::size_t i = 1; i < draft.line.points.size(); ++i) {
    EXPECT_TRUE(is_proper_chord(row.mesh, draft.line.chord_face[i - 1], draft.line.points[i - 1],
                                draft.line.points[i]));
  }
  return draft.line;
}

// A feature straight ahead is alike, but a line that leads to its end is no line beside it.
TEST(LineTracer, MeetsTheCornerAheadOfIt) {
  for (const double half_gap : {0.2, 0.3, 0.5}) {
    const FeaturesInARow row(half_gap, 0.3, 0);
    for (const double distance : {0.3, 0.6, 1.2}) {
      SCOPED_TRACE(testing::Message() << "gap " << 2 * half_gap << ", lines " << distance);
      const LinePoint end = line_over_the_gap(row, distance).points.back();
      EXPECT_TRUE(is_vertex_point(end));
      EXPECT_EQ(row.mesh.from(end.halfedge), row.right);
    }
  }
}

// As between windows in a row: rounding has the line leave its first face by that edge.
TEST(LineTracer, LeavesACornerAlongAnEdge) {
  for (const double turn : {0.0, 0.1, 0.4, 1.0, 2.0}) {
    const FeaturesInARow row(0.5, 0, turn);
    const TracedLine line = line_over_the_gap(row, 0.3);
    ASSERT_FALSE(line.points.empty());
    EXPECT_GT((line_point_position(row.mesh, line.points.back()) -
               line_point_position(row.mesh, line.points.front()))
                  .norm(),
              0.7)
        << "turned by " << turn;
  }
}

}  // namespace
}  // namespace strake
