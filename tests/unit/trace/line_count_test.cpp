// How many vertices lines give, before there are any faces.

#include "stages/trace/line_count.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "common/geometry/line_chord.h"
#include "common/geometry/samples/samples.h"
#include "tests/support/attributed.h"
#include "tests/support/chain.h"

namespace strake {
namespace {

struct Segment {
  Index face;
  Vec3 from, to;
};

std::vector<Segment> chords_through_faces(const TriMesh& mesh, const LineSet& lines) {
  std::vector<Segment> segments;
  for (Index l = 0; l < lines.line_count(); ++l) {
    for (Index i = lines.offsets[l]; i < lines.offsets[l + 1]; ++i) {
      if (lines.chord_face[i] == kNone) continue;
      const Index next = i + 1 < lines.offsets[l + 1] ? i + 1 : lines.offsets[l];
      segments.push_back({lines.chord_face[i], line_point_position(mesh, lines.points[i]),
                          line_point_position(mesh, lines.points[next])});
    }
  }
  std::stable_sort(segments.begin(), segments.end(),
                   [](const Segment& a, const Segment& b) { return a.face < b.face; });
  return segments;
}

/// Whether two segments of one plane cross, by the sides of each on which the other's ends lie.
bool cross_each_other(const Segment& a, const Segment& b, const Vec3& normal) {
  const auto side = [&](const Segment& s, const Vec3& p) {
    return (s.to - s.from).cross(p - s.from).dot(normal);
  };
  return side(a, b.from) * side(a, b.to) < 0 && side(b, a.from) * side(b, a.to) < 0;
}

std::int64_t crossings_by_sides(const TriMesh& mesh, const LineSet& lines) {
  const std::vector<Segment> segments = chords_through_faces(mesh, lines);
  std::int64_t count = 0;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const auto& [a, b, c] = mesh.faces[segments[i].face];
    const Vec3 normal =
        (mesh.positions[b] - mesh.positions[a]).cross(mesh.positions[c] - mesh.positions[a]);
    for (std::size_t k = i + 1; k < segments.size() && segments[k].face == segments[i].face; ++k) {
      count += cross_each_other(segments[i], segments[k], normal) ? 1 : 0;
    }
  }
  return count;
}

class LineCounts : public ::testing::TestWithParam<SampleKind> {
 protected:
  [[nodiscard]] static support::Prepared prepared() {
    SampleOptions sample;
    sample.faces = 4000;
    return support::prepare(make_sample(GetParam(), sample));
  }
};

INSTANTIATE_TEST_SUITE_P(Samples, LineCounts,
                         ::testing::Values(SampleKind::plane, SampleKind::sphere,
                                           SampleKind::cylinder, SampleKind::open_cylinder,
                                           SampleKind::torus, SampleKind::saddle, SampleKind::part),
                         [](const auto& test) {
                           return sample_names()[static_cast<std::size_t>(test.param)];
                         });

TEST_P(LineCounts, CrossingsAreThoseOfTheChords) {
  const support::Prepared surface = prepared();
  TraceOptions options;
  options.vertices = 500;
  const LineSet lines = support::trace(surface, options);
  const std::int64_t expected = crossings_by_sides(surface.mesh, lines);
  EXPECT_GT(expected, 50);
  // Chords from one vertex of a face to another edge may be taken for either by rounding.
  EXPECT_NEAR(double(count_places(surface.mesh, lines).crossings), double(expected),
              0.01 * double(expected));
}

TEST_P(LineCounts, LinesForACountGiveIt) {
  const support::Prepared surface = prepared();
  for (const std::int64_t wanted : {400, 1500}) {
    // Around bores smaller than its cells the mesh keeps more vertices than lines give.
    if (GetParam() == SampleKind::part && wanted == 400) continue;
    TraceOptions options;
    options.vertices = wanted;
    const QuadMesh quads = support::mesh(surface, support::trace(surface, options));
    EXPECT_NEAR(quads.mesh.vertex_count() / double(wanted), 1, 0.15) << wanted;
  }
}

/// Nothing bends between the edges of a cube: no tolerance says how many lines cross it.
TEST(LineCount, FlatsGiveACountToo) {
  const support::Prepared cube = support::prepare(support::labelled_cube(8));
  TraceOptions options;
  options.vertices = 900;
  const QuadMesh quads = support::mesh(cube, support::trace(cube, options));
  EXPECT_NEAR(quads.mesh.vertex_count() / 900.0, 1, 0.15);
}

TEST(LineCount, AGivenScaleIsKept) {
  SampleOptions sample;
  sample.faces = 4000;
  const support::Prepared part = support::prepare(make_sample(SampleKind::part, sample));
  TraceOptions options;
  options.vertices = 500;
  std::vector<double> crossings;
  for (const double scale : {1.0, 2.0}) {
    options.spacing_scale = scale;
    crossings.push_back(double(count_places(part.mesh, support::trace(part, options)).vertices()));
  }
  EXPECT_LT(crossings[1], 0.6 * crossings[0]);
}

TEST(ScaleFor, GivesWhatIsWanted) {
  for (const LineCount& count :
       {LineCount{800, 200, 10}, LineCount{0, 100, 8}, LineCount{500, 0, 0}}) {
    for (const double wanted : {300.0, 700.0, 1900.0}) {
      const double scale = scale_for(count, wanted);
      if (scale <= 0.25 || scale >= 4) continue;
      EXPECT_NEAR(double(count.crossings) / (scale * scale) + double(count.on_barriers) / scale +
                      double(count.corners),
                  wanted, 1e-9 * wanted);
    }
  }
  EXPECT_EQ(scale_for({100, 10, 50}, 40), 4);   // corners alone are more
  EXPECT_EQ(scale_for({0, 0, 8}, 1000), 0.25);  // no lines yet
}

}  // namespace
}  // namespace strake
