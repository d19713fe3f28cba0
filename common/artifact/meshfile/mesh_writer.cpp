#include "common/artifact/meshfile/mesh_writer.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>

#include "common/artifact/atomic_file.h"
#include "common/core/error.h"

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
    const char* at = buffer_.data();
    std::size_t left = buffer_.size();
    while (left > 0) {
      const ssize_t written = ::write(descriptor_, at, left);
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) fail();
      at += written;
      left -= static_cast<std::size_t>(written);
    }
    buffer_.clear();
  }
  [[noreturn]] void fail() const {
    throw InputError(fmt::format("cannot write '{}': {}", name_, std::strerror(errno)));
  }

  std::string name_;
  std::string buffer_;
  int descriptor_ = -1;
};

void write_obj(const PolyMesh& mesh, OutputFile& out) {
  for (const Vec3& p : mesh.positions) out.print("v {} {} {}\n", p.x(), p.y(), p.z());
  for (Index f = 0; f < mesh.face_count(); ++f) {
    out.print("f");
    for (const Index v : mesh.face(f)) out.print(" {}", v + 1);
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

void write_ply(const PolyMesh& mesh, OutputFile& out) {
  std::size_t most_sides = 0;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    most_sides = std::max(most_sides, mesh.face(f).size());
  }
  const bool small = most_sides <= UINT8_MAX;
  out.print(
      "ply\nformat binary_little_endian 1.0\n"
      "element vertex {}\nproperty double x\nproperty double y\nproperty double z\n"
      "element face {}\nproperty list {} int vertex_indices\nend_header\n",
      mesh.vertex_count(), mesh.face_count(), small ? "uchar" : "uint");
  for (const Vec3& p : mesh.positions) out.write(p.data(), sizeof(Vec3));
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(f);
    const auto sides = static_cast<std::uint32_t>(face.size());
    out.write(&sides, small ? 1 : sizeof(sides));  // the low byte comes first
    out.write(face.data(), face.size_bytes());
  }
}

}  // namespace

void write_mesh(const std::filesystem::path& path, const PolyMesh& mesh) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension != ".obj" && extension != ".ply" && extension != ".off") {
    throw UsageError(
        fmt::format("cannot write '{}': the extension must be .obj, .ply or .off", path.string()));
  }
  AtomicFile file(path);
  OutputFile out(file.temporary(), path.string());
  if (extension == ".obj") write_obj(mesh, out);
  if (extension == ".ply") write_ply(mesh, out);
  if (extension == ".off") write_off(mesh, out);
  out.close();
  file.commit();
}

}  // namespace strake
