#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "common/artifact/meshfile/formats.h"
#include "common/artifact/meshfile/text_scanner.h"
#include "common/core/error.h"

namespace strake::meshfile {
namespace {

/// A magic word of OFF: [ST][C][N][4][n]OFF.
bool is_magic_word(std::string_view word) {
  const auto skip = [&](std::string_view prefix) {
    if (word.starts_with(prefix)) word.remove_prefix(prefix.size());
  };
  for (const std::string_view prefix : {"ST", "C", "N", "4", "n"}) skip(prefix);
  return word == "OFF";
}

bool next_number(TextScanner& scanner, double& value) {
  return scanner.skip_space() && scanner.number(value);
}

std::int64_t read_count(TextScanner& scanner, const char* what) {
  std::int64_t count = -1;
  if (!scanner.skip_space() || !scanner.integer(count) || count < 0) {
    throw InputError(fmt::format("is an OFF file without a sensible number of {}", what));
  }
  return count;
}

/// Reads up to `count` vertices: three numbers, then columns to ignore up to the end of the line.
void read_vertices(TextScanner& scanner, std::int64_t count, PolyMesh& mesh) {
  constexpr std::size_t kShortestVertex = 6;
  mesh.positions.reserve(std::min<std::size_t>(count, scanner.remaining() / kShortestVertex + 1));
  for (std::int64_t v = 0; v < count; ++v) {
    Vec3 position;
    for (int i = 0; i < 3; ++i) {
      if (!next_number(scanner, position[i])) return;
    }
    mesh.positions.push_back(position);
    scanner.next_line();
  }
}

bool read_face(TextScanner& scanner, PolyMesh& mesh, ReadReport& report) {
  std::int64_t sides = -1;
  if (!scanner.skip_space()) return false;
  if (!scanner.integer(sides) || sides < 0) {
    ++report.skipped_lines;
    return true;
  }
  const std::size_t first = mesh.corners.size();
  for (std::int64_t i = 0; i < sides; ++i) {
    std::int64_t index = -1;
    if (!scanner.skip_space()) {
      mesh.corners.resize(first);
      return false;
    }
    const bool valid = scanner.integer(index);
    if (!valid) scanner.skip_word();
    mesh.corners.push_back(valid ? to_index(index) : kNone);
  }
  check_countable(mesh.corners.size(), "face corners");
  mesh.offsets.push_back(static_cast<Index>(mesh.corners.size()));
  return true;
}

/// Counts the faces that follow, and the lines that are none.
std::int64_t count_faces(TextScanner& scanner, ReadReport& report) {
  std::int64_t count = 0;
  PolyMesh face;
  while (read_face(scanner, face, report)) {
    count += face.face_count();
    face = {};
    scanner.next_line();
  }
  return count;
}

}  // namespace

bool looks_like_off(std::string_view bytes) {
  TextScanner scanner(bytes.substr(0, 1 << 16), '#');
  return scanner.skip_space() && is_magic_word(scanner.word());
}

PolyMesh read_off(std::string_view bytes, ReadReport& report) {
  report.format = "OFF";
  TextScanner scanner(bytes, '#');
  scanner.skip_space();
  const std::string_view magic = scanner.word();
  if (!is_magic_word(magic)) {
    throw InputError("does not begin with the word OFF; it is no OFF file");
  }
  if (magic.find_first_of("4n") != std::string_view::npos) {
    throw InputError("holds vertices of more than three dimensions, which is not supported");
  }
  scanner.skip_space();
  if (TextScanner(scanner).word() == "BINARY") {
    throw InputError("is a binary OFF file, which is not supported; convert it to PLY");
  }
  const std::int64_t vertices = read_count(scanner, "vertices");
  const std::int64_t faces = read_count(scanner, "faces");
  scanner.next_line();  // the number of edges, often wrong or absent
  check_countable(std::min<std::size_t>(vertices, scanner.remaining()), "vertices");

  PolyMesh mesh;
  read_vertices(scanner, vertices, mesh);
  report.missing_vertices = vertices - static_cast<std::int64_t>(mesh.positions.size());
  std::int64_t read = 0;
  while (read < faces && read_face(scanner, mesh, report)) {
    ++read;
    scanner.next_line();
  }
  report.missing_faces = faces - read;
  if (report.missing_faces == 0) report.left_out_faces = count_faces(scanner, report);
  return mesh;
}

}  // namespace strake::meshfile
