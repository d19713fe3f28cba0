#include "common/artifact/meshfile/mesh_writer.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <iterator>
#include <map>
#include <numeric>
#include <string>
#include <string_view>
#include <utility>

#include "common/artifact/atomic_file.h"
#include "common/core/error.h"
#include "common/core/text.h"

namespace strake {
namespace {

static_assert(std::endian::native == std::endian::little, "binary PLY is written as it lies");

/// Collects output in blocks and checks every write.
class OutputFile {
 public:
  OutputFile(const std::filesystem::path& path, std::string name) : name_(std::move(name)) {
    descriptor_ = ::open(path.c_str(), O_WRONLY | O_TRUNC | O_CLOEXEC);
    if (descriptor_ < 0) fail();
    buffer_.reserve(kBlock + kSlack);
  }
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }

  template <typename... Args>
  void print(fmt::format_string<Args...> text, Args&&... args) {
    fmt::format_to(std::back_inserter(buffer_), text, std::forward<Args>(args)...);
    if (buffer_.size() >= kBlock) flush();
  }
  void write(const void* data, std::size_t size) {
    buffer_.append(static_cast<const char*>(data), size);
    if (buffer_.size() >= kBlock) flush();
  }
  void close() {
    flush();
    const int descriptor = descriptor_;
    descriptor_ = -1;
    if (::close(descriptor) != 0) fail();
  }

 private:
  static constexpr std::size_t kBlock = 1 << 20;
  static constexpr std::size_t kSlack = 1 << 12;

  void flush() {
    if (!write_all(descriptor_, buffer_.data(), buffer_.size())) fail();
    buffer_.clear();
  }
  [[noreturn]] void fail() const {
    throw InputError(fmt::format("cannot write '{}': {}", name_, std::strerror(errno)));
  }

  std::string name_;
  std::string buffer_;
  int descriptor_ = -1;
};

/// Numbers different texture coordinates in order of appearance.
class TextureNumbers {
 public:
  explicit TextureNumbers(const std::vector<TexturePoint>& corners) {
    std::map<TexturePoint, Index> numbers;
    of_corner_.reserve(corners.size());
    for (const TexturePoint& point : corners) {
      const auto [at, is_new] = numbers.try_emplace(point, static_cast<Index>(points_.size()));
      if (is_new) points_.push_back(point);
      of_corner_.push_back(at->second);
    }
  }
  [[nodiscard]] const std::vector<TexturePoint>& points() const { return points_; }
  [[nodiscard]] Index of_corner(Index corner) const { return of_corner_[corner]; }

 private:
  std::vector<TexturePoint> points_;
  std::vector<Index> of_corner_;
};

/// A kind of labels and the OBJ statement for it.
struct Part {
  std::string_view statement;
  const FaceLabels* labels;

  /// Whether the label of a face is the empty name: the face came before the first statement.
  [[nodiscard]] bool is_nameless(Index face) const {
    const Index number = labels->of_face[face];
    return number >= 0 && static_cast<std::size_t>(number) < labels->names.size() &&
           labels->names[number].empty();
  }
};

/// What OBJ has for each kind of labels, objects first and materials last: its own statement, or
/// for those of other formats the next one that is free, groups first. A fourth kind has none.
std::vector<Part> parts_of(const std::vector<FaceLabels>& kinds) {
  std::vector<Part> parts = {{"o", nullptr}, {"g", nullptr}, {"usemtl", nullptr}};
  for (const FaceLabels& labels : kinds) {
    const auto own = std::ranges::find(parts, labels.name, &Part::statement);
    if (own != parts.end() && own->labels == nullptr) own->labels = &labels;
  }
  for (const FaceLabels& labels : kinds) {
    if (std::ranges::find(parts, &labels, &Part::labels) != parts.end()) continue;
    for (Part* const part : {&parts[1], &parts[0], &parts[2]}) {
      if (part->labels != nullptr) continue;
      part->labels = &labels;
      break;
    }
  }
  std::erase_if(parts, [](const Part& part) { return part.labels == nullptr; });
  return parts;
}

void print_part(const Part& part, Index face, OutputFile& out) {
  const Index number = part.labels->of_face[face];
  if (part.is_nameless(face)) {
    out.print("{} default\n", part.statement);  // a statement must have a name
  } else if (number >= 0 && static_cast<std::size_t>(number) < part.labels->names.size()) {
    out.print("{} {}\n", part.statement, part.labels->names[number]);
  } else {
    out.print("{} {}_{}\n", part.statement, part.labels->name, number);
  }
}

/// The faces of an object together, in it those of a group, and in that those of a material, in
/// order of appearance: programs begin another part at every statement. What has no name comes
/// first, as no statement can follow another to say so, and the parts that hold such come next.
std::vector<Index> faces_by_part(Index face_count, const std::vector<Part>& parts) {
  std::vector<Index> faces(static_cast<std::size_t>(face_count));
  std::iota(faces.begin(), faces.end(), 0);
  // What matters least first: sorting keeps that order where the next is equal.
  for (auto part = parts.rbegin(); part != parts.rend(); ++part) {
    const std::vector<Index>& label = part->labels->of_face;
    std::map<Index, std::size_t> appearance;
    const auto add_where = [&](const auto& is_next) {
      for (Index f = 0; f < face_count; ++f) {
        if (is_next(f)) appearance.try_emplace(label[f], appearance.size());
      }
    };
    add_where([&](Index f) { return part->is_nameless(f); });
    add_where([&](Index f) {
      return std::ranges::any_of(parts, [&](const Part& any) { return any.is_nameless(f); });
    });
    add_where([](Index) { return true; });
    std::ranges::stable_sort(faces, {}, [&](Index f) { return appearance.at(label[f]); });
  }
  return faces;
}

void write_obj(const PolyMesh& mesh, OutputFile& out) {
  const Attributes& attributes = mesh.attributes;
  for (const std::string& files : attributes.material_files) out.print("mtllib {}\n", files);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const Vec3& p = mesh.positions[v];
    out.print("v {} {} {}", p.x(), p.y(), p.z());
    if (!attributes.colour.empty()) {
      const Colour& c = attributes.colour[v];
      out.print(" {} {} {}", c[0], c[1], c[2]);
    }
    out.print("\n");
  }
  const TextureNumbers texture(attributes.texture);
  for (const auto& [s, t] : texture.points()) out.print("vt {} {}\n", s, t);
  const std::vector<Part> parts = parts_of(attributes.labels);
  std::vector<std::uint8_t> has_begun(parts.size(), 0);
  Index last = kNone;
  for (const Index f : faces_by_part(mesh.face_count(), parts)) {
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const std::vector<Index>& label = parts[i].labels->of_face;
      if (last != kNone && label[f] == label[last]) continue;
      if (has_begun[i] == 0 && parts[i].is_nameless(f)) continue;
      print_part(parts[i], f, out);
      has_begun[i] = 1;
    }
    last = f;
    out.print("f");
    for (Index c = mesh.offsets[f]; c < mesh.offsets[f + 1]; ++c) {
      out.print(" {}", mesh.corners[c] + 1);
      if (!attributes.texture.empty()) out.print("/{}", texture.of_corner(c) + 1);
    }
    out.print("\n");
  }
}

void write_off(const PolyMesh& mesh, OutputFile& out) {
  out.print("OFF\n{} {} 0\n", mesh.vertex_count(), mesh.face_count());
  for (const Vec3& p : mesh.positions) out.print("{} {} {}\n", p.x(), p.y(), p.z());
  for (Index f = 0; f < mesh.face_count(); ++f) {
    out.print("{}", mesh.face(f).size());
    for (const Index v : mesh.face(f)) out.print(" {}", v);
    out.print("\n");
  }
}

std::size_t most_sides(const PolyMesh& mesh) {
  std::size_t most = 0;
  for (Index f = 0; f < mesh.face_count(); ++f) most = std::max(most, mesh.face(f).size());
  return most;
}

/// Writes PLY, each kind of attribute by the names that other programs read.
class PlyWriter {
 public:
  PlyWriter(const PolyMesh& mesh, OutputFile& out)
      : mesh_(mesh),
        attributes_(mesh.attributes),
        out_(out),
        // The texture coordinates of a face are counted in a byte.
        has_texture_(!attributes_.texture.empty() && 2 * most_sides(mesh) <= UINT8_MAX),
        has_small_faces_(most_sides(mesh) <= UINT8_MAX) {
    has_alpha_ = std::any_of(attributes_.colour.begin(), attributes_.colour.end(),
                             [](const Colour& c) { return c[3] != 1; });
  }

  void write() {
    print_header();
    for (Index v = 0; v < mesh_.vertex_count(); ++v) write_vertex(v);
    for (Index f = 0; f < mesh_.face_count(); ++f) write_face(f);
  }

 private:
  void print_header() {
    out_.print("ply\nformat binary_little_endian 1.0\n");
    for (const FaceLabels& labels : attributes_.labels) {
      for (std::size_t i = 0; i < labels.names.size(); ++i) {
        out_.print("comment {} {} is {}\n", labels.name, i, labels.names[i]);
      }
    }
    out_.print("element vertex {}\nproperty double x\nproperty double y\nproperty double z\n",
               mesh_.vertex_count());
    if (!attributes_.colour.empty()) {
      out_.print("property uchar red\nproperty uchar green\nproperty uchar blue\n");
      if (has_alpha_) out_.print("property uchar alpha\n");
    }
    out_.print("element face {}\nproperty list {} int vertex_indices\n", mesh_.face_count(),
               has_small_faces_ ? "uchar" : "uint");
    if (has_texture_) out_.print("property list uchar float texcoord\n");
    for (const FaceLabels& labels : attributes_.labels)
      out_.print("property int {}\n", labels.name);
    out_.print("end_header\n");
  }

  void write_vertex(Index v) {
    out_.write(mesh_.positions[v].data(), sizeof(Vec3));
    if (attributes_.colour.empty()) return;
    for (int i = 0; i < (has_alpha_ ? 4 : 3); ++i) {
      write_byte(std::lround(std::clamp(attributes_.colour[v][i], 0.0, 1.0) * UINT8_MAX));
    }
  }

  void write_face(Index f) {
    const auto face = mesh_.face(f);
    const auto sides = static_cast<std::uint32_t>(face.size());
    out_.write(&sides, has_small_faces_ ? 1 : sizeof(sides));  // the low byte comes first
    out_.write(face.data(), face.size_bytes());
    if (has_texture_) {
      write_byte(2 * static_cast<long>(sides));
      for (Index c = mesh_.offsets[f]; c < mesh_.offsets[f + 1]; ++c) {
        for (const double value : attributes_.texture[c]) {
          const auto single = static_cast<float>(value);
          out_.write(&single, sizeof(single));
        }
      }
    }
    for (const FaceLabels& labels : attributes_.labels) {
      out_.write(&labels.of_face[f], sizeof(Index));
    }
  }

  void write_byte(long value) {
    const auto byte = static_cast<std::uint8_t>(value);
    out_.write(&byte, 1);
  }

  const PolyMesh& mesh_;
  const Attributes& attributes_;
  OutputFile& out_;
  bool has_texture_;
  bool has_small_faces_;
  bool has_alpha_ = false;
};

}  // namespace

void write_mesh(const std::filesystem::path& path, const PolyMesh& mesh) {
  const std::string extension = lower_case(path.extension().string());
  if (extension != ".obj" && extension != ".ply" && extension != ".off") {
    throw UsageError(
        fmt::format("cannot write '{}': the extension must be .obj, .ply or .off", path.string()));
  }
  AtomicFile file(path);
  OutputFile out(file.temporary(), path.string());
  if (extension == ".obj") write_obj(mesh, out);
  if (extension == ".ply") PlyWriter(mesh, out).write();
  if (extension == ".off") write_off(mesh, out);
  out.close();
  file.commit();
}

}  // namespace strake
