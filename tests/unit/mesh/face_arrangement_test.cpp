// Chords in one triangle, and in two that share an edge: which cross is decided by the order of
// their ends on the outline alone, and the cells between them are disks.

#include "stages/mesh/face_arrangement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "common/core/poly_mesh.h"
#include "common/geometry/line_chord.h"
#include "tests/support/mesh_support.h"
#include "tests/unit/mesh/arrangement_check.h"
#include "tests/unit/mesh/graphs.h"
#include "tests/unit/mesh/line_sets.h"

namespace strake {
namespace {

TriMesh one_triangle() {
  PolyMesh soup;
  soup.positions = {Vec3(0, 0, 0), Vec3(1, 0.1, 0), Vec3(0.3, 0.9, 0)};
  soup.add_face(std::array<Index, 3>{0, 1, 2});
  return support::plain_tri_mesh(soup);
}

TriMesh two_triangles() {
  PolyMesh soup;
  soup.positions = {Vec3(0, 0, 0), Vec3(1, 0.1, 0), Vec3(0.3, 0.9, 0), Vec3(1.2, 1, 0.4)};
  soup.add_face(std::array<Index, 3>{0, 1, 2});
  soup.add_face(std::array<Index, 3>{2, 1, 3});
  return support::plain_tri_mesh(soup);
}

/// Checks an overlay of lines that visit each face at most once.
void expect_arrangement(const TriMesh& mesh, const LineSet& lines) {
  EXPECT_EQ(arrangement_fault(mesh, lines, overlay_of(mesh, lines)), "");
}

/// The pieces of each chord make one way from end to end.
void expect_ways(const TriMesh& mesh, const LineSet& lines, double tolerance) {
  const Overlay overlay = overlay_of(mesh, lines);
  const DartGraph& graph = overlay.graph;
  for (Index l = 0; l < lines.line_count(); ++l) {
    std::vector<Index> pieces;
    for (Index e = 0; e < graph.dart_count() / 2; ++e) {
      if (overlay.line[e] == l) pieces.push_back(2 * e);
    }
    ASSERT_FALSE(pieces.empty());
    const auto is_end = [&](Index dart) {
      return overlay.nodes[graph.from(dart)].position ==
             line_point_position(mesh, lines.points[lines.offsets[l]]);
    };
    Index at = kNone;
    for (const Index d : pieces) {
      if (is_end(d)) at = d;
      if (is_end(DartGraph::opposite(d))) at = DartGraph::opposite(d);
    }
    ASSERT_NE(at, kNone);
    const Vec3 start = overlay.nodes[graph.from(at)].position;
    const Vec3 end = line_point_position(mesh, lines.points[lines.offsets[l + 1] - 1]);
    std::size_t walked = 1;
    double along = 0;
    for (;; ++walked) {
      const Vec3& here = overlay.nodes[graph.to(at)].position;
      const double next = (here - start).dot(end - start) / (end - start).squaredNorm();
      EXPECT_GE(next, along - tolerance) << "in order along the chord";
      along = next;
      if (here == end) break;
      ASSERT_LT(walked, pieces.size());
      const std::vector<Index> around = darts_around(graph, DartGraph::opposite(at));
      ASSERT_EQ(around.size(), 4);
      at = around[2];
    }
    EXPECT_EQ(walked, pieces.size());
  }
}

class Chords {
 public:
  explicit Chords(std::uint64_t seed) : random_(seed) {}

  double uniform(double low = 0.01, double high = 0.99) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  int pick(int n) { return static_cast<int>(random_() % n); }

  /// A chord of face 0 between two edges, or from a corner.
  void add(LineSet& lines, double a, double b, bool from_corner = false) {
    const Index i = pick(3);
    if (from_corner) {
      add_line(lines, {{i, 0}, {(i + 1) % 3, b}}, {0});
    } else {
      add_line(lines, {{i, a}, {(i + 1 + pick(2)) % 3, b}}, {0});
    }
  }

 private:
  std::mt19937_64 random_;
};

TEST(FaceArrangement, OfRandomChords) {
  const TriMesh mesh = one_triangle();
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    Chords chords(seed);
    LineSet lines;
    for (int n = 2 + chords.pick(30); n > 0; --n) {
      chords.add(lines, chords.uniform(), chords.uniform(), chords.pick(4) == 0);
    }
    expect_arrangement(mesh, lines);
  }
}

TEST(FaceArrangement, OrdersCrossingsAlongEachChord) {
  const TriMesh mesh = one_triangle();
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    Chords chords(seed);
    LineSet lines;
    for (int n = 0; n < 12; ++n) chords.add(lines, chords.uniform(), chords.uniform());
    // Only orders that differ by rounding may be taken either way.
    expect_ways(mesh, lines, 1e-9);
  }
}

TEST(FaceArrangement, OfHundredsOfChords) {
  const TriMesh mesh = one_triangle();
  Chords chords(1);
  LineSet lines;
  for (int n = 0; n < 300; ++n) {
    chords.add(lines, chords.uniform(), chords.uniform(), chords.pick(10) == 0);
  }
  expect_arrangement(mesh, lines);
}

TEST(FaceArrangement, OfChordsWithEndsInTheSamePlace) {
  const TriMesh mesh = one_triangle();
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    Chords chords(seed);
    LineSet lines;
    for (int n = 2 + chords.pick(40); n > 0; --n) {
      chords.add(lines, (1 + chords.pick(3)) / 4.0, (1 + chords.pick(3)) / 4.0,
                 chords.pick(4) == 0);
    }
    expect_arrangement(mesh, lines);
  }
}

TEST(FaceArrangement, OfNearlyConcurrentChords) {
  const TriMesh mesh = one_triangle();
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    Chords chords(seed);
    const double noise = std::pow(10.0, -chords.uniform(6, 18));
    // Through the barycentric centre, up to noise: on edge 0 at s, from there through the centre.
    LineSet lines;
    for (int n = 3 + chords.pick(30); n > 0; --n) {
      const double s = chords.uniform(0.05, 0.95);
      const Vec3 a(1 - s, s, 0);
      Vec3 direction = Vec3::Constant(1.0 / 3) - a;
      const int zero = s < 0.5 ? 0 : 1;  // the weight that vanishes on the way
      const Vec3 b = a + direction * (a[zero] / -direction[zero]);
      const Index edge = zero == 0 ? 1 : 2;
      const double lambda = edge == 1 ? b[2] : b[0];
      add_line(lines,
               {{0, s}, {edge, std::clamp(lambda + noise * chords.uniform(-1, 1), 1e-9, 1 - 1e-9)}},
               {0});
    }
    for (Index corner = 0; corner < 3; ++corner) {
      add_line(lines, {{corner, 0}, {(corner + 1) % 3, 0.5 + noise * chords.uniform(-1, 1)}}, {0});
    }
    expect_arrangement(mesh, lines);
  }
}

TEST(FaceArrangement, OfNearlyParallelChords) {
  const TriMesh mesh = one_triangle();
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    Chords chords(seed);
    const double noise = std::pow(10.0, -chords.uniform(6, 17));
    LineSet lines;
    for (int n = 2 + chords.pick(30); n > 0; --n) {
      const auto near = [&](double x) { return x + noise * chords.uniform(-1, 1); };
      add_line(lines, {{0, near(0.4)}, {1, near(0.7)}}, {0});
      if (chords.pick(3) == 0) add_line(lines, {{1, near(0.7)}, {2, near(0.2)}}, {0});
    }
    expect_arrangement(mesh, lines);
  }
}

TEST(FaceArrangement, OfLinesThroughTwoFaces) {
  const TriMesh mesh = two_triangles();
  const Index shared = 1;  // of face 0
  ASSERT_NE(mesh.twin[shared], kNone);
  for (std::uint64_t seed = 0; seed < 80; ++seed) {
    SCOPED_TRACE(seed);
    Chords chords(seed);
    const double noise = chords.pick(2) == 0 ? 1.0 : std::pow(10.0, -chords.uniform(6, 17));
    LineSet lines;
    for (int n = 2 + chords.pick(30); n > 0; --n) {
      const auto near = [&](double x) {
        return std::clamp(x + noise * chords.uniform(-0.3, 0.3), 0.01, 0.99);
      };
      // Sixteenths can be named from either side of the edge without rounding.
      const double on_shared = chords.pick(3) == 0 ? (1 + chords.pick(15)) / 16.0 : near(0.5);
      const bool exact = on_shared * 16 == std::floor(on_shared * 16);
      const LinePoint middle = exact && chords.pick(2) == 0
                                   ? LinePoint{mesh.twin[shared], 1 - on_shared}
                                   : LinePoint{shared, on_shared};
      const Index own = mesh.twin[shared];
      const LinePoint start = chords.pick(5) == 0   ? LinePoint{0, 0}
                              : chords.pick(2) == 0 ? LinePoint{0, near(0.5)}
                                                    : LinePoint{2, near(0.5)};
      const LinePoint end = chords.pick(5) == 0   ? LinePoint{TriMesh::prev(own), 0}
                            : chords.pick(2) == 0 ? LinePoint{TriMesh::next(own), near(0.5)}
                                                  : LinePoint{TriMesh::prev(own), near(0.5)};
      add_line(lines, {start, middle, end}, {0, 1});
    }
    expect_arrangement(mesh, lines);
  }
}

}  // namespace
}  // namespace strake
