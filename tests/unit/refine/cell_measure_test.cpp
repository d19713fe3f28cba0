#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <vector>

#include "common/geometry/cell_error/cell_error.h"
#include "tests/support/mesh_support.h"
#include "tests/support/result_cases.h"

namespace strake {
namespace {

using support::Case;
using support::grid;

void expect_same(const ErrorMap& a, const ErrorMap& b) {
  EXPECT_EQ(a.rms, b.rms);
  EXPECT_EQ(a.largest, b.largest);
  EXPECT_EQ(a.vertex_cell, b.vertex_cell);
  ASSERT_EQ(a.cells.size(), b.cells.size());
  for (std::size_t f = 0; f < a.cells.size(); ++f) {
    EXPECT_EQ(a.cells[f].rms, b.cells[f].rms) << f;
    EXPECT_EQ(a.cells[f].largest, b.cells[f].largest) << f;
    EXPECT_EQ(a.cells[f].bend, b.cells[f].bend) << f;
  }
}

/// Moves a vertex, and puts the faces around it behind the others, as dividing anew does.
void change_around(Index vertex, const Vec3& move, PolyMesh& mesh) {
  mesh.positions[vertex] += move;
  PolyMesh changed;
  changed.positions = mesh.positions;
  for (const bool around : {false, true}) {
    for (Index f = 0; f < mesh.face_count(); ++f) {
      const auto face = mesh.face(f);
      const bool has_it = std::ranges::find(face, vertex) != face.end();
      if (has_it == around) changed.add_face(face);
    }
  }
  mesh = std::move(changed);
}

/// What is measured again of changed results is what measuring all of them says, bit by bit: also
/// where faces come nearer to samples that were another's, and where they go away from theirs.
TEST(CellMeasure, KnowsWhatChangesAlone) {
  Case c = grid(32, 4, [](double x, double y) { return 0.1 * std::sin(5 * x) * y; });
  std::mt19937 random(1);
  std::uniform_int_distribution<Index> vertex(0, c.quads.mesh.vertex_count() - 1);
  std::uniform_real_distribution<double> move(-0.08, 0.08);
  CellMeasure measure({.rows = 3, .input_step = 0.1});
  std::set<double> rms;
  for (int round = 0; round < 12; ++round) {
    const ComparedSurfaces surfaces(c.mesh, c.quads);
    const ErrorMap all = measure_cells(surfaces, {.rows = 3, .input_step = 0.1});
    expect_same(measure.measure(surfaces), all);
    rms.insert(all.rms);
    for (int i = 0; i < round % 3; ++i) {
      change_around(vertex(random), {move(random), move(random), move(random)}, c.quads.mesh);
    }
  }
  EXPECT_GT(rms.size(), 6u);  // the rounds differ
}

}  // namespace
}  // namespace strake
