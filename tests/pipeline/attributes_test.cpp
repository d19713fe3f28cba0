#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <set>

#include "common/artifact/meshfile/mesh_reader.h"
#include "common/artifact/meshfile/mesh_writer.h"
#include "tests/pipeline/run_program.h"
#include "tests/support/attributed.h"

namespace strake::pipeline_test {
namespace {

/// Colours, texture coordinates and labels from file to file, by the real programs.
class AttributeFiles : public ProgramTest {
 protected:
  [[nodiscard]] PolyMesh read(const std::string& name) const {
    ReadReport report;
    return read_mesh(file(name), report);
  }
};

TEST_F(AttributeFiles, LabelsAndColoursOfACube) {
  write_mesh(file("cube.obj"), support::labelled_cube(12));
  must("strake remesh cube.obj -o out.obj --vertices 400 -q --no-evaluate");
  must("strake remesh cube.obj -o out.ply --vertices 400 -q --no-evaluate --keep kept");
  const PolyMesh obj = read("out.obj");
  const PolyMesh ply = read("out.ply");
  ASSERT_EQ(obj.attributes.labels.size(), 1u);
  ASSERT_EQ(ply.attributes.labels.size(), 1u);
  const FaceLabels& labels = obj.attributes.labels[0];
  EXPECT_EQ(labels.name, "g");
  EXPECT_EQ(ply.attributes.labels[0].name, "g");
  const std::vector<std::string> names = {"right", "left", "top", "bottom", "front", "back"};
  const auto side_of_face = [](const PolyMesh& mesh, Index f) {
    Vec3 middle = Vec3::Zero();
    for (const Index v : mesh.face(f)) middle += mesh.positions[v];
    return support::side_of(middle);
  };
  ASSERT_EQ(ply.face_count(), obj.face_count());
  for (Index f = 0; f < obj.face_count(); ++f) {
    EXPECT_EQ(labels.names[labels.of_face[f]], names[side_of_face(obj, f)]) << f;
    EXPECT_EQ(ply.attributes.labels[0].of_face[f], side_of_face(ply, f)) << f;
  }
  // The sides are flat, so fitting has no reason to move vertices off the place they come from; but
  // T-joints are moved into line, by small parts of their edges.
  ASSERT_EQ(obj.attributes.colour.size(), obj.positions.size());
  for (Index v = 0; v < obj.vertex_count(); ++v) {
    const Colour expected = support::linear_colour(obj.positions[v]);
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(ply.attributes.colour[v][i], obj.attributes.colour[v][i], 0.5001 / 255);
      EXPECT_NEAR(obj.attributes.colour[v][i], expected[i], 0.05);
    }
  }
  // The stages one by one, and export, give the same.
  must("strake-export kept/fitted.hdf -o again.obj -q");
  EXPECT_EQ(bytes("again.obj"), bytes("out.obj"));
  must("strake check kept/mesh.hdf");
  must("strake check kept/fitted.hdf");
}

TEST_F(AttributeFiles, TextureCoordinatesOfATube) {
  write_mesh(file("tube.obj"), support::seamed_tube(60, 20));
  must("strake remesh tube.obj -o out.obj --vertices 300 -q --no-evaluate");
  const PolyMesh mesh = read("out.obj");
  ASSERT_EQ(mesh.attributes.texture.size(), mesh.corners.size());
  double covered = 0;  // area of the faces in the plane of texture coordinates
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const Index first = mesh.offsets[f];
    const Index count = mesh.offsets[f + 1] - first;
    for (Index i = 0; i < count; ++i) {
      const auto& [s, t] = mesh.attributes.texture[first + i];
      const auto& [s1, t1] = mesh.attributes.texture[first + (i + 1) % count];
      covered += 0.5 * (s * t1 - t * s1);
    }
  }
  // Boundary and seam are kept, so the faces cover the rectangle from (0, 0) to (1, 2) once. Fitted
  // vertices lie beside the tube's edges by rounding, where each face looks on its own side.
  EXPECT_NEAR(covered, 2, 1e-7);
}

TEST_F(AttributeFiles, MaterialsAreFoundFromTheResult) {
  PolyMesh cube = support::labelled_cube(6);
  cube.attributes.labels[0].name = "usemtl";
  cube.attributes.material_files = {"paints.mtl"};
  write_mesh(file("cube.obj"), cube);
  std::filesystem::create_directories(file("deep/er"));
  const std::string flags = " --vertices 150 -q --no-evaluate";
  must("strake remesh cube.obj -o beside.obj --keep kept" + flags);
  must("strake remesh cube.obj -o deep/er/out.obj" + flags);
  const auto files = [&](const char* name) { return read(name).attributes.material_files; };
  EXPECT_EQ(files("beside.obj"), std::vector<std::string>{"paints.mtl"});
  EXPECT_EQ(files("deep/er/out.obj"), std::vector<std::string>{"../../paints.mtl"});
  EXPECT_EQ(read("beside.obj").attributes.labels[0].name, "usemtl");
  must("strake-export kept/fitted.hdf -o again.obj -q");
  EXPECT_EQ(bytes("again.obj"), bytes("beside.obj"));
}

/// A flat sheet of n x n unit cells; vertex j (n + 1) + i is at (i, j).
PolyMesh sheet(int n) {
  PolyMesh mesh;
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) mesh.positions.emplace_back(i, j, 0);
  }
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const Index a = j * (n + 1) + i;
      mesh.add_face(std::array<Index, 4>{a, a + 1, a + n + 2, a + n + 1});
    }
  }
  return mesh;
}

TEST_F(AttributeFiles, ListedEdgesAreEdgesOfTheResult) {
  // A bent line across a flat sheet of 20 x 20: up to (9, 8), then right to the boundary.
  const int n = 20;
  write_mesh(file("sheet.obj"), sheet(n));
  std::string list = "\xEF\xBB\xBF# up, as some editors write it\n\n";
  for (int j = 0; j <= 8; ++j) list += std::to_string(j * (n + 1) + 9) + " ";
  list += "  # and to the right\r\n";
  for (int i = 9; i < n; ++i) {
    list += std::to_string(8 * (n + 1) + i) + "\t" + std::to_string(8 * (n + 1) + i + 1) + "\n";
  }
  put("edges.txt", list);
  must(
      "strake remesh sheet.obj -o out.obj --vertices 60 -q --no-evaluate --feature-edges edges.txt "
      "--keep k");
  // The length of those edges of the result that lie on the line.
  const PolyMesh mesh = read("out.obj");
  double along = 0;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(f);
    for (std::size_t i = 0; i < face.size(); ++i) {
      const Vec3& p = mesh.positions[face[i]];
      const Vec3& q = mesh.positions[face[(i + 1) % face.size()]];
      const auto is_on = [&](auto place) { return place(p) && place(q); };
      constexpr double kNear = 1e-9;
      if (is_on([](const Vec3& v) { return std::abs(v.x() - 9) < kNear && v.y() < 8 + kNear; }) ||
          is_on([](const Vec3& v) { return std::abs(v.y() - 8) < kNear && v.x() > 9 - kNear; })) {
        along += 0.5 * (q - p).norm();  // each edge has two faces
      }
    }
  }
  EXPECT_NEAR(along, 8 + 11, 1e-9);
  // The stages one by one give the same, and the list is part of what the result was made from.
  must("strake-import sheet.obj -o mesh.hdf -q --feature-edges edges.txt");
  EXPECT_EQ(bytes("mesh.hdf"), bytes("k/mesh.hdf"));
  EXPECT_NE(must("strake info mesh.hdf").find("from feature-edges"), std::string::npos);
}

TEST_F(AttributeFiles, ListsOfEdgesThatMakeNoSenseAreRefused) {
  write_mesh(file("sheet.obj"), sheet(4));
  const std::vector<std::pair<std::string, std::string>> lists = {
      {"0 1\n1 two\n", "'edges.txt', line 2: 'two' is no vertex number"},
      {"0 1.5\n", "line 1: '1.5' is no vertex number"},
      {"# first\n0 -1\n", "line 2: '-1' is no vertex number"},
      {"3\n", "line 1: vertex 3 stands alone"},
      {"0 1 1 2\n", "line 1: vertex 1 follows itself"},
      {"0 1\n\n24 25\n", "line 3: there is no vertex 25, the mesh has 25"},
      {"0 1 12\n", "line 1: no edge joins vertices 1 and 12"}};
  for (const auto& [text, message] : lists) {
    put("edges.txt", text);
    const std::string flags = " -q --feature-edges edges.txt";
    must_fail(3, "strake-import sheet.obj -o mesh.hdf" + flags, message);
    must_fail(3, "strake remesh sheet.obj -o out.obj" + flags, message);
  }
  must_fail(3, "strake-import sheet.obj -o mesh.hdf -q --feature-edges none.txt", "none.txt");
  put("hole.obj", "v nan 0 0\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 2 3 4\n");
  put("edges.txt", "1 2\n0 2\n");
  must_fail(3, "strake-import hole.obj -o mesh.hdf -q --feature-edges edges.txt",
            "line 2: vertex 0 lies nowhere");
}

TEST_F(AttributeFiles, AreToldByInfo) {
  put("box.obj",
      "v 0 0 0 1 0 0\nv 2 0 0 1 0 0\nv 2 3 0 1 0 0\nv 0 3 .5 1 0 0\nvt 0 0\n"
      "usemtl steel\nf 1/1 2/1 3/1\nusemtl brass\nf 1/1 3/1 4/1\n");
  const std::string told = must("strake info box.obj");
  EXPECT_NE(told.find("size       2 x 3 x 0.5\n"), std::string::npos);
  EXPECT_NE(told.find("carries    vertex colours, texture coordinates, labels usemtl (2)\n"),
            std::string::npos);
  put("plain.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_EQ(must("strake info plain.obj").find("carries"), std::string::npos);
}

TEST_F(AttributeFiles, CanBeLeftOut) {
  const std::string wrong = "the texture will be wrong in the faces across them";
  const auto warnings = [&](const std::string& options) {
    return run("strake-import tube.obj -o " + options).err;
  };
  write_mesh(file("tube.obj"), support::seamed_tube(40, 10));
  EXPECT_EQ(warnings("seamed.hdf").find(wrong), std::string::npos);
  EXPECT_EQ(warnings("mesh.hdf --no-attributes --attribute-features none").find(wrong),
            std::string::npos);
  EXPECT_NE(warnings("carried.hdf --attribute-features none").find(wrong), std::string::npos);
  PolyMesh plain = support::seamed_tube(40, 10);
  plain.attributes = {};
  write_mesh(file("plain.obj"), plain);
  must("strake-import plain.obj -o plain.hdf -q");
  EXPECT_EQ(must("strake info mesh.hdf").find("texture"), std::string::npos);
  EXPECT_NE(must("strake info carried.hdf").find("texture"), std::string::npos);
  const auto mesh_id = [&](const std::string& name) {
    const std::string info = must("strake info " + name);
    return info.substr(info.find("mesh  "), 48);
  };
  EXPECT_EQ(mesh_id("mesh.hdf"), mesh_id("plain.hdf"));
  EXPECT_EQ(mesh_id("carried.hdf"), mesh_id("plain.hdf"));
}

}  // namespace
}  // namespace strake::pipeline_test
