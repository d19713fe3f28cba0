// What every set of lines keeps to, on smooth, rough and meaningless input.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <optional>
#include <random>

#include "common/artifact/meshfile/mesh_reader.h"
#include "common/core/error.h"
#include "common/geometry/line_chord.h"
#include "common/geometry/topology/topology.h"
#include "common/geometry/topology/vertex_ring.h"
#include "tests/support/chain.h"
#include "tests/support/mesh_support.h"
#include "tests/support/models.h"
#include "tests/unit/trace/fields.h"

namespace strake {
namespace {

bool touches(const TriMesh& mesh, const LinePoint& point, const std::function<bool(Index)>& edge) {
  if (!is_vertex_point(point)) return edge(point.halfedge);
  const Index v = mesh.from(point.halfedge);
  for (Index h = mesh.vertex_out[v];;) {
    if (edge(h) || edge(TriMesh::prev(h))) return true;
    h = mesh.rotate_ccw(h);
    if (h == kNone || h == mesh.vertex_out[v]) return false;
  }
}

void expect_end(const TriMesh& mesh, const LinePoint& point, LineEnd reason) {
  const auto on_boundary = [&](Index h) { return mesh.is_boundary(h); };
  const auto on_barrier = [&](Index h) { return mesh.is_barrier(h); };
  if (reason == LineEnd::boundary) {
    EXPECT_TRUE(touches(mesh, point, on_boundary));
  } else if (reason == LineEnd::feature || reason == LineEnd::node) {
    EXPECT_TRUE(touches(mesh, point, on_barrier));
  } else {
    EXPECT_NE(reason, LineEnd::step_limit);
  }
}

/// Checks all that LineSet promises. \return the number of chords through faces
Index expect_lines_on_surface(const TriMesh& mesh, const LineSet& lines) {
  const auto points = static_cast<Index>(lines.points.size());
  EXPECT_EQ(lines.offsets.back(), points);
  EXPECT_EQ(lines.chord_face.size(), lines.points.size());
  EXPECT_EQ(lines.chord_family.size(), lines.points.size());
  EXPECT_EQ(lines.spacing_along_min.size(), mesh.wedge_vertex.size());
  EXPECT_EQ(lines.spacing_along_max.size(), mesh.wedge_vertex.size());
  for (const LinePoint& p : lines.points) {
    EXPECT_TRUE(p.halfedge >= 0 && p.halfedge < mesh.halfedge_count());
    EXPECT_TRUE(p.lambda >= 0 && p.lambda < 1);
  }
  Index chords = 0;
  for (Index l = 0; l < lines.line_count(); ++l) {
    const Index first = lines.offsets[l];
    const Index last = lines.offsets[l + 1];
    EXPECT_GE(last - first, lines.is_closed(l) ? 3 : 1);
    EXPECT_TRUE(lines.seed_point[l] >= first && lines.seed_point[l] < last);
    EXPECT_EQ(lines.is_closed(l), lines.start_reason[l] == LineEnd::closed);
    const bool along_edges =
        lines.family[l] == LineFamily::boundary || lines.family[l] == LineFamily::feature;
    for (Index p = first; p < last; ++p) {
      const Index q = p + 1 < last ? p + 1 : first;
      const Index face = lines.chord_face[p];
      if (along_edges) {
        EXPECT_EQ(face, kNone);
        EXPECT_TRUE(is_vertex_point(lines.points[p]));
        EXPECT_TRUE(mesh.is_barrier(lines.points[p].halfedge));
        if (p + 1 < last || lines.is_closed(l)) {
          EXPECT_EQ(mesh.to(lines.points[p].halfedge), mesh.from(lines.points[q].halfedge));
        }
      } else if (p + 1 < last || lines.is_closed(l)) {
        EXPECT_NE(face, kNone);
        if (face == kNone) continue;
        EXPECT_TRUE(is_proper_chord(mesh, face, lines.points[p], lines.points[q]));
        ++chords;
      } else {
        EXPECT_EQ(face, kNone);
      }
    }
    if (!along_edges && !lines.is_closed(l)) {
      expect_end(mesh, lines.points[first], lines.start_reason[l]);
      expect_end(mesh, lines.points[last - 1], lines.end_reason[l]);
    }
  }
  return chords;
}

class TraceSamples : public ::testing::TestWithParam<SampleKind> {};

INSTANTIATE_TEST_SUITE_P(
    Samples, TraceSamples,
    ::testing::Values(SampleKind::plane, SampleKind::sphere, SampleKind::cylinder,
                      SampleKind::open_cylinder, SampleKind::torus, SampleKind::ellipsoid,
                      SampleKind::hyperboloid, SampleKind::saddle, SampleKind::part),
    [](const auto& test) { return sample_names()[static_cast<std::size_t>(test.param)]; });

TEST_P(TraceSamples, LinesKeepToTheSurfaceOnRoughTriangles) {
  SampleOptions sample;
  sample.faces = 8000;
  if (GetParam() != SampleKind::part) sample.jitter = 1;
  const support::Prepared prepared = support::prepare(make_sample(GetParam(), sample));
  for (const std::int64_t vertices : {200, 2000}) {
    TraceOptions options;
    options.vertices = vertices;
    const LineSet lines = support::trace(prepared, options);
    EXPECT_GT(expect_lines_on_surface(prepared.mesh, lines), 100);
  }
}

TEST_P(TraceSamples, LinesKeepToTheSurfaceWithThePapersField) {
  SampleOptions sample;
  sample.faces = 8000;
  SmoothOptions smooth;
  smooth.extension = "paper";
  const support::Prepared prepared = support::prepare(make_sample(GetParam(), sample), {}, smooth);
  EXPECT_GT(expect_lines_on_surface(prepared.mesh, support::trace(prepared)), 100);
}

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a;
  const double t = std::clamp((p - a).dot(d) / std::max(d.squaredNorm(), 1e-300), 0.0, 1.0);
  return (a + t * d - p).norm();
}

/// Largest distance, over the wedges and both arms of their crosses, from the nearest chord that
/// follows that arm, in wanted distances; by looking at all chords.
double largest_gap(const support::Prepared& prepared, const LineSet& lines) {
  const TriMesh& mesh = prepared.mesh;
  const PrincipalField& field = prepared.field;
  double largest = 0;
  for (Index w = 0; w < mesh.wedge_count(); w += 3) {
    const Vec3& p = mesh.positions[mesh.wedge_vertex[w]];
    const Vec3& along = field.cross[w];
    const Vec3 across = field.normal[w].cross(along);
    double to_along = std::numeric_limits<double>::infinity();
    double to_across = to_along;
    for (Index l = 0; l < lines.line_count(); ++l) {
      const Index first = lines.offsets[l];
      const Index last = lines.offsets[l + 1];
      for (Index i = first; i < last; ++i) {
        if (i + 1 == last && !lines.is_closed(l)) continue;
        const Vec3 a = line_point_position(mesh, lines.points[i]);
        const Vec3 b = line_point_position(mesh, lines.points[i + 1 < last ? i + 1 : first]);
        double& nearest =
            std::abs((b - a).dot(along)) >= std::abs((b - a).dot(across)) ? to_along : to_across;
        nearest = std::min(nearest, distance_to_segment(p, a, b));
      }
    }
    largest = std::max(
        {largest, to_along / lines.spacing_along_max[w], to_across / lines.spacing_along_min[w]});
  }
  return largest;
}

/// Saturation: a strip wider than 1.9 wanted distances gets a line in its middle, so nothing is
/// farther than 0.95 from a line; 5 % are for strips that narrow on the way.
TEST_P(TraceSamples, LinesReachEverywhere) {
  SampleOptions sample;
  sample.faces = 8000;
  const support::Prepared prepared = support::prepare(make_sample(GetParam(), sample));
  TraceOptions options;
  options.vertices = 500;
  SilentObserver observer;
  const TraceResult result = trace_lines(prepared.mesh, prepared.field, options, observer);
  EXPECT_LT(largest_gap(prepared, result.lines), 1);
  for (const auto& [key, value] : result.report.entries()) {
    if (key == "trace.largest_gap") {
      EXPECT_LT(std::get<double>(value), 1);
    }
  }
}

TEST(Trace, EndsAndKeepsToTheSurfaceInAMeaninglessField) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  for (const SampleKind kind : {SampleKind::torus, SampleKind::saddle}) {
    for (const bool extended : {true, false}) {
      support::Prepared prepared;
      prepared.mesh = sample_mesh(kind, 1000, 1);
      prepared.field = field_along(prepared.mesh, [&](const Vec3&) {
        return Vec3(normal(random), normal(random), normal(random));
      });
      prepared.field.cross_extended = extended;
      for (std::size_t w = 0; w < prepared.field.k_max.size(); ++w) {
        prepared.field.k_max[w] = normal(random);
        prepared.field.k_min[w] = 0.5 * prepared.field.k_max[w] * std::sin(normal(random));
      }
      for (double& c : prepared.field.face_confidence) c = random() % 2 == 0 ? 0.2 : 1.0;
      TraceOptions options;
      options.vertices = 400;
      EXPECT_GT(expect_lines_on_surface(prepared.mesh, support::trace(prepared, options)), 100);
    }
  }
}

/// A square whose triangles are needles: thousands of times longer than wide.
TEST(Trace, EndsOnNeedles) {
  constexpr Index kNeedles = 300;
  PolyMesh soup;
  for (Index i = 0; i <= kNeedles; ++i) {
    for (const double y : {0.0, 1.0}) soup.positions.emplace_back(1e-3 * i / kNeedles, y, 0);
  }
  soup.positions.emplace_back(0.5, 0, 0);
  soup.positions.emplace_back(0.5, 1, 0);
  for (Index i = 0; i <= kNeedles; ++i) {
    const Index v = 2 * i;
    soup.add_face(std::array<Index, 3>{v, v + 2, v + 3});
    soup.add_face(std::array<Index, 3>{v, v + 3, v + 1});
  }
  const support::Prepared prepared = support::prepare(soup);
  expect_lines_on_surface(prepared.mesh, support::trace(prepared));
}

/// Two triangles hundreds of line distances long, over which the field turns: most lines end beside
/// others before they cross an edge, and so do those that start next to them. They took 90 and 26
/// million queries for a thousand lines.
TEST(Trace, GivesUpFacesInWhichLinesKeepFailing) {
  PolyMesh strip;
  for (const double x : {0.0, 30.0}) {
    for (const double y : {0.0, 3.0}) strip.positions.emplace_back(x, y, 0);
  }
  strip.add_face(std::array<Index, 3>{0, 2, 3});
  strip.add_face(std::array<Index, 3>{0, 3, 1});
  TraceOptions options;
  options.max_spacing = percent(0.1);
  SilentObserver observer;
  for (const unsigned turn : {1U, 3U}) {
    std::mt19937_64 random(turn);
    std::normal_distribution<double> normal;
    support::Prepared prepared = support::prepare(strip);
    prepared.field = field_along(prepared.mesh, [&](const Vec3&) {
      const double x = normal(random);
      return Vec3(x, normal(random), 0);
    });
    const TraceResult result = trace_lines(prepared.mesh, prepared.field, options, observer);
    expect_lines_on_surface(prepared.mesh, result.lines);
    EXPECT_GT(result.lines.line_count(), 500);
    std::optional<std::int64_t> queries;
    for (const auto& [key, value] : result.report.entries()) {
      if (key == "trace.proximity_queries") queries = std::get<std::int64_t>(value);
    }
    ASSERT_TRUE(queries);
    EXPECT_LT(*queries, 5'000'000);
  }
}

/// Lines would wind around them many times within one step.
TEST(Trace, LeavesOutComponentsSmallerThanTheirDistance) {
  SampleOptions sample;
  sample.faces = 1000;
  const PolyMesh sphere = make_sample(SampleKind::sphere, sample);
  for (const double size : {1e-4, 1e-3, 0.2}) {
    const support::Prepared prepared = support::prepare(support::together(
        sphere, support::transformed(sphere, size * Mat3::Identity(), {2, 0, 0})));
    TraceOptions options;
    options.vertices = 400;
    SilentObserver observer;
    const TraceResult result = trace_lines(prepared.mesh, prepared.field, options, observer);
    const LineSet& lines = result.lines;
    const auto gap = std::ranges::find(result.report.entries(), "trace.largest_gap",
                                       [](const auto& entry) { return entry.first; });
    ASSERT_NE(gap, result.report.entries().end());
    EXPECT_LT(std::get<double>(gap->second), 1);
    const std::vector<Index> component = face_components(prepared.mesh);
    Index on_speck = 0;
    for (const LinePoint& p : lines.points) {
      on_speck += component[TriMesh::face_of(p.halfedge)] != component[0];
    }
    EXPECT_EQ(on_speck > 0, size == 0.2) << size << ": " << on_speck;
    EXPECT_GT(expect_lines_on_surface(prepared.mesh, lines), 100);
  }
}

support::Prepared plane_along_x(std::int64_t faces) {
  support::Prepared plane;
  plane.mesh = sample_mesh(SampleKind::plane, faces);
  plane.field = field_along(plane.mesh, [](const Vec3&) { return Vec3::UnitX(); });
  return plane;
}

double largest_distance(const LineSet& lines) {
  return std::max(std::ranges::max(lines.spacing_along_min),
                  std::ranges::max(lines.spacing_along_max));
}

TEST(Trace, NoFactorLeadsBeyondTheLargestDistance) {
  const support::Prepared plane = plane_along_x(2000);
  TraceOptions options;
  options.max_spacing = percent(4);
  const double most = options.max_spacing->resolve(plane.mesh.diagonal) * (1 + 1e-12);
  for (const double scale : {0.5, 1.0, 2.0, 5.0}) {
    options.spacing_scale = scale;
    EXPECT_LE(largest_distance(support::trace(plane, options)), most) << scale;
  }
  options.spacing_scale.reset();
  options.vertices = 350;  // about what the largest distances give, so fewer lines would do
  EXPECT_LE(largest_distance(support::trace(plane, options)), most);
}

TEST(Trace, DistancesOfASizeFieldAreTaken) {
  const support::Prepared plane = plane_along_x(2000);
  SizeField size;
  size.along.assign(plane.mesh.wedge_vertex.size(), 0.2 * plane.mesh.diagonal);
  size.across = size.along;
  SilentObserver observer;
  WantedSizes sizes;
  sizes.size = &size;
  TraceOptions options;
  for (int i = 0; i < 2; ++i) {
    const TraceResult result = trace_lines(plane.mesh, plane.field, options, observer, sizes);
    EXPECT_NEAR(largest_distance(result.lines), 0.2 * plane.mesh.diagonal, 1e-9);
    options.tolerance = percent(0.5);  // has nothing to decide
  }
}

/// A crease too short for lines at this distance is no line, and none ends at it.
TEST(Trace, NoLineEndsAtAFeatureThatIsLeftOut) {
  support::Prepared plane = plane_along_x(8000);
  TriMesh& mesh = plane.mesh;
  int edges = 0;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (mesh.is_boundary(h)) continue;
    const Vec3 way = mesh.positions[mesh.to(h)] - mesh.positions[mesh.from(h)];
    const Vec3 middle = (mesh.positions[mesh.to(h)] + mesh.positions[mesh.from(h)]) / 2;
    const double lean = std::abs(way.y()) / way.norm();
    if (lean > 0.3 || lean < 0.05 || middle.cwiseAbs().maxCoeff() > 0.8) continue;
    mesh.is_feature[h] = mesh.is_feature[mesh.twin[h]] = 1;
    ++edges;
  }
  ASSERT_GT(edges, 100);
  build_wedges(mesh);
  plane.field = field_along(mesh, [](const Vec3&) { return Vec3::UnitX(); });
  TraceOptions options;
  options.vertices = 150;
  const LineSet lines = support::trace(plane, options);
  const auto is_of_features = [&](Index l) { return lines.family[l] == LineFamily::feature; };
  for (Index l = 0; l < lines.line_count(); ++l) {
    ASSERT_FALSE(is_of_features(l)) << "all are to be left out";
    EXPECT_NE(lines.start_reason[l], LineEnd::feature);
    EXPECT_NE(lines.end_reason[l], LineEnd::feature);
  }
}

/// A crease across the middle of a plane that ends inside of it, with a corner at every vertex.
support::Prepared plane_with_free_crease(double length) {
  support::Prepared plane = plane_along_x(8000);
  TriMesh& mesh = plane.mesh;
  const auto ahead = [&](Index h) { return mesh.positions[mesh.to(h)].x(); };
  const auto distance = [&](Index v) {
    return (mesh.positions[v] + length / 2 * Vec3::UnitX()).norm();
  };
  Index v = 0;
  for (Index other = 1; other < mesh.vertex_count(); ++other) {
    if (distance(other) < distance(v)) v = other;
  }
  while (mesh.positions[v].x() < length / 2) {
    Index best = mesh.vertex_out[v];
    for_each_outgoing(mesh, v, [&](Index h) {
      if (ahead(h) > ahead(best)) best = h;
    });
    mesh.is_feature[best] = mesh.is_feature[mesh.twin[best]] = 1;
    mesh.is_corner[v] = 1;
    v = mesh.to(best);
  }
  mesh.is_corner[v] = 1;
  build_wedges(mesh);
  plane.field = field_along(mesh, [](const Vec3&) { return Vec3::UnitX(); });
  return plane;
}

TEST(Trace, CornersMakeAFreeCreaseNoShorter) {
  TraceOptions options;
  options.vertices = 250;
  for (const double length : {0.25, 1.6}) {
    const support::Prepared plane = plane_with_free_crease(length);
    const auto edges = std::ranges::count(plane.mesh.is_feature, 1) / 2;
    ASSERT_GT(edges, 3);
    const LineSet lines = support::trace(plane, options);
    const auto kept = std::ranges::count(lines.family, LineFamily::feature);
    EXPECT_EQ(kept, length > 1 ? edges : 0) << length;
  }
}

/// Between many creases the middle of a gap is often no place for a line.
TEST(Trace, LinesReachEverywhereOnParts) {
  STRAKE_MODELS_OR_SKIP(models);
  for (const char* name : {"cad/extruder-body.stl", "cad/LCD-knob.stl"}) {
    ReadReport read;
    const support::Prepared part = support::prepare(read_mesh((models / name).string(), read));
    TraceOptions options;
    options.vertices = 1500;
    SilentObserver observer;
    const TraceResult result = trace_lines(part.mesh, part.field, options, observer);
    const auto gap = std::ranges::find(result.report.entries(), "trace.largest_gap",
                                       [](const auto& entry) { return entry.first; });
    ASSERT_NE(gap, result.report.entries().end());
    EXPECT_LT(std::get<double>(gap->second), 0.96) << name;
  }
}

TEST(Trace, RefusesTwoGoalsAtOnce) {
  support::Prepared prepared;
  prepared.mesh = sample_mesh(SampleKind::plane, 500);
  prepared.field = field_along(prepared.mesh, [](const Vec3&) { return Vec3::UnitX(); });
  TraceOptions options;
  options.vertices = 100;
  options.tolerance = percent(0.1);
  EXPECT_THROW(support::trace(prepared, options), UsageError);
}

TEST(Trace, RefusesDistancesOfMillionsOfLinesOnFewFaces) {
  support::Prepared prepared;
  prepared.mesh = sample_mesh(SampleKind::plane, 500);
  prepared.field = field_along(prepared.mesh, [](const Vec3&) { return Vec3::UnitX(); });
  TraceOptions options;
  options.max_spacing = percent(0.02);
  EXPECT_THROW(support::trace(prepared, options), UsageError);
  options.max_spacing = percent(5);
  EXPECT_NO_THROW(support::trace(prepared, options));
}

}  // namespace
}  // namespace strake
