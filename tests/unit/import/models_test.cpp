#include "tests/support/models.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "common/artifact/meshfile/mesh_reader.h"
#include "common/core/error.h"
#include "tests/unit/import/shapes.h"

namespace strake {
namespace {

namespace fs = std::filesystem;

/// A line of the table of models.
struct Entry {
  std::string file;
  Index vertices = 0;
  Index faces = 0;
  Index boundary_loops = 0;
  Index components = 0;
  Index genus = 0;
  Index unreferenced = 0;
};

Index number(const std::string& text) {
  Index value = -1;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

/// The number before `what` in a remark; 0 where it is not mentioned.
Index mentioned(const std::string& remark, const std::string& what) {
  const std::size_t at = remark.find(" " + what);
  if (at == std::string::npos) return 0;
  const std::size_t start = remark.find_last_not_of("0123456789", at - 1) + 1;
  return number(remark.substr(start, at - start));
}

std::vector<Entry> read_manifest(const fs::path& models, const std::string& section) {
  std::ifstream stream(models / "MANIFEST.md");
  std::vector<Entry> entries;
  std::string line;
  bool inside = false;
  while (std::getline(stream, line)) {
    if (line.starts_with("## ")) inside = line.find("(`" + section + "/`)") != std::string::npos;
    if (!inside || !line.starts_with("| ") || line.starts_with("| file")) continue;
    std::vector<std::string> cells;
    std::istringstream row(line.substr(1));
    for (std::string cell; std::getline(row, cell, '|');) {
      const std::size_t first = cell.find_first_not_of(' ');
      const std::size_t last = cell.find_last_not_of(' ');
      cells.push_back(first == std::string::npos ? "" : cell.substr(first, last - first + 1));
    }
    if (cells.size() < 13) continue;
    const Index loops = cells[6] == "closed" ? 0 : number(cells[6]);
    entries.push_back({cells[0], number(cells[4]), number(cells[5]), loops, number(cells[7]),
                       number(cells[8]), mentioned(cells[12], "unreferenced vertices")});
  }
  return entries;
}

PolyMesh read_model(const fs::path& path) {
  ReadReport report;
  PolyMesh mesh = read_mesh(path, report);
  EXPECT_TRUE(report.warnings().empty()) << path << ": " << report.warnings().front();
  return mesh;
}

class CleanModels : public testing::TestWithParam<const char*> {};

TEST_P(CleanModels, ImportAsTheManifestStates) {
  STRAKE_MODELS_OR_SKIP(models);
  const std::vector<Entry> entries = read_manifest(models, GetParam());
  ASSERT_FALSE(entries.empty());
  for (const Entry& entry : entries) {
    SCOPED_TRACE(entry.file);
    const PolyMesh input = read_model(models / GetParam() / entry.file);
    EXPECT_EQ(input.vertex_count(), entry.vertices);
    EXPECT_EQ(input.face_count(), entry.faces);
    const ImportResult result = shapes::imported(input);
    // A few are clean but for triangles without area, which go by flips.
    const bool has_flips = shapes::count(result.report, "repairs.flipped_edges") > 0;
    const bool is_inside_out = entry.boundary_loops == 0 && shapes::volume(result.mesh) < 0;
    const bool has_open_labels = shapes::count(result.report, "features.open_label_edges") > 0;
    EXPECT_EQ(result.report.warnings().size(),
              std::size_t{has_flips} + std::size_t{is_inside_out} + std::size_t{has_open_labels});
    EXPECT_EQ(result.mesh.vertex_count(), entry.vertices - entry.unreferenced);
    EXPECT_EQ(result.mesh.face_count(), static_cast<Index>(input.corners.size()) - 2 * entry.faces);
    const Census counts = census(result.mesh);
    EXPECT_EQ(counts.boundary_loops, entry.boundary_loops);
    EXPECT_EQ(counts.components, entry.components);
    EXPECT_EQ(counts.genus, entry.genus);
  }
}

INSTANTIATE_TEST_SUITE_P(Folders, CleanModels,
                         testing::Values("scan", "cad", "genus", "open", "poly", "large"),
                         [](const auto& folder) { return std::string(folder.param); });

/// The mesh, or nothing where the file is refused as bad input. Any other error is a failure.
std::optional<ImportResult> try_import(const fs::path& path) {
  ReadReport report;
  try {
    return shapes::imported(read_mesh(path, report));
  } catch (const InputError& error) {
    EXPECT_GT(std::string(error.what()).size(), 10U);
    return std::nullopt;
  }
}

TEST(DirtyModels, EndInASoundMeshOrAClearRefusal) {
  STRAKE_MODELS_OR_SKIP(models);
  int seen = 0;
  for (const auto& entry : fs::directory_iterator(models / "dirty")) {
    SCOPED_TRACE(entry.path().filename().string());
    EXPECT_NO_THROW(try_import(entry.path()));
    ++seen;
  }
  EXPECT_GT(seen, 0);
}

struct Expectation {
  const char* file;
  Index components;
  Index boundary_loops;
  Index genus;
};

TEST(DirtyModels, RepairsFindTheSurfaceThatIsMeant) {
  STRAKE_MODELS_OR_SKIP(models);
  // What each file was made from, before it was damaged in the way its name says.
  for (const Expectation& expected : {Expectation{"igea_tristrips.ply", 1, 0, 0},
                                      {"awkward_syntax.obj", 1, 0, 0},
                                      {"big_endian_extras.ply", 1, 0, 0},
                                      {"faces_twice.off", 1, 0, 0},
                                      {"faces_both_sides.obj", 1, 0, 0},
                                      {"flipped_third.obj", 1, 0, 0},
                                      {"inside_out.off", 1, 0, 0},
                                      {"cubes_touching_on_edges.off", 3, 0, 0},
                                      {"hourglass_ico.obj", 2, 0, 0},
                                      {"pages_of_a_book.obj", 5, 5, 0},
                                      {"pinched.obj", 1, 0, 1},
                                      {"capsule.obj", 1, 0, 0},
                                      {"heart.stl", 1, 0, 0},
                                      {"tiny_scale.obj", 1, 0, 0},
                                      {"huge_scale.obj", 1, 0, 0},
                                      {"far_from_origin.ply", 1, 0, 1},
                                      {"far_vertex_unreferenced.obj", 1, 0, 0},
                                      {"overlapping_copies.ply", 3, 0, 0},
                                      {"specks_3000.ply", 3000, 0, 0},
                                      {"snapped_to_grid.ply", 1, 0, 0},
                                      {"negative_indices.obj", 1, 0, 0},
                                      {"comments.off", 1, 0, 0}}) {
    SCOPED_TRACE(expected.file);
    const auto result = try_import(models / "dirty" / expected.file);
    ASSERT_TRUE(result.has_value());
    const Census counts = census(result->mesh);
    EXPECT_EQ(counts.components, expected.components);
    EXPECT_EQ(counts.boundary_loops, expected.boundary_loops);
    EXPECT_EQ(counts.genus, expected.genus);
  }
}

TEST(DirtyModels, SoupsWeldToTheSameSurface) {
  STRAKE_MODELS_OR_SKIP(models);
  const auto exact = try_import(models / "dirty" / "soup_unwelded.off");
  const auto nearly = try_import(models / "dirty" / "soup_nearly_welded.ply");
  ASSERT_TRUE(exact.has_value() && nearly.has_value());
  EXPECT_EQ(exact->mesh.faces, nearly->mesh.faces);
  EXPECT_EQ(census(exact->mesh).boundary_loops, 0);
}

}  // namespace
}  // namespace strake
