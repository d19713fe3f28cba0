#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "common/geometry/samples/samples.h"
#include "strake/report/scene.h"
#include "strake/report/viewer.h"
#include "tests/support/import_support.h"
#include "tests/unit/mesh/line_sets.h"

namespace strake::report_test {
namespace {

using report::Blocks;

constexpr Index kRows = 316;  // 316 x 316 faces: 100,000
constexpr double kOuter = 1;
constexpr double kInner = 0.4;

/// Numbers as measured ones have them: different in every bit.
class Noise {
 public:
  double operator()(double size) { return size * spread_(random_); }
  std::mt19937& generator() { return random_; }

 private:
  std::mt19937 random_{1};
  std::uniform_real_distribution<double> spread_{-1, 1};
};

Vec3 on_torus(double around, double tube) {
  const double radius = kOuter + kInner * std::cos(tube);
  return {radius * std::cos(around), radius * std::sin(around), kInner * std::sin(tube)};
}

/// In windows of as many items as tracing and meshing jump to and fro: half of the steps between
/// neighbours in a result of 100,000 faces were larger than 500.
template <class Item>
void shuffle_nearby(std::vector<Item>& items, std::mt19937& random) {
  constexpr std::ptrdiff_t kWindow = 1500;
  for (auto from = items.begin(); from != items.end();) {
    const auto to = from + std::min(kWindow, items.end() - from);
    std::shuffle(from, to, random);
    from = to;
  }
}

/// The torus in quads, numbered in no order, each vertex on two lines.
QuadMesh make_result(Noise& noise) {
  std::vector<Index> place(kRows * kRows);
  for (Index v = 0; v < kRows * kRows; ++v) place[v] = v;
  std::vector<Index> faces = place;
  shuffle_nearby(place, noise.generator());
  shuffle_nearby(faces, noise.generator());
  QuadMesh quads;
  quads.mesh.positions.resize(place.size());
  quads.provenance.lines.resize(place.size());
  const double step = 2 * M_PI / kRows;
  for (Index v = 0; v < kRows * kRows; ++v) {
    const Index row = v / kRows;
    const Index column = v % kRows;
    quads.mesh.positions[place[v]] =
        on_torus(step * (row + noise(0.2)), step * (column + noise(0.2)));
    quads.provenance.lines[place[v]] = {row, kRows + column};
  }
  for (const Index f : faces) {
    const Index row = f / kRows;
    const Index column = f % kRows;
    const Index next_row = (row + 1) % kRows;
    const Index next_column = (column + 1) % kRows;
    quads.mesh.add_face(std::array{place[row * kRows + column], place[next_row * kRows + column],
                                   place[next_row * kRows + next_column],
                                   place[row * kRows + next_column]});
  }
  return quads;
}

/// The torus with noise, as large as it may be without being decimated.
TriMesh make_input(Noise& noise) {
  SampleOptions options;
  options.faces = static_cast<std::int64_t>(0.99 * report::kMostFaces);
  PolyMesh torus = make_sample(sample_kind("torus"), options);
  for (Vec3& p : torus.positions) p += Vec3(noise(1e-3), noise(1e-3), noise(1e-3));
  return support::import_tri_mesh(torus, 180);
}

PrincipalField make_field(const TriMesh& mesh, Noise& noise) {
  PrincipalField field;
  for (Index w = 0; w < mesh.wedge_count(); ++w) {
    const Vec3& p = mesh.positions[mesh.wedge_vertex[w]];
    field.t_min.push_back(
        (Vec3(-p.y(), p.x(), 0) + Vec3(noise(0.1), noise(0.1), noise(0.1))).normalized());
    field.cross.push_back((field.t_min.back() + Vec3(0, 0, noise(0.05))).normalized());
    field.k_min.push_back(p.x() + noise(0.1));
    field.k_max.push_back(2 + noise(0.1));
    field.wedge_confidence.push_back(0.5 + noise(0.5));
  }
  return field;
}

/// Lines that wind so much that many points of them stay.
LineSet make_lines(const TriMesh& mesh) {
  LineSet lines;
  const auto add = [&](LineFamily family, auto&& value) {
    add_level_lines(mesh, value, family, lines);
  };
  const auto around = [](const Vec3& p) { return std::atan2(p.y(), p.x()); };
  const auto tube = [](const Vec3& p) {
    return std::atan2(p.z(), std::hypot(p.x(), p.y()) - kOuter);
  };
  add(LineFamily::minimum,
      [&](const Vec3& p) { return std::sin(50 * tube(p) + 2 * std::sin(60 * around(p)) + 1e-7); });
  add(LineFamily::maximum,
      [&](const Vec3& p) { return std::sin(110 * around(p) + 2 * std::sin(20 * tube(p)) + 1e-7); });
  return lines;
}

/// Distances and angles that differ from face to face.
nlohmann::ordered_json add_result(const QuadMesh& quads, Noise& noise, Blocks& blocks) {
  report::ResultEdges result{quads.mesh, collect_edges(quads.mesh), {}};
  for (Index e = 0; e < result.edges.edge_count(); ++e) {
    result.angles.push_back({1, 10 + noise(10), -1});
  }
  ErrorMap errors;
  for (Index f = 0; f < quads.mesh.face_count(); ++f) {
    errors.cells.push_back({.rms = 0, .largest = 1 + noise(0.9)});
  }
  return report::result_scene(quads.provenance, result, errors, blocks);
}

TEST(ReportScene, OfAHundredThousandFacesIsBelowFiveMegabytes) {
  Noise noise;
  const TriMesh mesh = make_input(noise);
  const PrincipalField field = make_field(mesh, noise);
  const LineSet lines = make_lines(mesh);
  Blocks blocks;
  const auto surface = report::surface_scene(mesh, &field, report::kMostFaces, blocks);
  const auto result = add_result(make_result(noise), noise, blocks);
  const auto line = report::line_scene(mesh, lines, report::kMostLinePoints, blocks);
  EXPECT_GT(surface.at("shown_faces"), 140000);
  EXPECT_GT(result.at("faces"), 99000);
  EXPECT_GT(line.at("points").at("count"), 75000);
  EXPECT_LT(blocks.packed().size() + report::viewer_page().size(), 5'000'000u);
}

}  // namespace
}  // namespace strake::report_test
