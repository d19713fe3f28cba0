// Parts of a mesh, estimated each by itself from blocks, make bit by bit what one run gives.

#include "stages/tensor/tensor_part.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/core/error.h"
#include "common/geometry/samples/samples.h"
#include "tests/support/import_support.h"
#include "tests/support/mesh_support.h"
#include "tests/unit/tensor/loaded_mesh.h"

namespace strake {
namespace {

PolyMesh sample(SampleKind kind, std::int64_t faces, double jitter) {
  SampleOptions options;
  options.faces = faces;
  options.jitter = jitter;
  return make_sample(kind, options);
}

/// A bent sheet of small triangles above the x axis. A fan of slivers from its first vertex to all
/// others of its lowest row lies on that row, and below follows one triangle larger than the sheet.
/// A sliver's normal comes from the far end of the row, while its other end is at the first vertex.
PolyMesh sheet_with_slivers() {
  constexpr Index kSide = 40;
  constexpr double kStep = 1.0 / kSide;
  PolyMesh mesh;
  for (Index j = 0; j <= kSide; ++j) {
    for (Index i = 0; i <= kSide; ++i) {
      const double x = i * kStep;
      const double y = j * kStep;
      mesh.positions.push_back({x, y, y * std::sin(9 * x)});
    }
  }
  mesh.positions.push_back({0.5, -5, 0});
  const auto add = [&](Index a, Index b, Index c) {
    const std::array<Index, 3> corners = {a, b, c};
    mesh.add_face({corners.data(), 3});
  };
  for (Index j = 0; j < kSide; ++j) {
    for (Index i = 0; i < kSide; ++i) {
      const Index v = j * (kSide + 1) + i;
      add(v, v + 1, v + kSide + 2);
      add(v, v + kSide + 2, v + kSide + 1);
    }
  }
  for (Index i = 1; i < kSide; ++i) add(0, i + 1, i);
  add(kSide, 0, static_cast<Index>(mesh.positions.size()) - 1);
  return mesh;
}

/// All but one vertex within a ten thousandth of the diagonal, 12,000 faces.
PolyMesh ball_with_a_far_vertex() {
  PolyMesh mesh = sample(SampleKind::sphere, 12000, 0.25);
  mesh.positions[0] *= 20000;
  return mesh;
}

PolyMesh tetrahedron() {
  PolyMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (const auto& f : {std::array<Index, 3>{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}) {
    mesh.add_face({f.data(), 3});
  }
  return mesh;
}

const std::map<std::string, TriMesh>& meshes() {
  static const std::map<std::string, TriMesh> kMeshes = {
      {"Features", support::import_tri_mesh(sample(SampleKind::part, 9000, 0))},
      {"FeaturesInAnyOrder",
       support::import_tri_mesh(support::permuted(sample(SampleKind::part, 9000, 0), 5).mesh)},
      {"AnyOrder",
       support::plain_tri_mesh(support::permuted(sample(SampleKind::torus, 6000, 1), 7).mesh)},
      {"Boundary", support::plain_tri_mesh(sample(SampleKind::saddle, 4000, 0.5))},
      {"SliversAndAHugeFace", support::plain_tri_mesh(sheet_with_slivers())},
      {"FewerVerticesThanParts", support::plain_tri_mesh(tetrahedron())},
  };
  return kMeshes;
}

TensorField whole(const TriMesh& mesh, std::optional<Length> radius) {
  SilentObserver observer;
  return estimate_tensors(mesh, {radius}, observer).field;
}

std::vector<TensorPart> all_parts(const TriMesh& mesh, std::optional<Length> radius,
                                  std::int64_t parts) {
  const LoadedMesh blocks(mesh);
  SilentObserver observer;
  std::vector<TensorPart> result;
  for (std::int64_t part = 1; part <= parts; ++part) {
    result.push_back(estimate_tensor_part(blocks, {{radius}, parts, part}, observer).part);
  }
  return result;
}

TensorField merged(const TriMesh& mesh, const std::vector<TensorPart>& parts) {
  std::vector<const TensorPart*> pointers;
  for (const TensorPart& part : parts) pointers.push_back(&part);
  return merge_tensor_parts(mesh.id, mesh.wedge_count(), pointers);
}

template <class Row>
bool are_same_bits(const std::vector<Row>& a, const std::vector<Row>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Row)) == 0;
}

void expect_equal(const TensorField& parts, const TensorField& whole, const std::string& what) {
  EXPECT_EQ(parts.mesh_id, whole.mesh_id);
  EXPECT_TRUE(are_same_bits(parts.normal, whole.normal)) << what;
  ASSERT_EQ(parts.tensor.size(), whole.tensor.size());
  for (std::size_t w = 0; w < whole.tensor.size(); ++w) {
    ASSERT_EQ(std::memcmp(&parts.tensor[w], &whole.tensor[w], sizeof whole.tensor[w]), 0)
        << what << ", wedge " << w;
  }
}

class TensorParts : public ::testing::TestWithParam<const char*> {
 protected:
  const TriMesh& mesh_ = meshes().at(GetParam());
};
INSTANTIATE_TEST_SUITE_P(Meshes, TensorParts,
                         ::testing::Values("Features", "FeaturesInAnyOrder", "AnyOrder", "Boundary",
                                           "SliversAndAHugeFace", "FewerVerticesThanParts"),
                         [](const auto& mesh) { return std::string(mesh.param); });

TEST_P(TensorParts, MakeTheWholeForAnyRadius) {
  // Balls of a large radius hold most of the mesh, in which case one division is as good as
  // another.
  const std::vector<std::pair<double, std::vector<int>>> cases = {
      {0.01, {1, 2, 3, 7}}, {1, {1, 2, 3, 7}}, {6, {3}}, {50, {2}}};
  for (const auto& [share, divisions] : cases) {
    const TensorField expected = whole(mesh_, percent(share));
    for (const int parts : divisions) {
      expect_equal(merged(mesh_, all_parts(mesh_, percent(share), parts)), expected,
                   std::to_string(share) + " %, " + std::to_string(parts) + " parts");
    }
  }
}

TEST_P(TensorParts, MakeTheWholeWhereThereAreManyOfThem) {
  expect_equal(merged(mesh_, all_parts(mesh_, percent(1), 24)), whole(mesh_, percent(1)), "24");
}

TEST(TensorPartsOfAFarVertex, MakeTheWholeWhereBallsShrink) {
  const TriMesh mesh = support::plain_tri_mesh(ball_with_a_far_vertex());
  for (const int parts : {1, 5}) {
    expect_equal(merged(mesh, all_parts(mesh, std::nullopt, parts)), whole(mesh, std::nullopt),
                 std::to_string(parts) + " parts");
  }
}

TEST(TensorPartMemory, PartsKeepLittleMoreThanTheirShare) {
  const TriMesh mesh = support::plain_tri_mesh(sample(SampleKind::torus, 20000, 0.25));
  const LoadedMesh blocks(mesh);
  SilentObserver observer;
  for (std::int64_t part = 1; part <= 4; ++part) {
    const auto result = estimate_tensor_part(blocks, {{percent(0.5)}, 4, part}, observer);
    const auto& entries = result.report.entries();
    const auto kept = std::find_if(entries.begin(), entries.end(), [](const auto& entry) {
      return entry.first == "tensor.faces_kept";
    });
    // A quarter, and a margin of the largest ball and two cells: 1.5 % of the diagonal of 3.98 and
    // 2 / 128 of the width of 2.8, 0.10 together. A Morton run of a quarter of this torus is a
    // quadrant, cut across the tube of circumference 2.5 at both ends: 2 * 2.5 * 0.10 of an area of
    // 15.8 is 3 %; as much again for cells that are cut obliquely.
    EXPECT_LT(static_cast<double>(std::get<std::int64_t>(kept->second)),
              (0.25 + 0.06) * mesh.face_count());
    EXPECT_NEAR(static_cast<double>(result.part.wedge.size()), 0.25 * mesh.wedge_count(),
                0.01 * mesh.wedge_count());
  }
}

class TensorMerge : public ::testing::Test {
 protected:
  /// The message with which merging is refused.
  std::string refusal() {
    try {
      merged(mesh_, parts_);
    } catch (const PreconditionError& error) {
      return error.what();
    }
    ADD_FAILURE() << "the parts were accepted";
    return "";
  }

  const TriMesh& mesh_ = meshes().at("Boundary");
  std::vector<TensorPart> parts_ = all_parts(mesh_, percent(1), 3);
};

TEST_F(TensorMerge, TakesPartsInAnyOrder) {
  std::swap(parts_[0], parts_[2]);
  expect_equal(merged(mesh_, parts_), whole(mesh_, percent(1)), "swapped");
}

TEST_F(TensorMerge, NamesAMissingPart) {
  parts_.erase(parts_.begin() + 1);
  EXPECT_NE(refusal().find("part 2 of 3 is missing"), std::string::npos) << refusal();
}

TEST_F(TensorMerge, NamesAPartThatIsThereTwice) {
  parts_.push_back(parts_[2]);
  EXPECT_NE(refusal().find("part 3 of 3 is given twice"), std::string::npos) << refusal();
}

TEST_F(TensorMerge, RefusesPartsOfAnotherDivision) {
  parts_[1] = all_parts(mesh_, percent(1), 2)[1];
  EXPECT_NE(refusal().find("part 2 of 2"), std::string::npos) << refusal();
}

TEST_F(TensorMerge, RefusesWedgesInNoPartOrInTwo) {
  const Index lost = parts_[1].wedge.back();
  parts_[1].wedge.back() = parts_[1].wedge.front();
  EXPECT_NE(refusal().find("in two parts"), std::string::npos) << refusal();
  parts_[1].wedge.pop_back();
  EXPECT_NE(refusal().find("wedge " + std::to_string(lost) + " of the mesh is in no part"),
            std::string::npos)
      << refusal();
}

TEST(TensorPart, RefusesANumberBeyondTheParts) {
  const LoadedMesh blocks(meshes().at("Boundary"));
  SilentObserver observer;
  EXPECT_THROW(estimate_tensor_part(blocks, {{}, 4, 5}, observer), UsageError);
}

TEST(TensorPart, RefusesWedgesThatContradictTheFaces) {
  TriMesh mesh = meshes().at("Boundary");
  std::swap(mesh.wedge_vertex[10], mesh.wedge_vertex[700]);
  const LoadedMesh blocks(mesh);
  SilentObserver observer;
  EXPECT_THROW(estimate_tensor_part(blocks, {{}, 1, 1}, observer), InputError);
}

}  // namespace
}  // namespace strake
