#include "common/geometry/carry_attributes.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <map>

#include "common/geometry/poly_topology/face_shape.h"
#include "common/geometry/samples/samples.h"
#include "tests/support/attributed.h"
#include "tests/support/chain.h"
#include "tests/support/mesh_support.h"

namespace strake {
namespace {

struct Remeshed {
  TriMesh mesh;
  QuadMesh quads;

  /// The point of the surface that a vertex comes from.
  [[nodiscard]] Vec3 foot(Index v) const {
    Vec3 sum = Vec3::Zero();
    const auto& face = mesh.faces[quads.provenance.face[v]];
    for (int i = 0; i < 3; ++i) {
      sum += quads.provenance.barycentric[v][i] * mesh.positions[face[i]];
    }
    return sum + mesh.origin;
  }
};

Remeshed remeshed(const PolyMesh& input, std::int64_t vertices, const ImportOptions& import = {}) {
  const support::Prepared prepared = support::prepare(input, {}, {}, import);
  TraceOptions options;
  options.vertices = vertices;
  const LineSet lines = support::trace(prepared, options);
  return {prepared.mesh, support::mesh(prepared, lines)};
}

Vec3 normal_of(const PolyMesh& mesh, Index f) {
  Vec3 normal = Vec3::Zero();
  const auto face = mesh.face(f);
  for (std::size_t i = 1; i + 1 < face.size(); ++i) {
    const Vec3& p = mesh.positions[face[0]];
    normal += (mesh.positions[face[i]] - p).cross(mesh.positions[face[i + 1]] - p);
  }
  return normal.normalized();
}

TEST(CarryAttributes, LinearColoursAreReproduced) {
  const Remeshed result = remeshed(support::labelled_cube(12), 200);
  const auto& colour = result.quads.mesh.attributes.colour;
  ASSERT_EQ(colour.size(), result.quads.mesh.positions.size());
  for (Index v = 0; v < result.quads.mesh.vertex_count(); ++v) {
    const Colour expected = support::linear_colour(result.foot(v));
    // Barycentric interpolation is exact for linear functions but for rounding.
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(colour[v][i], expected[i], 1e-12);
  }
}

TEST(CarryAttributes, EveryFaceOfACubeHasTheLabelOfItsSide) {
  // Coarse ones too: with 8 vertices all corners of all faces are on three sides at once.
  for (const int vertices : {8, 60, 400}) {
    const PolyMesh quads = remeshed(support::labelled_cube(12), vertices).quads.mesh;
    ASSERT_EQ(quads.attributes.labels.size(), 1u);
    EXPECT_EQ(quads.attributes.labels[0].name, "g");
    EXPECT_EQ(quads.attributes.labels[0].names.size(), 6u);
    for (Index f = 0; f < quads.face_count(); ++f) {
      EXPECT_EQ(quads.attributes.labels[0].of_face[f], support::side_of(normal_of(quads, f)));
    }
  }
}

/// A border that runs through cells leaves as much on both sides, whichever label comes first.
TEST(CarryAttributes, BordersAcrossCellsLeaveEitherSideItsArea) {
  SampleOptions options;
  options.faces = 20000;
  PolyMesh input = make_sample(SampleKind::sphere, options);
  const auto is_cap = [](const PolyMesh& mesh, Index f) {
    double z = 0;
    for (const Vec3& p : {mesh.positions[mesh.face(f)[0]], mesh.positions[mesh.face(f)[1]],
                          mesh.positions[mesh.face(f)[2]]}) {
      z += p.z() / 3;
    }
    return z > 0.3;
  };
  for (const Index cap : {0, 1}) {
    input.attributes.labels = {{"g", {}, {"a", "b"}}};
    for (Index f = 0; f < input.face_count(); ++f) {
      input.attributes.labels[0].of_face.push_back(is_cap(input, f) ? cap : 1 - cap);
    }
    const PolyMesh quads = remeshed(input, 800).quads.mesh;
    double area = 0;
    double all = 0;
    for (Index f = 0; f < quads.face_count(); ++f) {
      const double own = newell_normal(quads.positions, quads.face(f)).norm() / 2;
      all += own;
      if (quads.attributes.labels[0].of_face[f] == cap) area += own;
    }
    EXPECT_NEAR(area / all, 0.35, 0.006) << cap;  // by Archimedes
  }
}

TEST(CarryAttributes, BothSidesOfASeamKeepTheirTextureCoordinates) {
  for (const bool turned : {false, true}) {
    PolyMesh tube = support::seamed_tube(60, 20);
    if (turned) {
      const PolyMesh moved = support::transformed(tube, support::oblique_rotation());
      tube.positions = moved.positions;
    }
    const Remeshed result = remeshed(tube, 300);
    const PolyMesh& quads = result.quads.mesh;
    ASSERT_EQ(quads.attributes.texture.size(), quads.corners.size());
    const Mat3 back = turned ? Mat3(support::oblique_rotation().transpose()) : Mat3::Identity();
    Index at_seam[2] = {0, 0};
    for (Index f = 0; f < quads.face_count(); ++f) {
      for (Index c = quads.offsets[f]; c < quads.offsets[f + 1]; ++c) {
        const Vec3 foot = back * result.foot(quads.corners[c]);
        const auto& [s, t] = quads.attributes.texture[c];
        EXPECT_NEAR(t, foot.z(), 1e-12);
        // Within a facet of 6 degrees the coordinate is linear and the angle is not: x - tan x with
        // x up to 3 degrees is 5e-5, of a turn of 2 pi.
        const double turn = std::atan2(foot.y(), foot.x()) / (2 * std::numbers::pi);
        EXPECT_NEAR(std::remainder(s - turn, 1), 0, 1e-5);
        // No face reaches over the seam: all its corners are in the half of its middle.
        const double first = quads.attributes.texture[quads.offsets[f]][0];
        EXPECT_LT(std::abs(s - first), 0.5);
        if (s < 1e-9) ++at_seam[0];
        if (s > 1 - 1e-9) ++at_seam[1];
      }
    }
    EXPECT_GT(at_seam[0], 5);
    EXPECT_EQ(at_seam[0] > 0, at_seam[1] > 0);
  }
}

TEST(CarryAttributes, BordersOfLabelsAreEdgesOfTheResult) {
  // A flat square of two labels, with a border in steps and a closed one around a patch.
  PolyMesh square;
  const int n = 24;
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) square.positions.emplace_back(i, j, 0);
  }
  FaceLabels labels{"label", {}, {}};
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const Index a = j * (n + 1) + i;
      square.add_face(std::array<Index, 4>{a, a + 1, a + n + 2, a + n + 1});
      const bool in_patch = i >= 14 && i < 20 && j >= 6 && j < 18;
      labels.of_face.push_back(in_patch ? 7 : i < 8 ? -1 : 3);
    }
  }
  square.attributes.labels = {labels};
  ImportOptions options;
  options.attribute_features = "labels";
  const Remeshed result = remeshed(square, 120, options);
  const PolyMesh& quads = result.quads.mesh;
  // Areas of the labels: faces that straddled a border would take from one and give to another.
  std::map<Index, double> area;
  for (Index f = 0; f < quads.face_count(); ++f) {
    const auto face = quads.face(f);
    double twice = 0;
    for (std::size_t i = 0; i < face.size(); ++i) {
      const Vec3& p = quads.positions[face[i]];
      const Vec3& q = quads.positions[face[(i + 1) % face.size()]];
      twice += p.x() * q.y() - p.y() * q.x();
    }
    area[quads.attributes.labels[0].of_face[f]] += 0.5 * twice;
  }
  EXPECT_EQ(area.size(), 3u);
  EXPECT_NEAR(area[7], 6 * 12, 1e-9);
  EXPECT_NEAR(area[-1], 8 * 24, 1e-9);
  EXPECT_NEAR(area[3], 24 * 24 - 6 * 12 - 8 * 24, 1e-9);
}

}  // namespace
}  // namespace strake
