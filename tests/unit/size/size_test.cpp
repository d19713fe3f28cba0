#include "stages/size/size.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/artifact/meshfile/density_reader.h"
#include "common/core/error.h"
#include "common/geometry/density.h"
#include "common/geometry/mesh_measures.h"
#include "common/geometry/samples/samples.h"
#include "stages/size/closer_near.h"
#include "tests/support/chain.h"
#include "tests/support/result_cases.h"

namespace strake {
namespace {

using support::Case;
using support::grid;

constexpr double kUsed = 0.125;  // distance of the lines that the results below stand for

PrincipalField flat_field(const TriMesh& mesh) {
  const auto wedges = static_cast<std::size_t>(mesh.wedge_count());
  PrincipalField field;
  field.normal.assign(wedges, Vec3::UnitZ());
  field.t_min.assign(wedges, Vec3::UnitX());
  field.cross = field.t_min;
  return field;
}

LineSet used_lines(const TriMesh& mesh) {
  LineSet lines;
  lines.spacing_along_min.assign(static_cast<std::size_t>(mesh.wedge_count()), kUsed);
  lines.spacing_along_max = lines.spacing_along_min;
  return lines;
}

SizeField sizes(const Case& c, const SizeOptions& options = {},
                const DensityField* density = nullptr) {
  SilentObserver observer;
  return size_from_errors(c.mesh, flat_field(c.mesh), used_lines(c.mesh), c.quads, density, options,
                          observer)
      .size;
}

/// Mean factor on the distances of the vertices in a range of x.
double mean_factor(const Case& c, const std::vector<double>& distance, double from, double to) {
  double sum = 0;
  double count = 0;
  for (Index w = 0; w < c.mesh.wedge_count(); ++w) {
    const double x = c.mesh.positions[c.mesh.wedge_vertex[w]].x();
    if (x < from || x > to) continue;
    sum += distance[w] / kUsed;
    ++count;
  }
  return sum / count;
}

/// Bent along x only, more on the right.
Case bent_more_on_the_right() {
  return grid(64, 8, [](double x, double) {
    const double amplitude = x < 0.5 ? 0.001 : 0.01;
    return amplitude * std::cos(16 * M_PI * (x - 1.0 / 16));
  });
}

TEST(Size, ShrinksWhereTheErrorIsAboveTheMeanAndGrowsWhereBelow) {
  const Case c = bent_more_on_the_right();
  const SizeField size = sizes(c);
  const double left = mean_factor(c, size.along, 0, 0.3);
  const double right = mean_factor(c, size.along, 0.7, 1);
  EXPECT_LT(right, 0.8);
  EXPECT_GT(left, right * 1.5);
  for (std::size_t w = 0; w < size.along.size(); ++w) {
    EXPECT_GT(size.along[w], 0.59 * kUsed);
    EXPECT_LT(size.along[w], 1.26 * kUsed);
  }
}

/// A cell that is far worse than all around it is no chance.
TEST(Size, ShrinksAtASingleCellThatIsFarOff) {
  const auto is_inside = [](double x, double y) {
    return std::abs(x - 0.5625) < 0.0625 && std::abs(y - 0.5625) < 0.0625;
  };
  const Case c = grid(64, 8, [&](double x, double y) {
    const double bump = std::sin(8 * M_PI * x) * std::sin(8 * M_PI * y);
    return (is_inside(x, y) ? 0.03 : 0.0005) * bump * bump;
  });
  const SizeField size = sizes(c);
  for (Index w = 0; w < c.mesh.wedge_count(); ++w) {
    const Vec3& p = c.mesh.positions[c.mesh.wedge_vertex[w]];
    if (is_inside(p.x(), p.y())) {
      EXPECT_LT(size.along[w], 0.7 * kUsed) << p.transpose();
    }
    if ((p - Vec3(0.5625, 0.5625, 0)).norm() > 0.4) {
      EXPECT_GT(size.along[w], kUsed) << p.transpose();
    }
  }
}

/// Lines across x are too far apart, lines along x are not.
TEST(Size, ShrinksTheDirectionThatBends) {
  const Case c = bent_more_on_the_right();
  const SizeField size = sizes(c);
  EXPECT_LT(mean_factor(c, size.along, 0.7, 1), 0.8 * mean_factor(c, size.across, 0.7, 1));
}

TEST(Size, ATighterToleranceShrinksMoreAndNoFeedbackChangesNothing) {
  const Case c = bent_more_on_the_right();
  SizeOptions options;
  options.tolerance = Length{0.002, false};
  const SizeField loose = sizes(c, options);
  options.tolerance = Length{0.001, false};
  const SizeField tight = sizes(c, options);
  for (std::size_t w = 0; w < loose.along.size(); ++w) EXPECT_LE(tight.along[w], loose.along[w]);
  EXPECT_LT(mean_factor(c, tight.along, 0, 1), mean_factor(c, loose.along, 0, 1));
  options.feedback = 0;
  for (const double d : sizes(c, options).along) EXPECT_DOUBLE_EQ(d, kUsed);
}

TEST(Size, UnderAToleranceNothingGrows) {
  const Case c = bent_more_on_the_right();
  SizeOptions options;
  options.tolerance = percent(10);
  for (const double d : sizes(c, options).along) EXPECT_DOUBLE_EQ(d, kUsed);
  options.tolerance = Length{0.002, false};
  const SizeField size = sizes(c, options);
  for (const double d : size.across) EXPECT_LE(d, kUsed);
  EXPECT_LT(mean_factor(c, size.along, 0.7, 1), 1);
}

/// Also not where cells are bent along one direction alone, whose lines have all of the error.
TEST(Size, UnderAToleranceNothingShrinksWhereItIsKept) {
  const Case c = bent_more_on_the_right();
  SizeOptions options;
  options.tolerance = Length{0.02, false};  // no cell is farther off
  const SizeField size = sizes(c, options);
  for (const double d : size.along) EXPECT_DOUBLE_EQ(d, kUsed);
  for (const double d : size.across) EXPECT_DOUBLE_EQ(d, kUsed);
}

/// A surface that is the same seen from its other end gives distances that are.
TEST(Size, IsSymmetricWhereTheSurfaceIs) {
  const auto height = [](double x, double y) {
    const double u = x - 0.5;
    const double v = y - 0.5;
    return 0.2 * std::cos(6 * u * v) + 0.1 * u * u;
  };
  const Case c = grid(32, 8, height);
  const SizeField size = sizes(c);
  // Half a turn about the middle maps vertex i to the last one minus i.
  const auto last = static_cast<std::size_t>(c.mesh.vertex_count()) - 1;
  std::vector<double> of_vertex(last + 1);
  for (Index w = 0; w < c.mesh.wedge_count(); ++w) {
    of_vertex[c.mesh.wedge_vertex[w]] = size.along[w];
  }
  // Vertices between two cells may belong to either: compare those that lie inside of one. Samples
  // between two cells may too, which changes what is measured a little.
  for (std::size_t v = 0; v <= last; ++v) {
    const std::size_t column = v % 33;
    const std::size_t row = v / 33;
    if (column % 4 == 0 || row % 4 == 0) continue;
    EXPECT_NEAR(of_vertex[v] / of_vertex[last - v], 1, 0.01);
  }
}

/// Where vertices are wanted more densely the same error counts for more.
TEST(Size, ErrorsCountTimesTheDensity) {
  const Case c = grid(64, 8, [](double x, double) { return 0.005 * std::cos(16 * M_PI * x); });
  DensityField density;
  for (const Vec3& p : c.mesh.positions) density.value.push_back(p.x() < 0.5 ? 1 : 4);
  const SizeField size = sizes(c, {}, &density);
  // The ratio of the errors is 4: 4^0.4.
  EXPECT_NEAR(mean_factor(c, size.along, 0, 0.4) / mean_factor(c, size.along, 0.6, 1),
              std::pow(4, 0.4), 0.1);
}

/// Around a place, on a plane: closer than lines were, never farther than wanted.
TEST(CloserNear, MultipliesTheDistancesAroundPlaces) {
  const Case c = grid(64, 8, [](double, double) { return 0.0; });
  LineSet lines = used_lines(c.mesh);
  for (double& d : lines.spacing_along_max) d *= 0.5;
  const SizeField used = used_distances(lines);
  SizeField wanted = used;
  for (double& d : wanted.along) d *= 1.5;   // more than lines used
  for (double& d : wanted.across) d *= 0.1;  // less than they are to be
  const Vec3 place(0.25, 0.5, 0);
  const SizeField size = closer_near(c.mesh, wanted, used, {place, place}, 0.25);
  const double reach = 2 * kUsed;
  for (Index w = 0; w < c.mesh.wedge_count(); ++w) {
    const double distance = (c.mesh.positions[c.mesh.wedge_vertex[w]] - place).norm();
    EXPECT_EQ(size.along[w], distance <= reach ? 0.25 * kUsed : 1.5 * kUsed) << distance;
    EXPECT_EQ(size.across[w], wanted.across[w]);
  }
}

TEST(CloserNear, ScaledDistancesKeepTheirRatios) {
  const SizeField size = {"", {1, 2}, {4, 8}};
  const SizeField others = {"", {6, 3}, {12, 24}};  // 6, 1.5, 3 and 3 times those: 3 in the mean
  const SizeField scaled = scaled_like(size, others);
  for (std::size_t w = 0; w < size.along.size(); ++w) {
    EXPECT_DOUBLE_EQ(scaled.along[w], 3 * size.along[w]);
    EXPECT_DOUBLE_EQ(scaled.across[w], 3 * size.across[w]);
  }
}

/// Distances are those of vertices: a place amid a face far larger than the reach takes one of
/// them.
TEST(CloserNear, TakesTheNearestCornerOfALargeFace) {
  const Case c = grid(2, 2, [](double, double) { return 0.0; });
  LineSet lines = used_lines(c.mesh);
  for (auto* distances : {&lines.spacing_along_min, &lines.spacing_along_max}) {
    for (double& d : *distances) d = 1e-3;
  }
  const SizeField used = used_distances(lines);
  const Vec3 place(0.1, 0.05, 0);  // nearest to the corner of the grid
  const SizeField size = closer_near(c.mesh, used, used, {place}, 0.25);
  for (Index w = 0; w < c.mesh.wedge_count(); ++w) {
    const bool is_nearest = c.mesh.positions[c.mesh.wedge_vertex[w]].isZero(1e-12);
    EXPECT_EQ(size.along[w], (is_nearest ? 0.25 : 1) * used.along[w]);
  }
}

/// Distances between lines, not counts: lines go on where their neighbours are nearer than wanted.
TEST(Density, DistancesShrinkWithItsRoot) {
  SampleOptions sample;
  sample.faces = 20000;
  const PolyMesh sphere = make_sample(SampleKind::sphere, sample);
  const support::Prepared prepared = support::prepare(sphere);
  DensityField density;
  for (const Vec3& p : sphere.positions) density.value.push_back(p.z() > 0 ? 2 : 1);
  TraceOptions options;
  options.tolerance = percent(0.1);
  SilentObserver observer;
  const LineSet lines =
      trace_lines(prepared.mesh, prepared.field, options, observer, {nullptr, &density}).lines;
  double upper = 0;
  double lower = 0;
  double upper_count = 0;
  double lower_count = 0;
  for (Index w = 0; w < prepared.mesh.wedge_count(); ++w) {
    const double z = prepared.mesh.positions[prepared.mesh.wedge_vertex[w]].z();
    if (std::abs(z) < 0.5) continue;  // distances are graded between the halves
    (z > 0 ? upper : lower) += lines.spacing_along_min[w];
    (z > 0 ? upper_count : lower_count) += 1;
  }
  EXPECT_NEAR((lower / lower_count) / (upper / upper_count), std::sqrt(2), 0.03);
}

/// A density that differs by a million took a million vertices where 500 were wanted.
TEST(Density, LinesOfACountAreNotFarTooMany) {
  const support::Prepared prepared = support::prepare(make_sample(SampleKind::sphere, {}));
  const TriMesh& mesh = prepared.mesh;
  DensityField density;
  density.value.resize(mesh.positions.size());
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    density.value[mesh.source_vertex[v]] = mesh.positions[v].z() > 0 ? 1e6 : 1;
  }
  TraceOptions options;
  options.vertices = 500;
  SilentObserver observer;
  const LineSet lines =
      trace_lines(mesh, prepared.field, options, observer, {nullptr, &density}).lines;
  const std::vector<double> areas = wedge_areas(mesh);
  double cells = 0;
  for (std::size_t w = 0; w < areas.size(); ++w) {
    cells += areas[w] / (lines.spacing_along_min[w] * lines.spacing_along_max[w]);
  }
  EXPECT_GT(cells, 250);
  EXPECT_LT(cells, 5 * 500);
}

TEST(Density, OfAnotherMeshIsRefused) {
  const support::Prepared prepared = support::prepare(make_sample(SampleKind::plane, {}));
  const DensityField density{"", {1, 2, 3}};
  SilentObserver observer;
  EXPECT_THROW(
      trace_lines(prepared.mesh, prepared.field, TraceOptions{}, observer, {nullptr, &density}),
      PreconditionError);
}

/// As many vertices, but in another order: no number tells.
TEST(Density, OfOtherPlacesIsRefused) {
  const support::Prepared prepared = support::prepare(make_sample(SampleKind::plane, {}));
  const TriMesh& mesh = prepared.mesh;
  DensityField density;
  density.position.resize(mesh.positions.size());
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    density.value.push_back(1);
    density.position[mesh.source_vertex[v]] = mesh.positions[v] + mesh.origin;
  }
  EXPECT_EQ(density_at_wedges(mesh, density).size(), mesh.wedge_vertex.size());
  std::ranges::reverse(density.position);
  EXPECT_THROW((void)density_at_wedges(mesh, density), PreconditionError);
}

std::string ply(const std::string& property, const std::string& rows) {
  return "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n" +
         property +
         "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n" +
         rows + "3 0 1 2\n";
}

TEST(Density, IsReadFromPly) {
  const DensityField density =
      parse_density(ply("property double density\n", "0 0 1.5 0\n1 0 0.25 0\n0 1 7 4\n"));
  EXPECT_EQ(density.value, (std::vector<double>{1.5, 0.25, 7}));
  EXPECT_EQ(density.position, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 4}}));
}

/// Rows without properties take no bytes: as many as are announced, and none.
TEST(Density, ElementsWithoutPropertiesTakeNoTime) {
  const std::string bytes =
      "ply\nformat binary_little_endian 1.0\nelement nothing 9000000000000000000\n"
      "element vertex 1\nproperty uchar density\nend_header\n\x02";
  EXPECT_EQ(parse_density(bytes).value, std::vector<double>{2});
  EXPECT_TRUE(parse_density(bytes).position.empty());
}

TEST(Density, WhatCannotBeOneIsRefusedWithItsPlace) {
  const auto message = [](const std::string& bytes) {
    try {
      parse_density(bytes);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string property = "property double density\n";
  EXPECT_NE(message("solid x\n").find("no PLY file"), std::string::npos);
  EXPECT_NE(message(ply("", "0 0 0\n1 0 0\n0 1 0\n")).find("no vertex property 'density'"),
            std::string::npos);
  for (const char* bad : {"0", "-1", "nan", "inf", "x"}) {
    const std::string rows = std::string("0 0 1 0\n1 0 ") + bad + " 0\n0 1 1 0\n";
    EXPECT_NE(message(ply(property, rows)).find("at vertex 1"), std::string::npos) << bad;
  }
  const std::string whole = ply(property, "0 0 1 0\n1 0 1 0\n0 1 1 0\n");
  EXPECT_NE(message(whole.substr(0, whole.size() - 17)).find("ends before vertex 2"),
            std::string::npos);
}

}  // namespace
}  // namespace strake
