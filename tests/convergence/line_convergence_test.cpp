// Traced lines against exact lines of curvature, through the stages as users run them.
//
// A line follows one exact line of curvature where one of two coordinates does not change along it.
// How far it strays is the range of that coordinate over the line, as a length. Directions are off
// by an angle that shrinks with the mesh; it changes sign along the way, so that strays do not add
// up: measured, no line strays by more than 0.2 edge lengths h at any resolution, the mean is
// below 0.1 h. Bounds here leave a margin of about a half.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "common/geometry/line_chord.h"
#include "tests/support/analytic_surfaces.h"
#include "tests/support/chain.h"
#include "tests/support/mesh_support.h"

namespace strake {
namespace {

constexpr double kLargestStray = 0.3;   // edge lengths
constexpr double kLargestMean = 0.15;   // edge lengths
constexpr double kUmbilicRange = 0.35;  // around the ellipsoid's umbilics lines mean nothing

struct TracedSample {
  SampleKind kind;
  support::Prepared prepared;
  LineSet lines;
  double edge = 0;  ///< mean length

  [[nodiscard]] Vec3 point(Index p) const {
    return line_point_position(prepared.mesh, lines.points[p]) + prepared.mesh.origin;
  }
  [[nodiscard]] std::vector<Vec3> course(Index line) const {
    std::vector<Vec3> points;
    for (Index p = lines.offsets[line]; p < lines.offsets[line + 1]; ++p)
      points.push_back(point(p));
    return points;
  }
  [[nodiscard]] bool is_curvature_line(Index line) const {
    return lines.family[line] == LineFamily::minimum || lines.family[line] == LineFamily::maximum;
  }
};

TracedSample traced(SampleKind kind, std::int64_t faces, std::int64_t seed = 1) {
  SampleOptions sample;
  sample.faces = faces;
  sample.seed = seed;
  const PolyMesh soup = make_sample(kind, sample);
  TracedSample result;
  result.kind = kind;
  TensorOptions tensor;  // the ball shrinks with the mesh, as convergence asks for
  result.edge = support::mean_edge_length(support::plain_tri_mesh(soup));
  tensor.radius = {2.5 * result.edge, false};
  result.prepared = support::prepare(soup, tensor);
  TraceOptions options;
  options.vertices = 800;
  options.seed = seed;
  result.lines = support::trace(result.prepared, options);
  return result;
}

/// A coordinate that is constant along exact lines of this family.
double coordinate(const support::AnalyticSurface& surface, LineFamily family, const Vec3& p) {
  const support::LineCoordinates lines = *surface.lines(p);
  return family == LineFamily::minimum ? lines.along_min : lines.along_max;
}

/// The length that one unit of the coordinate stands for, and whether it is an angle.
struct Scale {
  double length = 1;
  bool angle = false;
};

Scale scale_of(SampleKind kind, LineFamily family, const Vec3& p) {
  const bool minimum = family == LineFamily::minimum;
  if (kind == SampleKind::torus) return {minimum ? kTorusMinorRadius : p.head<2>().norm(), true};
  if (minimum) return {p.head<2>().norm(), true};
  if (kind != SampleKind::hyperboloid) return {};
  const double radius = p.head<2>().norm();  // the meridian's slope makes z shorter than its arc
  const double slope = kHyperboloidWaist * kHyperboloidWaist * p.z() /
                       (kHyperboloidSlope * kHyperboloidSlope * radius);
  return {std::sqrt(1 + slope * slope), false};
}

/// How far a line strays from the exact line through its first point, both sides together.
double stray(const TracedSample& sample, const support::AnalyticSurface& surface, Index line) {
  const LineFamily family = sample.lines.family[line];
  const std::vector<Vec3> course = sample.course(line);
  const double start = coordinate(surface, family, course.front());
  double low = 0;
  double high = 0;
  for (const Vec3& p : course) {
    const Scale scale = scale_of(sample.kind, family, p);
    double difference = coordinate(surface, family, p) - start;
    if (scale.angle) difference = std::remainder(difference, 2 * M_PI);
    low = std::min(low, scale.length * difference);
    high = std::max(high, scale.length * difference);
  }
  return high - low;
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

class LineConvergence : public ::testing::TestWithParam<SampleKind> {};

INSTANTIATE_TEST_SUITE_P(Surfaces, LineConvergence,
                         ::testing::Values(SampleKind::torus, SampleKind::open_cylinder,
                                           SampleKind::hyperboloid),
                         [](const auto& test) {
                           return sample_names()[static_cast<std::size_t>(test.param)];
                         });

TEST_P(LineConvergence, LinesStayOnExactLinesOfCurvature) {
  const support::AnalyticSurface surface = support::analytic_surface(GetParam());
  std::vector<double> means[2];
  for (const std::int64_t faces : {4000, 16000, 64000}) {
    const TracedSample sample = traced(GetParam(), faces);
    for (const LineFamily family : {LineFamily::minimum, LineFamily::maximum}) {
      std::vector<double> strays;
      for (Index l = 0; l < sample.lines.line_count(); ++l) {
        if (sample.lines.family[l] == family) strays.push_back(stray(sample, surface, l));
      }
      ASSERT_GE(strays.size(), 4);
      EXPECT_LT(*std::max_element(strays.begin(), strays.end()), kLargestStray * sample.edge)
          << faces << " faces";
      EXPECT_LT(mean(strays), kLargestMean * sample.edge) << faces << " faces";
      means[static_cast<int>(family)].push_back(mean(strays));
    }
  }
  // Sixteen times the faces are a quarter of the edge length.
  for (const std::vector<double>& of_family : means) {
    EXPECT_LT(of_family.back(), 0.7 * of_family.front());
  }
}

/// On the ellipsoid the coordinates are confocal, and of no length; lines near umbilics, where the
/// two families are one, are left out.
TEST(EllipsoidLines, StayOnConfocalQuadrics) {
  const double a2 = kEllipsoidAxes[0] * kEllipsoidAxes[0];
  const double b2 = kEllipsoidAxes[1] * kEllipsoidAxes[1];
  const double c2 = kEllipsoidAxes[2] * kEllipsoidAxes[2];
  const double x = std::sqrt(a2 * (a2 - b2) / (a2 - c2));
  const double z = std::sqrt(c2 * (b2 - c2) / (a2 - c2));
  const auto near_umbilic = [&](const Vec3& p) {
    return (Vec3(std::abs(p.x()), p.y(), std::abs(p.z())) - Vec3(x, 0, z)).norm() < kUmbilicRange;
  };
  const support::AnalyticSurface surface = support::analytic_surface(SampleKind::ellipsoid);
  std::vector<double> means;
  for (const std::int64_t faces : {4000, 16000, 64000}) {
    const TracedSample sample = traced(SampleKind::ellipsoid, faces);
    std::vector<double> strays;
    for (Index l = 0; l < sample.lines.line_count(); ++l) {
      const std::vector<Vec3> course = sample.course(l);
      if (std::any_of(course.begin(), course.end(), near_umbilic)) continue;
      double low = std::numeric_limits<double>::infinity();
      double high = -low;
      for (const Vec3& p : course) {
        const double value = coordinate(surface, sample.lines.family[l], p);
        low = std::min(low, value);
        high = std::max(high, value);
      }
      strays.push_back((high - low) / (a2 - c2));
    }
    ASSERT_GE(strays.size(), 10);
    // Measured: 0.05 falling to 0.03, mean 0.015 falling to 0.008.
    EXPECT_LT(*std::max_element(strays.begin(), strays.end()), 0.08) << faces << " faces";
    EXPECT_LT(mean(strays), 0.025) << faces << " faces";
    means.push_back(mean(strays));
  }
  EXPECT_LT(means.back(), 0.7 * means.front());
}

/// Share of the lines of a family, over some seeds, that are as `is_whole` wants.
template <class IsWhole>
double share(SampleKind kind, LineFamily family, const IsWhole& is_whole) {
  double lines = 0;
  double whole = 0;
  for (std::int64_t seed = 1; seed <= 6; ++seed) {
    const TracedSample sample = traced(kind, 12000, seed);
    for (Index l = 0; l < sample.lines.line_count(); ++l) {
      if (sample.lines.family[l] != family) continue;
      ++lines;
      whole += is_whole(sample, l);
    }
  }
  EXPECT_GT(lines, 0);
  return whole / lines;
}

bool closes(const TracedSample& sample, Index line) { return sample.lines.is_closed(line); }

bool runs_through(const TracedSample& sample, Index line) {
  return sample.lines.start_reason[line] == LineEnd::boundary &&
         sample.lines.end_reason[line] == LineEnd::boundary;
}

TEST(ClosedLines, RingsCloseAndRulingsRunFromEndToEnd) {
  for (const SampleKind kind : {SampleKind::open_cylinder, SampleKind::hyperboloid}) {
    SCOPED_TRACE(sample_names()[static_cast<std::size_t>(kind)]);
    EXPECT_EQ(share(kind, LineFamily::minimum, runs_through), 1);
    EXPECT_EQ(share(kind, LineFamily::maximum, closes), 1);
  }
}

/// The torus of the sample with a tube of another radius.
PolyMesh torus(double tube) {
  SampleOptions sample;
  sample.faces = 20000;
  PolyMesh mesh = make_sample(SampleKind::torus, sample);
  for (Vec3& p : mesh.positions) {
    const Vec3 centre = kTorusMajorRadius * Vec3(p.x(), p.y(), 0).normalized();
    p = centre + (p - centre) * (tube / kTorusMinorRadius);
  }
  return mesh;
}

/// All lines of curvature of a torus are circles. Those around the tube come nearer to each other
/// on the inner side, and lines are wanted farthest apart on top, where one curvature is zero: none
/// may be left as an arc on the outer side.
TEST(ClosedLines, AllCirclesOfATorusClose) {
  struct Case {
    const char* name;
    double tube;
    Mat3 turn;
  };
  for (const Case& shape : {Case{"as sampled", kTorusMinorRadius, Mat3::Identity()},
                            Case{"turned", kTorusMinorRadius, support::oblique_rotation()},
                            Case{"thin", 0.25, Mat3::Identity()}}) {
    const support::Prepared prepared =
        support::prepare(support::transformed(torus(shape.tube), shape.turn));
    for (const std::int64_t vertices : {2000, 5000}) {
      for (std::int64_t seed = 1; seed <= 5; ++seed) {
        TraceOptions options;
        options.vertices = vertices;
        options.seed = seed;
        const LineSet lines = support::trace(prepared, options);
        int of_family[2] = {0, 0};
        for (Index l = 0; l < lines.line_count(); ++l) {
          ++of_family[static_cast<int>(lines.family[l])];
          EXPECT_TRUE(lines.start_reason[l] == LineEnd::closed &&
                      lines.end_reason[l] == LineEnd::closed)
              << shape.name << ", " << vertices << " vertices, seed " << seed << ", line " << l;
        }
        // Leaving lines out would close the rest, too: circles of both kinds have to be as many as
        // the distance wanted allows, about sqrt(vertices) each.
        EXPECT_GT(of_family[0] * of_family[1], 0.8 * static_cast<double>(vertices)) << shape.name;
      }
    }
  }
}

/// On the closed cylinder a line may go on over the rims onto the caps; on the side it is a ring,
/// or goes from rim to rim. A few rulings that fill a last gap end where it narrows to the distance
/// at which lines stop (measured: below 1 %).
TEST(ClosedLines, OnTheSideOfACylinderGoAroundOrFromRimToRim) {
  const auto on_side = [](const Vec3& p) { return std::abs(p.z()) < kCylinderHalfHeight - 1e-9; };
  double rings = 0;
  double rulings = 0;
  double ending_on_side = 0;
  for (std::int64_t seed = 1; seed <= 6; ++seed) {
    const TracedSample sample = traced(SampleKind::cylinder, 12000, seed);
    for (Index l = 0; l < sample.lines.line_count(); ++l) {
      if (!sample.is_curvature_line(l)) continue;
      const std::vector<Vec3> course = sample.course(l);
      if (std::none_of(course.begin(), course.end(), on_side)) continue;
      if (std::all_of(course.begin(), course.end(), on_side)) {
        EXPECT_TRUE(sample.lines.is_closed(l)) << "seed " << seed << ", line " << l;
        ++rings;
        continue;
      }
      ++rulings;
      const bool ends_there = on_side(course.front()) || on_side(course.back());
      if (!ends_there || sample.lines.is_closed(l)) continue;
      ++ending_on_side;
      const LineEnd reason =
          on_side(course.front()) ? sample.lines.start_reason[l] : sample.lines.end_reason[l];
      EXPECT_EQ(reason, LineEnd::proximity) << "seed " << seed << ", line " << l;
    }
  }
  EXPECT_GT(rings, 0);
  EXPECT_GT(rulings, 0);
  EXPECT_LT(ending_on_side, 0.02 * rulings);
}

}  // namespace
}  // namespace strake
