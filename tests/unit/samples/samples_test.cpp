#include "common/geometry/samples/samples.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/core/error.h"
#include "common/geometry/poly_topology/poly_topology.h"
#include "common/geometry/samples/random.h"
#include "tests/support/analytic_surfaces.h"
#include "tests/support/mesh_support.h"

namespace strake {
namespace {

constexpr double kPi = std::numbers::pi;

struct Face {
  Vec3 a, b, c;
  [[nodiscard]] Vec3 area_vector() const { return (b - a).cross(c - a) / 2; }
  [[nodiscard]] Vec3 middle() const { return (a + b + c) / 3; }
  [[nodiscard]] double least_angle() const {
    const auto angle = [](const Vec3& p, const Vec3& q, const Vec3& r) {
      return std::atan2((q - p).cross(r - p).norm(), (q - p).dot(r - p));
    };
    return std::min({angle(a, b, c), angle(b, c, a), angle(c, a, b)});
  }
};

Face face_of(const PolyMesh& mesh, Index f) {
  const auto v = mesh.face(f);
  return {mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]]};
}

double volume(const PolyMesh& mesh) {
  double sum = 0;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const Face face = face_of(mesh, f);
    sum += face.area_vector().dot(face.a) / 3;
  }
  return sum;
}

SampleOptions with_faces(std::int64_t faces) {
  SampleOptions options;
  options.faces = faces;
  return options;
}

class Samples : public ::testing::TestWithParam<std::string> {
 protected:
  [[nodiscard]] SampleKind kind() const { return sample_kind(GetParam()); }
};

class AnalyticSamples : public Samples {};

INSTANTIATE_TEST_SUITE_P(All, Samples, ::testing::ValuesIn(sample_names()),
                         [](const auto& test) { return test.param; });
INSTANTIATE_TEST_SUITE_P(All, AnalyticSamples,
                         ::testing::ValuesIn(sample_names().begin(), sample_names().end() - 1),
                         [](const auto& test) { return test.param; });

TEST_P(Samples, HasTheTopologyOfItsSurface) {
  struct Topology {
    std::int64_t genus;
    Index boundary_loops;
  };
  const std::vector<Topology> expected = {{0, 1}, {0, 0}, {0, 0}, {0, 2},         {1, 0},
                                          {0, 0}, {0, 2}, {0, 1}, {kPartGenus, 0}};
  for (const std::int64_t faces : {2000, 15000}) {
    const PolyTopology topology = analyse(make_sample(kind(), with_faces(faces)));
    EXPECT_TRUE(topology.is_oriented_manifold()) << topology.defects();
    EXPECT_EQ(topology.unused_vertices, 0);
    EXPECT_EQ(topology.triangles, topology.faces);
    EXPECT_EQ(topology.components, 1);
    const Topology& wanted = expected[static_cast<std::size_t>(kind())];
    ASSERT_TRUE(topology.genus.has_value());
    EXPECT_EQ(*topology.genus, wanted.genus);
    EXPECT_EQ(topology.boundary_loops, wanted.boundary_loops);
  }
}

TEST_P(Samples, HasAboutTheFacesAskedFor) {
  for (const std::int64_t faces : {1000, 9000, 20000}) {
    if (kind() == SampleKind::part && faces < 8000) continue;
    EXPECT_NEAR(make_sample(kind(), with_faces(faces)).face_count() / double(faces), 1, 0.05);
  }
}

TEST_P(Samples, HasWellShapedTriangles) {
  const PolyMesh mesh = make_sample(kind(), with_faces(10000));
  for (Index f = 0; f < mesh.face_count(); ++f) {
    ASSERT_GT(face_of(mesh, f).least_angle(), 12 * kPi / 180) << "face " << f;
  }
}

TEST_P(Samples, IsTheSameEveryTimeAndDependsOnTheSeed) {
  SampleOptions options = with_faces(2000);
  options.jitter = 0.5;
  const PolyMesh first = make_sample(kind(), options), second = make_sample(kind(), options);
  EXPECT_EQ(first.corners, second.corners);
  EXPECT_TRUE(first.positions == second.positions);
  options.seed = 2;
  EXPECT_FALSE(first.positions == make_sample(kind(), options).positions);
}

TEST_P(Samples, JitterMakesTrianglesLessRegularButNeverFlat) {
  std::vector<double> mean_least_angle;
  for (const double jitter : {0.0, 0.5, 1.0}) {
    SampleOptions options = with_faces(8000);
    options.jitter = jitter;
    const PolyMesh mesh = make_sample(kind(), options);
    double sum = 0;
    for (Index f = 0; f < mesh.face_count(); ++f) {
      const double least = face_of(mesh, f).least_angle();
      EXPECT_GT(least, 5 * kPi / 180);
      sum += least;
    }
    mean_least_angle.push_back(sum / mesh.face_count());
  }
  EXPECT_GT(mean_least_angle[0], mean_least_angle[1]);
  EXPECT_GT(mean_least_angle[1], mean_least_angle[2]);
}

TEST_P(AnalyticSamples, VerticesLieOnTheSurfaceAndFacesLookOutwards) {
  const LabelledSample sample = make_labelled_sample(kind(), with_faces(5000));
  const auto surface = support::analytic_surface(kind());
  for (Index f = 0; f < sample.mesh.face_count(); ++f) {
    const Face face = face_of(sample.mesh, f);
    if (sample.face_region[f] == 0) {
      for (const Index v : sample.mesh.face(f)) {
        ASSERT_NEAR(surface.offset(sample.mesh.positions[v]), 0, 1e-14);
      }
      // A chord triangle of size h leans by about h k / 2 against the surface: 3 degrees here.
      ASSERT_GT(face.area_vector().normalized().dot(surface.at(face.middle()).normal), 0.95);
    } else {
      ASSERT_EQ(kind(), SampleKind::cylinder);
      const double up = sample.face_region[f] == 2 ? 1 : -1;
      ASSERT_EQ(face.a.z(), up * kCylinderHalfHeight);
      ASSERT_GT(up * face.area_vector().z(), 0);
    }
  }
}

TEST_P(AnalyticSamples, TrianglesAreOfAboutEqualSize) {
  const PolyMesh mesh = make_sample(kind(), with_faces(10000));
  std::vector<double> areas;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    areas.push_back(face_of(mesh, f).area_vector().norm());
  }
  std::sort(areas.begin(), areas.end());
  EXPECT_LT(areas[areas.size() * 95 / 100], 4 * areas[areas.size() * 5 / 100]);
}

TEST(ClosedSamples, EncloseTheExactVolumeToSecondOrder) {
  const double a = kEllipsoidAxes[0] * kEllipsoidAxes[1] * kEllipsoidAxes[2];
  const std::vector<std::pair<SampleKind, double>> volumes = {
      {SampleKind::sphere, 4.0 / 3 * kPi * std::pow(kSphereRadius, 3)},
      {SampleKind::ellipsoid, 4.0 / 3 * kPi * a},
      {SampleKind::cylinder, 2 * kPi * kCylinderRadius * kCylinderRadius * kCylinderHalfHeight},
      {SampleKind::torus, 2 * kPi * kPi * kTorusMajorRadius * std::pow(kTorusMinorRadius, 2)}};
  for (const auto& [kind, exact] : volumes) {
    std::vector<double> sizes, errors;
    for (const std::int64_t faces : {2000, 8000, 32000}) {
      const double v = volume(make_sample(kind, with_faces(faces)));
      sizes.push_back(1 / std::sqrt(double(faces)));
      errors.push_back(std::abs(v - exact) / exact);
    }
    // Chord triangles miss the surface by h^2 k / 8 at most: order 2. Vertices are placed anew at
    // every size, which scatters the slope over two factors of two by some hundredths.
    EXPECT_NEAR(support::observed_order(sizes, errors), 2, 0.15);
  }
}

TEST(UniformRandom, DrawsCoordinatesInOneOrderWhateverTheCompiler) {
  UniformRandom one_by_one(7);
  UniformRandom at_once(7);
  for (int i = 0; i < 10; ++i) {
    const double z = one_by_one.symmetric();
    const double y = one_by_one.symmetric();
    const double x = one_by_one.symmetric();
    EXPECT_EQ(at_once.in_cube(), Vec3(x, y, z));
  }
}

TEST(SampleOptions, OutOfRangeIsAUsageError) {
  EXPECT_THROW(make_sample(SampleKind::plane, with_faces(10)), UsageError);
  SampleOptions wild;
  wild.jitter = 1.5;
  EXPECT_THROW(make_sample(SampleKind::plane, wild), UsageError);
  EXPECT_THROW(sample_kind("teapot"), UsageError);
}

}  // namespace
}  // namespace strake
