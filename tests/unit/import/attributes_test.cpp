#include "common/core/attributes.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "common/artifact/meshfile/material_files.h"
#include "common/artifact/meshfile/mesh_reader.h"
#include "common/artifact/meshfile/mesh_writer.h"
#include "common/geometry/samples/samples.h"
#include "tests/support/attributed.h"
#include "tests/unit/import/shapes.h"

namespace strake {
namespace {

namespace fs = std::filesystem;

/// Tests run side by side, and each has files of its own.
fs::path own_file(const std::string& name) {
  return fs::path(testing::TempDir()) / ("strake-" + std::to_string(::getpid()) + "-" + name);
}

PolyMesh parsed(const std::string& text, const std::string& extension) {
  ReadReport report;
  PolyMesh mesh = parse_mesh(text, extension, report);
  EXPECT_TRUE(report.warnings().empty());
  return mesh;
}

TEST(Attributes, OfAnObjFile) {
  ReadReport report;  // one corner has no texture coordinates
  const PolyMesh mesh = parse_mesh(
      "mtllib my parts.mtl\nmtllib b.mtl c.mtl\nmtllib my parts.mtl\n"
      "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 0 0 1\nv 0 1 0\n"
      "vt 0 0\nvt 1 0\nvt 1 1\nvt 0.5 0.25\n"
      "g first\nusemtl red paint\nf 1/1 2/2/9 3/-2\ng second\nf 1//4 3/3 4/4\n",
      ".obj", report);
  const std::vector<Colour> colours = {{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}, {1, 1, 1, 1}};
  EXPECT_EQ(mesh.attributes.colour, colours);
  const std::vector<TexturePoint> texture = {{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0.5, 0.25}};
  EXPECT_EQ(mesh.attributes.texture, texture);
  const std::vector<FaceLabels> labels = {{"g", {0, 1}, {"first", "second"}},
                                          {"usemtl", {0, 0}, {"red paint"}}};
  EXPECT_EQ(mesh.attributes.labels, labels);
  const std::vector<std::string> files = {"my parts.mtl", "b.mtl c.mtl"};
  EXPECT_EQ(mesh.attributes.material_files, files);
  // No face has a material of theirs.
  EXPECT_EQ(parsed("mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n", ".obj").attributes,
            Attributes{});
  EXPECT_TRUE(parsed("v 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nf 1 2 3\n", ".obj").attributes.empty());
}

TEST(Attributes, MaterialFilesAreNamedFromWhereAResultIs) {
  const fs::path folder = fs::path(testing::TempDir()) / "strake_materials";
  fs::create_directories(folder / "in");
  std::ofstream(folder / "in" / "my parts.mtl") << "newmtl a\n";
  const auto seen = [&](const std::vector<std::string>& files, const char* to) {
    return material_files_seen_from(files, folder / "in" / "a.obj", folder / to / "b.obj");
  };
  using Files = std::vector<std::string>;
  EXPECT_EQ(seen({"my parts.mtl", "b.mtl c.mtl"}, "in/../in"),
            Files({"my parts.mtl", "b.mtl c.mtl"}));
  EXPECT_EQ(seen({"my parts.mtl", "b.mtl sub/c.mtl"}, "out/deep"),
            Files({"../../in/my parts.mtl", "../../in/b.mtl", "../../in/sub/c.mtl"}));
  EXPECT_EQ(seen({"/elsewhere/d.mtl"}, "out"), Files({"/elsewhere/d.mtl"}));
  fs::remove_all(folder);
}

TEST(Attributes, ColoursALittleAboveOneAreShares) {
  const auto first = [](const std::string& red) {
    const std::string text = "v 0 0 0 " + red + " 0 0\nv 1 0 0 0.5 0 0\nv 1 1 0 0 0 0\nf 1 2 3\n";
    return parsed(text, ".obj").attributes.colour;
  };
  EXPECT_EQ(first("1.0001")[0][0], 1);
  EXPECT_EQ(first("1.0001")[1][0], 0.5);
  EXPECT_EQ(first("51")[0][0], 0.2);
}

/// An ascii PLY file of one triangle with these properties and values of its vertices.
std::string triangle_ply(const std::string& properties, const std::array<const char*, 3>& values) {
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\n" +
      properties + "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const std::array<const char*, 3> places = {"0 0 0 ", "1 0 0 ", "1 1 0 "};
  for (int v = 0; v < 3; ++v) text += places[v] + (values[v] + std::string("\n"));
  return text + "3 0 1 2\n";
}

TEST(Attributes, FloatingPointColoursOfAPlyFileMayBeBytes) {
  std::string properties;
  for (const std::string name : {"red", "green", "blue", "alpha"}) {
    properties += "property float " + name + "\n";
  }
  const auto colours = [&](const std::array<const char*, 3>& values) {
    return parsed(triangle_ply(properties, values), ".ply").attributes.colour;
  };
  using Colours = std::vector<Colour>;
  EXPECT_EQ(colours({"255 51 0 255", "0 102 0 0", "0 0 300 51"}),
            (Colours{{1, 0.2, 0, 1}, {0, 0.4, 0, 0}, {0, 0, 1, 0.2}}));
  EXPECT_EQ(colours({"255 51 0 1", "0 102 0 0.5", "0 0 0 1"}),
            (Colours{{1, 0.2, 0, 1}, {0, 0.4, 0, 0.5}, {0, 0, 0, 1}}));
  EXPECT_EQ(colours({"1 0.5 -1 1", "0 1.0001 0 0", "0 0 nan 0.25"}),
            (Colours{{1, 0.5, 0, 1}, {0, 1, 0, 0}, {0, 0, 1, 0.25}}));
}

TEST(Attributes, OfFacesThatAreSkippedAreSkipped) {
  ReadReport report;
  const PolyMesh mesh = parse_mesh(
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 9 9\n"
      "g bad\nf 1/4 2/4 7/4\ng good\nf 1/1 2/2 3/3\n",
      ".obj", report);
  EXPECT_EQ(report.bad_index_faces, 1);
  EXPECT_EQ(mesh.attributes.texture, (std::vector<TexturePoint>{{0, 0}, {1, 0}, {1, 1}}));
  EXPECT_EQ(mesh.attributes.labels[0].of_face, std::vector<Index>{1});
}

TEST(Attributes, OfAPlyFile) {
  const std::string vertices =
      "property float x\nproperty float y\nproperty float z\nproperty uchar red\n"
      "property uchar green\nproperty uchar blue\n";
  const PolyMesh mesh = parsed(
      "ply\nformat ascii 1.0\nelement vertex 3\n" + vertices +
          "property float s\nproperty float t\nelement face 1\n"
          "property list uchar int vertex_indices\nproperty int label\nproperty float quality\n"
          "end_header\n0 0 0 255 0 0 0 1\n1 0 0 0 51 0 0.5 1\n1 1 0 0 0 0 0.25 0\n3 2 0 1 -4 0.5\n",
      ".ply");
  EXPECT_EQ(mesh.attributes.colour[1], (Colour{0, 0.2, 0, 1}));
  EXPECT_EQ(mesh.attributes.texture, (std::vector<TexturePoint>{{0.25, 0}, {0, 1}, {0.5, 1}}));
  EXPECT_EQ(mesh.attributes.labels, (std::vector<FaceLabels>{{"label", {-4}, {}}}));
  const PolyMesh corners =
      parsed("ply\nformat ascii 1.0\nelement vertex 3\n" + vertices +
                 "element face 1\nproperty list uchar int vertex_indices\n"
                 "property list uchar float texcoord\nend_header\n0 0 0 1 1 1\n1 0 0 1 1 1\n"
                 "1 1 0 1 1 1\n3 0 1 2 6 0 0.5 1 0.5 1 1\n",
             ".ply");
  EXPECT_EQ(corners.attributes.texture, (std::vector<TexturePoint>{{0, 0.5}, {1, 0.5}, {1, 1}}));
}

TEST(Attributes, CornersWithoutTextureAreTold) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0.5 1\n";
  ReadReport report;
  const PolyMesh mesh = parse_mesh(vertices + "f 1/1 2/1 3/1\nf 1 3 4/1\n", ".obj", report);
  EXPECT_EQ(report.untextured_corners, 2);
  EXPECT_EQ(report.warnings().size(), 1U);
  EXPECT_EQ(mesh.attributes.texture[3], (TexturePoint{0, 0}));
  (void)parse_mesh(vertices + "f 1 2 3\nf 1 3 4\n", ".obj", report);  // where none has any
  EXPECT_EQ(report.untextured_corners, 0);
  EXPECT_TRUE(report.warnings().empty());
}

/// An ascii PLY file of two triangles, the texture coordinates of each in a list.
std::string square_ply(const std::string& first, const std::string& second) {
  return "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
         "property float z\nproperty float s\nproperty float t\nelement face 2\n"
         "property list uchar int vertex_indices\nproperty list uchar float texcoord\nend_header\n"
         "0 0 0 0.5 1\n1 0 0 0.5 1\n1 1 0 0.5 1\n0 1 0 0.5 1\n3 0 1 2 " +
         first + "\n3 0 2 3 " + second + "\n";
}

TEST(Attributes, CornersWithoutTextureInAPlyFileAreTold) {
  ReadReport report;
  const auto texture = [&](const std::string& first, const std::string& second) {
    return parse_mesh(square_ply(first, second), ".ply", report).attributes.texture;
  };
  using Texture = std::vector<TexturePoint>;
  const std::string whole = "6 0.1 0.2 0.3 0.4 0.5 0.6";
  EXPECT_EQ(texture(whole, "0"),
            (Texture{{0.1, 0.2}, {0.3, 0.4}, {0.5, 0.6}, {0, 0}, {0, 0}, {0, 0}}));
  EXPECT_EQ(report.untextured_corners, 3);
  EXPECT_EQ(report.warnings().size(), 1U);
  EXPECT_EQ(texture("3 0.1 0.2 0.3", whole)[1], (TexturePoint{0, 0}));
  EXPECT_EQ(report.untextured_corners, 2);
  EXPECT_EQ(texture(whole, whole)[3], (TexturePoint{0.1, 0.2}));
  EXPECT_EQ(report.untextured_corners, 0);
  // Where no face has any, those of the vertices.
  EXPECT_EQ(texture("0", "0"), Texture(6, TexturePoint{0.5, 1}));
  EXPECT_TRUE(report.warnings().empty());
}

/// Hashes, as segmentations have, of which those from 2^31 on were all the same.
TEST(Attributes, LabelsWithoutASignStayApart) {
  const auto label = [](const std::string& type, const std::string& value) {
    return parsed(
               "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
               "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
               "property " +
                   type + " label\nend_header\n0 0 0\n1 0 0\n1 1 0\n3 0 1 2 " + value + "\n",
               ".ply")
        .attributes.labels[0]
        .of_face[0];
  };
  EXPECT_EQ(label("uint", "2147483647"), 2147483647);
  EXPECT_EQ(label("uint", "2147483648"), -2147483647 - 1);
  EXPECT_NE(label("uint", "3000000000"), label("uint", "4000000000"));
  EXPECT_EQ(label("uint", "4294967295"), -1);
}

/// A mesh with everything.
PolyMesh decorated() {
  PolyMesh mesh = support::seamed_tube(8, 3);
  support::colour_linearly(mesh);
  FaceLabels labels{"g", {}, {"lower", "upper"}};
  for (Index f = 0; f < mesh.face_count(); ++f) labels.of_face.push_back(f < 8 ? 0 : 1);
  FaceLabels materials{"usemtl", labels.of_face, {"red", "green"}};
  mesh.attributes.labels = {labels, materials};
  mesh.attributes.material_files = {"paints.mtl"};
  return mesh;
}

TEST(Attributes, AreWrittenAndReadBack) {
  const PolyMesh mesh = decorated();
  for (const char* extension : {".obj", ".ply"}) {
    const fs::path path =
        fs::path(testing::TempDir()) / ("strake_attributes" + std::string(extension));
    write_mesh(path, mesh);
    ReadReport report;
    const Attributes back = read_mesh(path, report).attributes;
    EXPECT_TRUE(report.warnings().empty());
    fs::remove(path);
    if (extension == std::string(".obj")) {
      EXPECT_EQ(back, mesh.attributes);
      continue;
    }
    ASSERT_EQ(back.colour.size(), mesh.attributes.colour.size());
    for (std::size_t v = 0; v < back.colour.size(); ++v) {
      for (int i = 0; i < 4; ++i) {
        EXPECT_NEAR(back.colour[v][i], mesh.attributes.colour[v][i], 0.5001 / 255);
      }
    }
    ASSERT_EQ(back.texture.size(), mesh.attributes.texture.size());
    for (std::size_t c = 0; c < back.texture.size(); ++c) {
      EXPECT_NEAR(back.texture[c][0], mesh.attributes.texture[c][0], 1e-7);
    }
    EXPECT_EQ(back.labels[0].of_face, mesh.attributes.labels[0].of_face);
  }
}

/// Every corner of the imported mesh has what the input has at that place of that face.
void expect_carried(const PolyMesh& input, const TriMesh& mesh) {
  ASSERT_EQ(mesh.attributes.texture.size(), 3 * mesh.faces.size());
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    const Vec3 p = mesh.positions[mesh.from(h)] + mesh.origin;
    const Index f = mesh.source_face[h / 3];
    bool found = false;
    for (Index c = input.offsets[f]; c < input.offsets[f + 1]; ++c) {
      if ((input.positions[input.corners[c]] - p).norm() > 1e-9) continue;
      found = true;
      EXPECT_EQ(mesh.attributes.texture[h], input.attributes.texture[c]);
    }
    EXPECT_TRUE(found);
    for (int i = 0; i < 4; ++i) {
      EXPECT_NEAR(mesh.attributes.colour[mesh.from(h)][i], support::linear_colour(p)[i], 1e-12);
    }
    EXPECT_EQ(mesh.attributes.labels[0].of_face[h / 3], input.attributes.labels[0].of_face[f]);
  }
  EXPECT_EQ(mesh.attributes.material_files, input.attributes.material_files);
}

/// Programs begin another object at every statement: faces of a part are written together.
TEST(Attributes, ObjHasEveryPartOnce) {
  PolyMesh cube = shapes::cube();
  cube.attributes.labels = {{"usemtl", {1, 0, 1, 0, 1, 1}, {"steel", "wood"}},
                            {"o", {1, 0, 0, 1, 0, 1}, {"seat", "leg"}}};
  const fs::path path = own_file("parts.obj");
  write_mesh(path, cube);
  ReadReport report;
  const Attributes read = read_mesh(path, report).attributes;
  std::ifstream file(path);
  std::vector<std::string> statements;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("o ") || line.starts_with("usemtl ")) statements.push_back(line);
  }
  fs::remove(path);
  EXPECT_EQ(statements, (std::vector<std::string>{"o leg", "usemtl wood", "usemtl steel", "o seat",
                                                  "usemtl wood", "usemtl steel"}));
  ASSERT_EQ(read.labels.size(), 2u);
  EXPECT_EQ(read.labels[0].of_face, (std::vector<Index>{0, 0, 0, 1, 1, 1}));
  EXPECT_EQ(read.labels[1].of_face, (std::vector<Index>{0, 0, 1, 0, 0, 1}));
}

/// What is written of parts, and what is read back.
std::pair<std::vector<std::string>, PolyMesh> parts_written(const PolyMesh& mesh) {
  const fs::path path = own_file("parts.obj");
  write_mesh(path, mesh);
  std::pair<std::vector<std::string>, PolyMesh> result;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("o") || line.starts_with("usemtl")) result.first.push_back(line);
  }
  ReadReport report;
  result.second = read_mesh(path, report);
  fs::remove(path);
  return result;
}

/// A statement must have a name; faces before the first one have none.
TEST(Attributes, FacesOfNoPartComeBeforeTheFirstStatement) {
  PolyMesh cube = shapes::cube();
  const std::vector<std::string> materials = {"", "red"};
  cube.attributes.labels = {{"usemtl", {1, 1, 0, 0, 1, 0}, materials}};
  const auto [lines, read] = parts_written(cube);
  EXPECT_EQ(lines, (std::vector<std::string>{"usemtl red"}));
  EXPECT_EQ(read.attributes.labels,
            (std::vector<FaceLabels>{{"usemtl", {0, 0, 0, 1, 1, 1}, materials}}));
  // The object that has them comes first.
  cube.attributes.labels.push_back({"o", {1, 1, 0, 0, 1, 0}, {"seat", "leg"}});
  EXPECT_EQ(parts_written(cube).first, (std::vector<std::string>{"o seat", "o leg", "usemtl red"}));
  // Only one can.
  cube.attributes.labels[0].of_face = {0, 1, 0, 1, 0, 0};
  EXPECT_EQ(parts_written(cube).first, (std::vector<std::string>{"o leg", "usemtl red", "o seat",
                                                                 "usemtl default", "usemtl red"}));
}

TEST(Attributes, EveryKindOfLabelsIsAStatementOfItsOwn) {
  PolyMesh mesh = shapes::cube();
  const std::vector<std::string> kinds = {"label", "usemtl", "region", "part"};
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    FaceLabels labels{kinds[i], {}, {}};
    for (Index f = 0; f < 6; ++f) labels.of_face.push_back(f / (static_cast<Index>(i) + 1));
    mesh.attributes.labels.push_back(labels);
  }
  const fs::path path = own_file("labels.obj");
  write_mesh(path, mesh);
  ReadReport report;
  const PolyMesh read = read_mesh(path, report);
  fs::remove(path);
  // Object, group and material as these are listed; there is no statement for a fourth.
  ASSERT_EQ(read.attributes.labels.size(), 3u);
  EXPECT_EQ(read.attributes.labels[0].of_face, mesh.attributes.labels[2].of_face);
  EXPECT_EQ(read.attributes.labels[1].of_face, mesh.attributes.labels[0].of_face);
  EXPECT_EQ(read.attributes.labels[2].of_face, mesh.attributes.labels[1].of_face);
}

TEST(Attributes, SurviveTriangulationAndOrdering) {
  const PolyMesh mesh = decorated();
  expect_carried(mesh, shapes::imported(mesh).mesh);
}

TEST(Attributes, SurviveWeldingAndTurning) {
  // Every face with vertices of its own, and every third one turned over.
  const PolyMesh mesh = decorated();
  PolyMesh soup;
  soup.attributes.labels = mesh.attributes.labels;
  soup.attributes.material_files = mesh.attributes.material_files;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    std::vector<Index> face;
    for (int i = 0; i < 4; ++i) {
      const Index c = mesh.offsets[f] + (f % 3 == 0 ? 3 - i : i);
      face.push_back(soup.vertex_count());
      soup.positions.push_back(mesh.positions[mesh.corners[c]]);
      soup.attributes.texture.push_back(mesh.attributes.texture[c]);
    }
    soup.add_face(face);
  }
  support::colour_linearly(soup);
  const ImportResult result = shapes::imported(soup);
  EXPECT_GT(shapes::count(result.report, "repairs.flipped_faces"), 0);
  EXPECT_GT(shapes::count(result.report, "repairs.welded_vertices"), 0);
  expect_carried(soup, result.mesh);
}

TEST(Attributes, BordersAreFeatures) {
  const PolyMesh mesh = decorated();
  const auto edges = [&](const char* which) {
    ImportOptions options = shapes::undivided();
    options.feature_angle_deg = 180;
    options.attribute_features = which;
    const TriMesh result = shapes::imported(mesh, options).mesh;
    return std::count(result.is_feature.begin(), result.is_feature.end(), 1) / 2;
  };
  EXPECT_EQ(edges("none"), 0);
  EXPECT_EQ(edges("labels"), 8);
  EXPECT_EQ(edges("seams"), 3);
  EXPECT_EQ(edges("all"), 11);
  ImportOptions without;
  without.no_attributes = true;
  EXPECT_TRUE(shapes::imported(mesh, without).mesh.attributes.empty());
}

TEST(Attributes, BordersOfLabelsThatAreNotKeptAreSaid) {
  const auto warnings = [](const PolyMesh& mesh, const char* which) {
    ImportOptions options = shapes::undivided();
    options.attribute_features = which;
    const ImportResult result = shapes::imported(mesh, options);
    return std::ranges::count_if(result.report.warnings(), [](const std::string& warning) {
      return warning.find("--attribute-features all") != std::string::npos;
    });
  };
  EXPECT_EQ(warnings(decorated(), "seams"), 1);
  EXPECT_EQ(warnings(decorated(), "all"), 0);
  // All its edges are creases.
  PolyMesh cube = shapes::cube();
  cube.attributes.labels = {{"g", {0, 1, 2, 3, 4, 5}, {}}};
  EXPECT_EQ(warnings(cube, "seams"), 0);
}

/// Texture coordinates from the place of each corner.
template <typename Place>
PolyMesh textured(PolyMesh mesh, const Place& place) {
  for (const Index v : mesh.corners) mesh.attributes.texture.push_back(place(mesh.positions[v]));
  return mesh;
}

std::ptrdiff_t feature_edges(const PolyMesh& mesh) {
  const TriMesh result = shapes::imported(mesh, shapes::undivided()).mesh;
  return std::ranges::count(result.is_feature, 1) / 2;
}

// Two halves share their part of a picture; between places on both sides would be neither's.
TEST(Attributes, LinesWhereTextureTurnsBackAreFeatures) {
  const PolyMesh plane = shapes::grid(8, 5, [](double, double) { return 0.0; });
  const auto mirrored = [](const Vec3& p) { return TexturePoint{std::abs(p.x() - 0.5), p.y()}; };
  const auto whole = [](const Vec3& p) { return TexturePoint{p.x(), p.y()}; };
  EXPECT_EQ(feature_edges(textured(plane, mirrored)), 5);
  EXPECT_EQ(feature_edges(textured(plane, whole)), 0);
}

// A picture that is projected through an object turns back along its outline, where it is thin.
TEST(Attributes, OutlinesOfProjectedTextureAreNoFeatures) {
  SampleOptions options;
  options.faces = 3000;
  const PolyMesh sphere = make_sample(SampleKind::sphere, options);
  for (const Vec3& axis : {Vec3(0, 0, 1), Vec3(1, 2, 3).normalized()}) {
    const Vec3 u = axis.unitOrthogonal();
    const Vec3 v = axis.cross(u);
    const auto projected = [&](const Vec3& p) { return TexturePoint{u.dot(p), v.dot(p)}; };
    EXPECT_EQ(feature_edges(textured(sphere, projected)), 0);
  }
}

}  // namespace
}  // namespace strake
