#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include "common/artifact/meshfile/mesh_reader.h"
#include "common/core/error.h"

namespace strake {
namespace {

PolyMesh parse(const std::string& text, ReadReport& report, const std::string& extension = "") {
  return parse_mesh(text, extension, report);
}

PolyMesh parse(const std::string& text) {
  ReadReport report;
  PolyMesh mesh = parse(text, report);
  EXPECT_TRUE(report.warnings().empty()) << report.warnings().front();
  return mesh;
}

std::vector<Index> face(const PolyMesh& mesh, Index f) {
  return {mesh.face(f).begin(), mesh.face(f).end()};
}

using Corners = std::vector<Index>;

// --- OBJ

TEST(ReadObj, KeepsDoublesExactly) {
  const PolyMesh mesh = parse("v 0.1 1e-300 -123456789.123456789\nv +1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_EQ(mesh.positions[0], Vec3(0.1, 1e-300, -123456789.123456789));
  EXPECT_EQ(mesh.positions[1], Vec3(1, 0, 0));
}

TEST(ReadObj, UnderstandsEveryKindOfCorner) {
  ReadReport report;
  const PolyMesh mesh = parse_mesh(
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nvn 0 0 1\n"
      "f 1 2 3\nf 1/1 2/1 3/1\nf 1//1 2//1 3//1\nf 1/1/1 2/1/1 3/1/1\nf 1// 2// 3//\n"
      "f -4 -3 -2 -1\n",
      ".obj", report);
  EXPECT_EQ(report.untextured_corners, 13);  // of 19
  ASSERT_EQ(mesh.face_count(), 6);
  for (Index f = 0; f < 5; ++f) EXPECT_EQ(face(mesh, f), Corners({0, 1, 2})) << f;
  EXPECT_EQ(face(mesh, 5), Corners({0, 1, 2, 3}));
}

TEST(ReadObj, RelativeIndicesCountFromWhereTheyStand) {
  const PolyMesh mesh =
      parse("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 0 0 1\nv 1 0 1\nv 0 1 1\nf -3 -2 -1\n");
  EXPECT_EQ(face(mesh, 0), Corners({0, 1, 2}));
  EXPECT_EQ(face(mesh, 1), Corners({3, 4, 5}));
}

TEST(ReadObj, LinesEndInAnyWayAndContinue) {
  const Corners expected = {0, 1, 2};
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    std::string text = "# head@v 0 0 0 1 1 1@v\t1 0 0@@  v 0 1 \\@ 0@g a b@f 1 \\@2 3 # tail";
    for (std::size_t at = text.find('@'); at != std::string::npos; at = text.find('@')) {
      text.replace(at, 1, end);
    }
    const PolyMesh mesh = parse(text);
    ASSERT_EQ(mesh.face_count(), 1);
    EXPECT_EQ(mesh.vertex_count(), 3);
    EXPECT_EQ(face(mesh, 0), expected);
  }
}

TEST(ReadObj, SkipsAndCountsWhatCannotBeUsed) {
  ReadReport report;
  const PolyMesh mesh = parse(
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv nan 0 0\nv 1,5 0 0\nv 1 2\nv 1.#IND 0 0\n"
      "f 1 2 3\nf 0 1 2\nf 1 2 99\nf 1 2 99999999999999999999\nf -99 1 2\nf 1 2\nf 1\n"
      "f 1 2 4\nf 1 2 5\nf 1 2 6\nf 1 2 7\nf 1 2 x\n0.5 1\nsm 3\n",
      report);
  EXPECT_EQ(mesh.vertex_count(), 7);
  EXPECT_EQ(mesh.face_count(), 1);
  EXPECT_EQ(report.non_finite_vertices, 4);
  EXPECT_EQ(report.bad_index_faces, 5);
  EXPECT_EQ(report.few_corner_faces, 2);
  EXPECT_EQ(report.non_finite_faces, 4);
  EXPECT_EQ(report.skipped_lines, 1);
}

// --- OFF

TEST(ReadOff, VariantsCommentsAndLineBreaks) {
  for (const std::string text :
       {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "OFF 3 1 3\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2",
        "# c\nOFF # c\n# c\n3 1\n\n0 0 0 # c\n1 0 0\n\n0 1 0\n# c\n3 0 1 2 255 0 0\n",
        "COFF\n3 1 0\n0 0 0 255 0 0 255\n1 0 0 1 1 1 1\n0 1 0 1 1 1 1\n3 0 1 2 0.5 0.5 0.5\n",
        "NOFF\n3 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2\n",
        "STCNOFF\r\n3 1 0\r\n0 0 0 0 0 1 9 9 9 9 0 0\r\n1 0 0\r\n0 1 0\r\n3\r\n0\r\n1\r\n2\r\n"}) {
    const PolyMesh mesh = parse(text);
    ASSERT_EQ(mesh.face_count(), 1) << text;
    EXPECT_EQ(face(mesh, 0), Corners({0, 1, 2})) << text;
    EXPECT_EQ(mesh.positions[2], Vec3(0, 1, 0)) << text;
  }
}

TEST(ReadOff, CountsWhatIsMissing) {
  ReadReport report;
  const PolyMesh mesh = parse("OFF\n3 9 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 1\n", report);
  EXPECT_EQ(mesh.face_count(), 1);
  EXPECT_EQ(report.missing_faces, 8);
}

TEST(ReadOff, SaysWhatItLeavesOut) {
  ReadReport report;
  const std::string text = "OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n";
  EXPECT_EQ(parse(text + "\n# end\n").face_count(), 1);
  EXPECT_EQ(parse(text + "3 0 2 3\nend\n3 2 3 0 1 1 1\n3 0", report).face_count(), 1);
  EXPECT_EQ(report.left_out_faces, 2);
  EXPECT_EQ(report.skipped_lines, 1);
  EXPECT_EQ(report.warnings().size(), 2U);
}

TEST(ReadOff, RefusesBinaryAndHigherDimensions) {
  ReadReport report;
  EXPECT_THROW(parse("OFF BINARY\n\0\0", report), InputError);
  EXPECT_THROW(parse("4OFF\n3 1 0\n0 0 0 1\n", report), InputError);
  EXPECT_THROW(parse("OFF\nmany 1 0\n", report), InputError);
}

// --- STL

void append(std::string& bytes, const void* data, std::size_t size) {
  bytes.append(static_cast<const char*>(data), size);
}

std::string binary_stl(const std::vector<std::array<float, 9>>& facets, std::uint32_t announced,
                       const std::string& title = "title") {
  std::string bytes = title;
  bytes.resize(80, ' ');
  append(bytes, &announced, sizeof(announced));
  for (const auto& facet : facets) {
    bytes.append(12, '\0');
    append(bytes, facet.data(), sizeof(facet));
    bytes.append(2, '\0');
  }
  return bytes;
}

const std::vector<std::array<float, 9>> kTwoFacets = {{0, 0, 0, 1, 0, 0, 0, 1, 0},
                                                      {1, -0.0F, 0, 1, 1, 0, -0.0F, 1, -0.0F}};

TEST(ReadStl, WeldsEqualCoordinatesAlsoOfBothZeros) {
  ReadReport report;
  const PolyMesh mesh = parse(binary_stl(kTwoFacets, 2), report);
  EXPECT_EQ(mesh.vertex_count(), 4);
  EXPECT_EQ(report.welded_vertices, 2);
  EXPECT_EQ(face(mesh, 0), Corners({0, 1, 2}));
  EXPECT_EQ(face(mesh, 1), Corners({1, 3, 2}));
}

TEST(ReadStl, BinaryMayBeginWithSolid) {
  const PolyMesh mesh = parse(binary_stl(kTwoFacets, 2, "solid thing"));
  EXPECT_EQ(mesh.face_count(), 2);
}

TEST(ReadStl, DoesNotBelieveTheCount) {
  ReadReport report;
  const PolyMesh mesh = parse(binary_stl(kTwoFacets, 2000000000), report, ".stl");
  EXPECT_EQ(mesh.face_count(), 2);
  EXPECT_EQ(report.missing_faces, 2000000000 - 2);
}

TEST(ReadStl, ReadsMoreThanAnnouncedWhereAllIsFacets) {
  ReadReport report;
  const std::string bytes = binary_stl(kTwoFacets, 1);
  EXPECT_EQ(parse(bytes, report, ".stl").face_count(), 2);
  EXPECT_EQ(report.unannounced_faces, 1);
  EXPECT_EQ(report.warnings().size(), 1U);
  EXPECT_EQ(parse(bytes + "tail", report, ".stl").face_count(), 1);
  EXPECT_EQ(report.left_out_faces, 1);
  EXPECT_EQ(report.warnings().size(), 1U);
  EXPECT_EQ(parse(binary_stl(kTwoFacets, 2) + "tail", report, ".stl").face_count(), 2);
  EXPECT_TRUE(report.warnings().empty());
}

TEST(ReadStl, Ascii) {
  ReadReport report;
  const PolyMesh mesh = parse(
      "solid a thing\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n"
      "   vertex 0 1e0 0\n  endloop\n endfacet\nFACET NORMAL 0 0 1 OUTER LOOP VERTEX 1 0 0 "
      "VERTEX 1 1 0 VERTEX -0 1 0 ENDLOOP ENDFACET\nendsolid a thing\n facet normal 0 0 1\n"
      " outer loop\n vertex 5 5 5\n",
      report);
  EXPECT_EQ(mesh.face_count(), 2);
  EXPECT_EQ(face(mesh, 1), Corners({1, 3, 2}));
  EXPECT_EQ(report.missing_faces, 1);
}

// --- PLY

TEST(ReadPly, CountsOfNothingAddUpToTheLargestNumber) {
  const std::string faces =
      "element face 9223372036854775807\nproperty list uchar int vertex_indices\n";
  ReadReport report;
  parse(
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\n" +
          faces + faces + "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
      report, ".ply");
  EXPECT_EQ(report.missing_faces, std::numeric_limits<std::int64_t>::max());
}

template <typename Value>
void put(std::string& bytes, Value value, bool big_endian) {
  std::array<char, sizeof(Value)> raw;
  std::memcpy(raw.data(), &value, sizeof(Value));
  if (big_endian) std::reverse(raw.begin(), raw.end());
  bytes.append(raw.data(), raw.size());
}

/// Two triangles with foreign properties and elements all around, in either byte order.
std::string rich_ply(bool big_endian) {
  std::string bytes = std::string("ply\r\nformat binary_") + (big_endian ? "big" : "little") +
                      "_endian 1.0\r\ncomment any\r\nobj_info any\r\n"
                      "element camera 1\r\nproperty list uint double matrix\r\n"
                      "element vertex 4\r\nproperty uchar flag\r\nproperty double y\r\n"
                      "property list ushort int16 extra\r\nproperty float x\r\nproperty int32 z\r\n"
                      "element face 2\r\nproperty list int8 float uv\r\n"
                      "property list uint16 uint32 vertex_index\r\nproperty char tail\r\n"
                      "element tristrips 1\r\nproperty list int int vertex_indices\r\n"
                      "end_header\r\n";
  const auto add = [&](auto value) { put(bytes, value, big_endian); };
  add(std::uint32_t{2}), add(1.0), add(2.0);
  for (int v = 0; v < 4; ++v) {
    add(std::uint8_t{7}), add(0.1 * (v / 2)), add(std::uint16_t{1}), add(std::int16_t{-3});
    add(static_cast<float>(v % 2)), add(std::int32_t{-v});
  }
  for (const std::array<std::uint32_t, 3> f : {std::array<std::uint32_t, 3>{0, 1, 2}, {1, 3, 2}}) {
    add(std::int8_t{2}), add(0.5F), add(0.5F), add(std::uint16_t{3});
    for (const std::uint32_t v : f) add(v);
    add(char{1});
  }
  add(std::int32_t{9});
  for (const std::int32_t v : {0, 1, 2, 3, -1, 3, 2, 1, 0}) add(v);
  return bytes;
}

TEST(ReadPly, BothByteOrdersAllTypesAndForeignData) {
  for (const bool big_endian : {false, true}) {
    const PolyMesh mesh = parse(rich_ply(big_endian));
    ASSERT_EQ(mesh.vertex_count(), 4);
    EXPECT_EQ(mesh.positions[3], Vec3(1, 0.1, -3));
    ASSERT_EQ(mesh.face_count(), 6);
    EXPECT_EQ(face(mesh, 1), Corners({1, 3, 2}));
    // Strips turn every other triangle over, and begin anew after -1.
    EXPECT_EQ(face(mesh, 2), Corners({0, 1, 2}));
    EXPECT_EQ(face(mesh, 3), Corners({2, 1, 3}));
    EXPECT_EQ(face(mesh, 4), Corners({3, 2, 1}));
    EXPECT_EQ(face(mesh, 5), Corners({1, 2, 0}));
  }
}

TEST(ReadPly, EveryTruncationIsRefusedOrCounted) {
  const std::string whole = rich_ply(false);
  const std::size_t header = whole.find("end_header");
  for (std::size_t size = 0; size < whole.size(); ++size) {
    ReadReport report;
    try {
      const PolyMesh mesh = parse(whole.substr(0, size), report, ".ply");
      EXPECT_GT(size, header);
      EXPECT_FALSE(report.warnings().empty()) << size;
      EXPECT_GT(report.missing_faces, 0) << size;
    } catch (const InputError&) {
    }
  }
}

TEST(ReadPly, AsciiWithExtraColumnsAndBadNumbers) {
  ReadReport report;
  const PolyMesh mesh = parse(
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
      "property float z\nelement face 3\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0 99\n1 0 0\n0 1 0.1\n1 oops 0\n3 0 1 2\n3 0 1 3\n4 0 1",
      report);
  EXPECT_EQ(mesh.positions[2].z(), 0.1);
  EXPECT_EQ(mesh.face_count(), 1);
  EXPECT_EQ(report.non_finite_vertices, 1);
  EXPECT_EQ(report.non_finite_faces, 1);
  EXPECT_EQ(report.missing_faces, 1);
}

TEST(ReadPly, HugeCountsAllocateNothing) {
  const std::string header =
      "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000000\nproperty float x\n"
      "property float y\nproperty float z\nelement face 4000000000000\n"
      "property list uint int vertex_indices\nend_header\n";
  ReadReport report;
  EXPECT_THROW(parse(header + std::string(100, '\xff'), report), InputError);
  EXPECT_THROW(parse("OFF\n4000000000000 4000000000000 0\n0 0 0\n", report), InputError);
}

TEST(ReadPly, RefusesDamagedHeaders) {
  ReadReport report;
  for (const std::string header :
       {"ply\n", "ply\nformat ascii 1.0\nelement vertex 3\n", "ply\nformat morse 1.0\nend_header\n",
        "ply\nelement vertex 0\nend_header\n",
        "ply\nformat ascii 1.0\nproperty int x\nend_header\n",
        "ply\nformat ascii 1.0\nelement vertex -3\nend_header\n",
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty word x\nend_header\n1\n",
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty int x\nend_header\n1\n"}) {
    EXPECT_THROW(parse(header, report), InputError) << header;
  }
}

// --- recognition

TEST(Recognition, VerticesWithoutFacesAreNamed) {
  ReadReport report;
  try {
    parse_mesh("v 0 0 0\nv 1 0 0\nv 0 1 0\n", ".obj", report);
    ADD_FAILURE() << "a file without faces was read";
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("3 vertices but no faces"), std::string::npos) << message;
    EXPECT_NE(message.find("cut off"), std::string::npos) << message;
    EXPECT_NE(message.find("point cloud"), std::string::npos) << message;
  }
  // Those that are there, and of no use, are another matter.
  try {
    parse_mesh("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\n", ".obj", report);
    ADD_FAILURE() << "a face of two corners was read";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("no usable face"), std::string::npos);
  }
}

TEST(Recognition, ContentGoesBeforeTheName) {
  ReadReport report;
  const PolyMesh mesh = parse("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", report, ".ply");
  EXPECT_EQ(mesh.face_count(), 1);
  EXPECT_EQ(report.format, "OBJ");
  EXPECT_TRUE(report.extension_differs);
  ASSERT_EQ(report.warnings().size(), 1U);
}

TEST(Recognition, UnknownContentIsRefused) {
  ReadReport report;
  EXPECT_THROW(parse("", report), InputError);
  EXPECT_THROW(parse("COFFEE\n3 1 0\n", report, ".off"), InputError);
  EXPECT_THROW(parse("just some words\n", report, ".txt"), InputError);
  EXPECT_THROW(parse("just some words\n", report, ".obj"), InputError);
  EXPECT_THROW(read_mesh("there/is/no/such/file.obj", report), InputError);
}

}  // namespace
}  // namespace strake
