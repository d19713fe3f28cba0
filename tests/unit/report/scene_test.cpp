#include "strake/report/scene.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "common/geometry/line_chord.h"
#include "common/geometry/samples/samples.h"
#include "strake/report/histograms.h"
#include "strake/report/page.h"
#include "strake/report/proxy.h"
#include "tests/support/attributed.h"
#include "tests/support/chain.h"
#include "tests/unit/report/decoded.h"

namespace strake::report_test {
namespace {

using Json = nlohmann::ordered_json;
using report::Blocks;
using GridRow = std::array<std::uint16_t, 4>;

/// A torus far from the origin with lines and result.
struct Example {
  support::Prepared prepared;
  LineSet lines;
  QuadMesh quads;

  explicit Example(std::int64_t faces = 4000) {
    SampleOptions options;
    options.faces = faces;
    PolyMesh torus = make_sample(sample_kind("torus"), options);
    for (Vec3& p : torus.positions) p += Vec3(1000, -2000, 0);
    prepared = support::prepare(torus);
    lines = support::trace(prepared);
    quads = support::mesh(prepared, lines);
  }
  [[nodiscard]] report::RunFiles run(const std::string& name) const {
    report::RunFiles files;
    files.name = name;
    files.mesh = prepared.mesh;
    files.quads = quads;
    files.field = prepared.field;
    files.field_content = "field";
    files.lines = lines;
    return files;
  }
};

const Example& example() {
  static const Example made;
  return made;
}

Vec3 place(const Json& grid, const GridRow& row) {
  const auto low = grid.at("low").get<std::array<double, 3>>();
  const double step = grid.at("step");
  return Vec3(low[0] + step * row[0], low[1] + step * row[1], low[2] + step * row[2]);
}

TEST(ReportScene, ResultHasAllVerticesAndFacesWithinTheGrid) {
  const auto& [prepared, lines, quads] = example();
  Blocks blocks;
  const ErrorMap errors = measure_cells(ComparedSurfaces(prepared.mesh, quads));
  const report::ResultEdges result = report::measure_edges(prepared.mesh, &prepared.field, quads);
  const Json scene = report::result_scene(quads.provenance, result, errors, blocks);
  const auto bytes = unpacked(blocks);
  const auto points = decode<GridRow>(scene.at("positions"), bytes);
  ASSERT_EQ(points.size(), quads.mesh.positions.size());
  for (std::size_t v = 0; v < points.size(); ++v) {
    const Vec3 wanted = quads.mesh.positions[v] - prepared.mesh.origin;
    EXPECT_LE((place(scene, points[v]) - wanted).cwiseAbs().maxCoeff(),
              0.501 * scene.at("step").get<double>());
  }
  const auto rows = decode<std::array<std::uint8_t, 4>>(scene.at("face_rows"), bytes);
  const auto triangles = decode<std::uint32_t>(scene.at("triangles"), bytes);
  ASSERT_EQ(rows.size(), static_cast<std::size_t>(quads.mesh.face_count()));
  const double largest = scene.at("largest_distance");
  EXPECT_DOUBLE_EQ(largest, errors.largest);
  std::size_t at = 0;
  for (Index f = 0; f < quads.mesh.face_count(); ++f) {
    const auto face = quads.mesh.face(f);
    ASSERT_EQ(rows[f][0], face.size());
    const double distance = (rows[f][2] + 256 * rows[f][3]) / 65535.0 * largest;
    EXPECT_NEAR(distance, errors.cells[f].largest, largest / 131070 * 1.001);
    for (std::size_t i = 0; i < 3 * (face.size() - 2); ++i, ++at) {
      const auto v = static_cast<Index>(triangles.at(at));
      EXPECT_NE(std::find(face.begin(), face.end(), v), face.end()) << "face " << f;
    }
  }
  EXPECT_EQ(at, triangles.size());
}

TEST(ReportScene, SurfaceHoldsTheFieldAtItsVertices) {
  const auto& [mesh, field] = example().prepared;
  Blocks blocks;
  const Json scene = report::surface_scene(mesh, &field, report::kMostFaces, blocks);
  EXPECT_EQ(scene.at("shown_faces"), mesh.face_count());
  EXPECT_EQ(scene.at("shown_deviation_share"), 0);
  const auto bytes = unpacked(blocks);
  const auto points = decode<GridRow>(scene.at("positions"), bytes);
  const auto curvature = decode<std::array<std::int16_t, 2>>(scene.at("curvature"), bytes);
  ASSERT_EQ(points.size(), mesh.wedge_vertex.size());
  const report::Proxy proxy = report::make_proxy(mesh, report::kMostFaces);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Index w = proxy.wedge[i];
    EXPECT_LE((place(scene, points[i]) - mesh.positions[mesh.wedge_vertex[w]]).norm(),
              scene.at("step").get<double>());
    EXPECT_NEAR(points[i][3] / 65535.0, field.wedge_confidence[w], 1e-5);
    const double k = field.k_max[w] * mesh.diagonal;
    EXPECT_NEAR(std::sinh(curvature[i][1] / 1024.0), k, 6e-4 * std::max(1.0, std::abs(k)));
  }
}

TEST(ReportScene, LargeInputsAreDrawnWithFewerFacesThatStayNear) {
  const TriMesh& mesh = example().prepared.mesh;
  const report::Proxy proxy = report::make_proxy(mesh, 800);
  EXPECT_LE(proxy.triangles.size() / 3, 800u);
  EXPECT_GE(proxy.triangles.size() / 3, 600u);
  EXPECT_GT(proxy.deviation, 0);
  const SurfaceDistance surface(mesh.positions, mesh.faces);
  std::vector<std::array<Index, 3>> triangles;
  for (std::size_t c = 0; c < proxy.triangles.size(); c += 3) {
    Vec3 middle = Vec3::Zero();
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t v = proxy.triangles[c + i];
      ASSERT_LT(v, proxy.wedge.size());
      middle += mesh.positions[mesh.wedge_vertex[proxy.wedge[v]]] / 3;
    }
    // The decimation's own figure is an estimate.
    EXPECT_LE(surface.closest(middle).distance, 3 * proxy.deviation + 1e-3 * mesh.diagonal);
  }
}

TEST(ReportScene, ManyLinesHaveFewerPoints) {
  const TriMesh& mesh = example().prepared.mesh;
  const LineSet& lines = example().lines;
  const auto points = [&](std::size_t most) {
    Blocks blocks;
    return report::line_scene(mesh, lines, most, blocks)
        .at("points")
        .at("count")
        .get<std::size_t>();
  };
  const std::size_t all = points(report::kMostLinePoints);
  EXPECT_EQ(points(all), all);
  EXPECT_LE(points(all / 2), all / 2);
  EXPECT_LE(points(1), all / 2);  // ends, seeds and what is far off stay
  EXPECT_GE(points(1), 2u * static_cast<std::size_t>(lines.line_count()));
}

class LinesOfAReport : public testing::TestWithParam<std::size_t> {};
INSTANTIATE_TEST_SUITE_P(MostPoints, LinesOfAReport,
                         testing::Values(std::size_t{1}, report::kMostLinePoints));

TEST_P(LinesOfAReport, KeepTheirEndsSeedsAndLengths) {
  const TriMesh& mesh = example().prepared.mesh;
  const LineSet& lines = example().lines;
  Blocks blocks;
  const Json scene = report::line_scene(mesh, lines, GetParam(), blocks);
  const auto bytes = unpacked(blocks);
  const auto points = decode<GridRow>(scene.at("points"), bytes);
  struct Row {
    std::uint32_t first, seed;
    float length;
    std::uint8_t family, start, end, closed;
  };
  const auto rows = decode<Row>(scene.at("rows"), bytes);
  ASSERT_EQ(rows.size(), static_cast<std::size_t>(lines.line_count()));
  EXPECT_LT(points.size(), lines.points.size());
  const double step = scene.at("step");
  for (Index l = 0; l < lines.line_count(); ++l) {
    const std::uint32_t end =
        l + 1 < lines.line_count() ? rows[l + 1].first : static_cast<std::uint32_t>(points.size());
    const auto near = [&](std::uint32_t row, Index p) {
      const Vec3 wanted = line_point_position(mesh, lines.points[p]);
      EXPECT_LE((place(scene, points[row]) - wanted).norm(), step) << "line " << l;
    };
    near(rows[l].first, lines.offsets[l]);
    near(end - 1, lines.is_closed(l) ? lines.offsets[l] : lines.offsets[l + 1] - 1);
    near(rows[l].seed, lines.seed_point[l]);
    double length = 0;
    for (std::uint32_t p = rows[l].first; p + 1 < end; ++p) {
      length += (place(scene, points[p + 1]) - place(scene, points[p])).norm();
    }
    // Thinning and rounding shorten or lengthen by little.
    EXPECT_NEAR(length, rows[l].length, 0.01 * rows[l].length + 4 * step);
    EXPECT_EQ(rows[l].closed != 0, lines.is_closed(l));
    EXPECT_EQ(rows[l].end, static_cast<std::uint8_t>(lines.end_reason[l]));
  }
}

/// A flat 10 x 10 grid of unit squares as a result, on a mesh that is the same grid in triangles.
struct FlatGrid {
  TriMesh mesh;
  QuadMesh quads;

  FlatGrid() {
    PolyMesh soup;
    for (int y = 0; y <= 10; ++y) {
      for (int x = 0; x <= 10; ++x) soup.positions.emplace_back(x, y, 0);
    }
    quads.mesh.positions = soup.positions;
    for (Index y = 0; y < 10; ++y) {
      for (Index x = 0; x < 10; ++x) {
        const Index v = 11 * y + x;
        quads.mesh.add_face(std::array{v, v + 1, v + 12, v + 11});
        soup.add_face(std::array{v, v + 1, v + 12});
        soup.add_face(std::array{v, v + 12, v + 11});
      }
    }
    SilentObserver observer;
    mesh = import_mesh(soup, {}, observer).mesh;
  }
  /// Curved strongly across a direction that is turned by an angle from the x axis.
  [[nodiscard]] PrincipalField field(double degrees) const {
    const double angle = degrees * std::numbers::pi / 180;
    const auto wedges = static_cast<std::size_t>(mesh.wedge_count());
    PrincipalField field;
    field.mesh_id = mesh.id;
    field.normal.assign(wedges, Vec3::UnitZ());
    field.t_min.assign(wedges, Vec3(std::cos(angle), std::sin(angle), 0));
    field.cross = field.t_min;
    field.k_min.assign(wedges, 0);
    field.k_max.assign(wedges, 1);
    field.wedge_confidence.assign(wedges, 1);
    field.face_confidence.assign(mesh.faces.size(), 1);
    return field;
  }
};

TEST(ReportScene, FacesKnowTheirAngleToTheCurvature) {
  const FlatGrid grid;
  const ErrorMap errors = measure_cells(ComparedSurfaces(grid.mesh, grid.quads));
  // Edges run along x and y: the angle is that of the field, folded into 0 to 45 degrees.
  for (const auto& [turn, folded] :
       {std::pair(0.0, 0.0), {20.0, 20.0}, {45.0, 45.0}, {70.0, 20.0}}) {
    const PrincipalField field = grid.field(turn);
    Blocks blocks;
    const Json scene =
        report::result_scene(grid.quads.provenance,
                             report::measure_edges(grid.mesh, &field, grid.quads), errors, blocks);
    const auto rows = decode<std::array<std::uint8_t, 4>>(scene.at("face_rows"), unpacked(blocks));
    EXPECT_EQ(rows.size(), static_cast<std::size_t>(grid.quads.mesh.face_count()));
    for (const auto& row : rows) EXPECT_EQ(row[1], std::lround(2 * folded)) << turn;
  }
  Blocks blocks;
  const Json scene = report::result_scene(
      grid.quads.provenance, report::measure_edges(grid.mesh, nullptr, grid.quads), errors, blocks);
  const auto rows = decode<std::array<std::uint8_t, 4>>(scene.at("face_rows"), unpacked(blocks));
  EXPECT_EQ(rows.size(), static_cast<std::size_t>(grid.quads.mesh.face_count()));
  for (const auto& row : rows) EXPECT_EQ(row[1], 127) << "no field, no angle";
}

TEST(ReportScene, ColoursLabelsAndGuidesComeAlong) {
  FlatGrid grid;
  support::colour_linearly(grid.quads.mesh);
  FaceLabels halves{"g", {}, {"left", "right"}};
  for (Index f = 0; f < grid.quads.mesh.face_count(); ++f)
    halves.of_face.push_back(f % 10 < 5 ? 0 : 1);
  grid.quads.mesh.attributes.labels = {{"o", std::vector<Index>(100, 0), {"all"}}, halves};
  for (const Vec3& p : grid.mesh.positions) {
    grid.mesh.attributes.colour.push_back(support::linear_colour(p));
  }
  PrincipalField field = grid.field(0);
  field.guides = {{0, 1}, {7}, {Vec3(0.2, 0.3, 0.5)}, {Vec3(0.4, 0.1, 0)}};
  const ErrorMap errors = measure_cells(ComparedSurfaces(grid.mesh, grid.quads));
  Blocks blocks;
  const report::ResultEdges edges = report::measure_edges(grid.mesh, &field, grid.quads);
  const Json result = report::result_scene(grid.quads.provenance, edges, errors, blocks);
  const Json surface = report::surface_scene(grid.mesh, &field, report::kMostFaces, blocks);
  const auto bytes = unpacked(blocks);

  const auto colours = decode<std::array<std::uint8_t, 4>>(result.at("colours"), bytes);
  for (std::size_t v = 0; v < colours.size(); ++v) {
    for (std::size_t k = 0; k < 4; ++k) {
      const double wanted = std::clamp(grid.quads.mesh.attributes.colour[v][k], 0.0, 1.0);
      EXPECT_NEAR(colours[v][k] / 255.0, wanted, 0.501 / 255);
    }
  }
  EXPECT_EQ(decode<std::uint32_t>(surface.at("colours"), bytes).size(), grid.mesh.positions.size());
  // The kind that tells more apart.
  EXPECT_EQ(result.at("labels").at("kind"), "g");
  EXPECT_EQ(decode<Index>(result.at("labels").at("of_face"), bytes), halves.of_face);

  const auto ends = decode<GridRow>(surface.at("guides").at("ends"), bytes);
  ASSERT_EQ(ends.size(), 2u);
  Vec3 middle = Vec3::Zero();
  for (int i = 0; i < 3; ++i) {
    middle += field.guides.barycentric[0][i] * grid.mesh.positions[grid.mesh.faces[7][i]];
  }
  const double step = surface.at("step");
  EXPECT_LE((place(surface, ends[0]) - (middle - Vec3(0.2, 0.05, 0))).norm(), step);
  EXPECT_LE((place(surface, ends[1]) - (middle + Vec3(0.2, 0.05, 0))).norm(), step);
}

TEST(ReportScene, HistogramsOfARegularGrid) {
  const FlatGrid grid;
  const auto& [mesh, quads] = grid;
  const ErrorMap errors = measure_cells(ComparedSurfaces(mesh, quads));
  const auto histograms = report::measure_histograms(report::measure_edges(mesh, nullptr, quads),
                                                     errors, mesh.diagonal);
  std::map<std::string, report::Histogram> by_name;
  for (const auto& histogram : histograms) by_name.emplace(histogram.name, histogram);
  EXPECT_EQ(by_name.size(), 4u);  // no alignment without a field
  const auto only = [&](const std::string& name, double value) {
    const report::Histogram& histogram = by_name.at(name);
    for (std::size_t bin = 0; bin < histogram.shares.size(); ++bin) {
      const bool holds = histogram.bounds[bin] <= value && value < histogram.bounds[bin + 1];
      EXPECT_NEAR(histogram.shares[bin], holds ? 1 : 0, 1e-12) << name << " " << bin;
    }
  };
  only("valence", 4);
  only("edge_lengths", 1 / mesh.diagonal);
  only("angles", 90 + 1e-9);
}

TEST(ReportPage, RunsOnOneMeshShareItsSurface) {
  const report::PageData one = report::describe_runs({example().run("a")});
  const report::PageData two = report::describe_runs({example().run("a"), example().run("b")});
  const Json description = Json::parse(two.json);
  EXPECT_EQ(description.at("surfaces").size(), 1u);
  EXPECT_EQ(description.at("runs").size(), 2u);
  EXPECT_EQ(description.at("runs")[1].at("surface"), 0);
  EXPECT_LT(two.blocks.size(), 1.7 * static_cast<double>(one.blocks.size()));
}

TEST(ReportPage, IsTheSameForAnyNumberOfThreads) {
  const report::RunFiles run = example().run("a");
  const auto with_threads = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return report::describe_runs({run});
  };
  const report::PageData one = with_threads(1);
  const report::PageData three = with_threads(3);
  EXPECT_EQ(one.json, three.json);
  EXPECT_EQ(one.blocks, three.blocks);
}

}  // namespace
}  // namespace strake::report_test
