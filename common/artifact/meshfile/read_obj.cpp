#include <algorithm>
#include <cctype>
#include <string_view>

#include "common/artifact/meshfile/formats.h"
#include "common/artifact/meshfile/text_scanner.h"
#include "common/core/error.h"

namespace strake::meshfile {
namespace {

/// The vertex of the next corner "v", "v/t", "v//n" or "v/t/n"; texture and normal are ignored.
Index read_corner(TextScanner& scanner, Index vertex_count) {
  std::int64_t index = 0;
  const bool valid = scanner.integer(index);
  const bool clean = scanner.at_word_end() || *scanner.position() == '/';
  scanner.skip_word();
  if (!valid || !clean || index == 0) return kNone;
  return index > 0 ? to_index(index - 1) : to_index(vertex_count + index);
}

void read_face(TextScanner& scanner, PolyMesh& mesh) {
  while (scanner.skip_blanks()) {
    mesh.corners.push_back(read_corner(scanner, mesh.vertex_count()));
  }
  check_countable(mesh.corners.size(), "face corners");
  mesh.offsets.push_back(static_cast<Index>(mesh.corners.size()));
}

Vec3 read_vertex(TextScanner& scanner) {
  Vec3 position;
  for (int i = 0; i < 3; ++i) scanner.number(position[i]);
  return position;
}

bool is_other_keyword(std::string_view word) {
  for (const std::string_view known :
       {"vt",         "vn",        "vp",    "o",        "g",        "s",    "l",      "p",
        "usemtl",     "mtllib",    "mg",    "fo",       "cstype",   "deg",  "bmat",   "step",
        "curv",       "curv2",     "surf",  "parm",     "trim",     "hole", "scrv",   "sp",
        "end",        "con",       "bevel", "c_interp", "d_interp", "lod",  "maplib", "usemap",
        "shadow_obj", "trace_obj", "ctech", "stech",    "call",     "csh",  "xyz",    "rgb"}) {
    if (word == known) return true;
  }
  return false;
}

/// Whether a line that begins so may be a statement that some program added to the format.
bool is_statement(std::string_view word) {
  return std::isalpha(static_cast<unsigned char>(word.front())) != 0 &&
         std::all_of(word.begin(), word.end(),
                     [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; });
}

}  // namespace

bool looks_like_obj(std::string_view bytes) {
  constexpr int kLines = 2000;
  TextScanner scanner(bytes, '#');
  for (int line = 0; line < kLines && scanner.skip_space(); ++line) {
    const std::string_view word = scanner.word();
    if (word == "v") {
      double x = 0;
      double y = 0;
      return scanner.number(x) && scanner.number(y);
    }
    if (!is_other_keyword(word)) return false;
    scanner.next_line();
  }
  return false;
}

PolyMesh read_obj(std::string_view bytes, ReadReport& report) {
  report.format = "OBJ";
  PolyMesh mesh;
  TextScanner scanner(bytes, '#');
  for (; scanner.skip_space(); scanner.next_line()) {
    const std::string_view word = scanner.word();
    if (word == "v") {
      mesh.positions.push_back(read_vertex(scanner));
    } else if (word == "f") {
      read_face(scanner, mesh);
    } else if (!is_statement(word)) {
      ++report.skipped_lines;
    }
  }
  check_countable(mesh.positions.size(), "vertices");
  if (mesh.positions.empty()) throw InputError("holds no vertices; it does not look like OBJ");
  return mesh;
}

}  // namespace strake::meshfile
