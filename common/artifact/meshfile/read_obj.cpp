#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "common/artifact/meshfile/formats.h"
#include "common/artifact/meshfile/text_scanner.h"
#include "common/core/error.h"

namespace strake::meshfile {
namespace {

/// Reads an index that counts from 1, or from the end where it is negative; kNone where there is
/// none.
Index read_index(TextScanner& scanner, std::size_t count) {
  std::int64_t index = 0;
  if (!scanner.integer(index) || index == 0) return kNone;
  return to_index(index > 0 ? index - 1 : static_cast<std::int64_t>(count) + index);
}

/// Collects what an OBJ file says, line by line.
class ObjReader {
 public:
  /// "v x y z", optionally with a weight and a colour.
  void add_vertex(TextScanner& scanner) {
    Vec3 position;
    for (int i = 0; i < 3; ++i) scanner.number(position[i]);
    mesh_.positions.push_back(position);
    std::array<double, 4> rest{};
    int count = 0;
    while (count < 4 && scanner.number(rest[count])) ++count;
    if (count < 3) return;
    const double* rgb = rest.data() + (count - 3);
    attributes().colour.resize(mesh_.positions.size() - 1, kWhite);
    attributes().colour.push_back({rgb[0], rgb[1], rgb[2], 1});
  }

  /// "vt s t"
  void add_texture_point(TextScanner& scanner) {
    TexturePoint point{};
    for (double& value : point) {
      scanner.number(value);
      if (!std::isfinite(value)) value = 0;
    }
    texture_points_.push_back(point);
  }

  void add_face(TextScanner& scanner) {
    while (scanner.skip_blanks()) add_corner(scanner);
    check_countable(mesh_.corners.size(), "face corners");
    mesh_.offsets.push_back(static_cast<Index>(mesh_.corners.size()));
    for (Layer& layer : layers_) {
      if (layer.is_used) layer.labels.of_face.push_back(layer.present);
    }
  }

  /// "o name", "g name" or "usemtl name": what the faces after it belong to.
  /// \return whether the word is one of these
  bool start_part(std::string_view word, TextScanner& scanner) {
    for (Layer& layer : layers_) {
      if (layer.labels.name != word) continue;
      if (!layer.is_used) start_layer(layer);
      layer.present = layer.number(rest_of_line(scanner));
      return true;
    }
    return false;
  }

  /// "mtllib file..."
  void add_material_files(TextScanner& scanner) {
    std::string files = rest_of_line(scanner);
    if (!files.empty() && std::ranges::find(material_files_, files) == material_files_.end()) {
      material_files_.push_back(std::move(files));
    }
  }

  PolyMesh finish(ReadReport& report) {
    check_countable(mesh_.positions.size(), "vertices");
    if (mesh_.positions.empty()) throw InputError("holds no vertices; it does not look like OBJ");
    if (!attributes().colour.empty()) attributes().colour.resize(mesh_.positions.size(), kWhite);
    if (!corner_texture_.empty()) {
      corner_texture_.resize(mesh_.corners.size(), kNone);
      attributes().texture.reserve(mesh_.corners.size());
      for (const Index t : corner_texture_) {
        const bool is_there = t != kNone && static_cast<std::size_t>(t) < texture_points_.size();
        attributes().texture.push_back(is_there ? texture_points_[t] : TexturePoint{});
        if (!is_there) ++report.untextured_corners;
      }
    }
    if (layers_.back().is_used) attributes().material_files = std::move(material_files_);
    for (Layer& layer : layers_) {
      if (layer.is_used) attributes().labels.push_back(std::move(layer.labels));
    }
    return std::move(mesh_);
  }

 private:
  static constexpr Colour kWhite = {1, 1, 1, 1};

  /// Labels of one kind, and the one that is in force.
  struct Layer {
    FaceLabels labels;
    bool is_used = false;
    Index present = 0;
    std::map<std::string, Index, std::less<>> numbers = {};

    Index number(const std::string& name) {
      const auto [at, is_new] = numbers.try_emplace(name, static_cast<Index>(labels.names.size()));
      if (is_new) labels.names.push_back(name);
      return at->second;
    }
  };

  Attributes& attributes() { return mesh_.attributes; }

  /// A corner "v", "v/t", "v//n" or "v/t/n"; normals are ignored.
  void add_corner(TextScanner& scanner) {
    Index vertex = read_index(scanner, mesh_.positions.size());
    Index texture = kNone;
    if (!scanner.at_word_end() && *scanner.position() == '/') {
      scanner.skip_character();
      texture = read_index(scanner, texture_points_.size());
    } else if (!scanner.at_word_end()) {
      vertex = kNone;
    }
    scanner.skip_word();
    mesh_.corners.push_back(vertex);
    if (texture != kNone || !corner_texture_.empty()) {
      corner_texture_.resize(mesh_.corners.size() - 1, kNone);
      corner_texture_.push_back(texture);
    }
  }

  /// Faces before the first statement of a kind have the label "".
  void start_layer(Layer& layer) {
    layer.is_used = true;
    if (mesh_.face_count() == 0) return;
    layer.labels.of_face.assign(mesh_.face_count(), layer.number(""));
  }

  static std::string rest_of_line(TextScanner& scanner) {
    std::string text;
    for (std::string_view word = scanner.word(); !word.empty(); word = scanner.word()) {
      text += (text.empty() ? "" : " ") + std::string(word);
    }
    return text;
  }

  PolyMesh mesh_;
  std::vector<TexturePoint> texture_points_;
  std::vector<Index> corner_texture_;  ///< [C], or empty while no corner names one
  std::array<Layer, 3> layers_ = {Layer{{"o", {}, {}}}, Layer{{"g", {}, {}}},
                                  Layer{{"usemtl", {}, {}}}};
  std::vector<std::string> material_files_;
};

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
  ObjReader reader;
  TextScanner scanner(bytes, '#');
  for (; scanner.skip_space(); scanner.next_line()) {
    const std::string_view word = scanner.word();
    if (word == "v") {
      reader.add_vertex(scanner);
    } else if (word == "f") {
      reader.add_face(scanner);
    } else if (word == "vt") {
      reader.add_texture_point(scanner);
    } else if (word == "mtllib") {
      reader.add_material_files(scanner);
    } else if (!reader.start_part(word, scanner) && !is_statement(word)) {
      ++report.skipped_lines;
    }
  }
  return reader.finish(report);
}

}  // namespace strake::meshfile
