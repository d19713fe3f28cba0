#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <cstring>
#include <string_view>
#include <vector>

#include "common/artifact/meshfile/formats.h"
#include "common/artifact/meshfile/text_scanner.h"
#include "common/core/error.h"
#include "common/core/mix_bits.h"

namespace strake::meshfile {
namespace {

constexpr std::size_t kHeaderBytes = 84;
constexpr std::size_t kFacetBytes = 50;

/// Gives equal coordinates (-0 equals +0) the same index, in order of first appearance.
class VertexWelder {
 public:
  VertexWelder(std::size_t expected_corners, PolyMesh& mesh) : mesh_(mesh) {
    slots_.assign(std::bit_ceil(std::max<std::size_t>(expected_corners, 16)), kNone);
  }

  void add_corner(Vec3 position) {
    position += Vec3::Zero();  // turns -0 into +0
    if (2 * mesh_.positions.size() >= slots_.size()) grow();
    Index& slot = slots_[find(position)];
    if (slot == kNone) {
      slot = mesh_.vertex_count();
      mesh_.positions.push_back(position);
    }
    mesh_.corners.push_back(slot);
  }

 private:
  [[nodiscard]] std::size_t find(const Vec3& position) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t at = hash(position) & mask;
    while (slots_[at] != kNone && !same(mesh_.positions[slots_[at]], position))
      at = (at + 1) & mask;
    return at;
  }

  static bool same(const Vec3& a, const Vec3& b) {
    return std::memcmp(a.data(), b.data(), sizeof(Vec3)) == 0;  // also equal NaNs
  }

  static std::size_t hash(const Vec3& position) {
    std::uint64_t value = 0;
    for (int i = 0; i < 3; ++i) {
      value = mix_bits(value, std::bit_cast<std::uint64_t>(position[i]));
    }
    return value;
  }

  void grow() {
    slots_.assign(2 * slots_.size(), kNone);
    for (Index v = 0; v < mesh_.vertex_count(); ++v) slots_[find(mesh_.positions[v])] = v;
  }

  PolyMesh& mesh_;
  std::vector<Index> slots_;
};

bool equals_ignoring_case(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](unsigned char x, unsigned char y) { return std::tolower(x) == y; });
}

bool starts_with_solid(std::string_view bytes) {
  TextScanner scanner(bytes.substr(0, 1 << 16));
  return scanner.skip_space() && equals_ignoring_case(scanner.word(), "solid");
}

std::uint32_t announced_facets(std::string_view bytes) {
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + kHeaderBytes - sizeof(count), sizeof(count));
  return count;
}

PolyMesh read_binary(std::string_view bytes, ReadReport& report) {
  report.format = "STL, binary";
  if (bytes.size() < kHeaderBytes + kFacetBytes) throw InputError("is too short for an STL file");
  std::size_t announced = announced_facets(bytes);
  const std::size_t there = (bytes.size() - kHeaderBytes) / kFacetBytes;
  if (announced == 0) announced = there;  // written by programs that stream
  std::size_t count = std::min(announced, there);
  report.missing_faces = static_cast<std::int64_t>(announced - count);
  if (count < there) {
    // Where all bytes are whole facets the number is wrong rather than the file damaged.
    const bool are_facets = (bytes.size() - kHeaderBytes) % kFacetBytes == 0;
    (are_facets ? report.unannounced_faces : report.left_out_faces) =
        static_cast<std::int64_t>(there - count);
    if (are_facets) count = there;
  }
  check_countable(3 * count, "face corners");
  PolyMesh mesh;
  mesh.corners.reserve(3 * count);
  mesh.offsets.reserve(count + 1);
  VertexWelder welder(3 * count, mesh);
  for (std::size_t f = 0; f < count; ++f) {
    float values[12];
    std::memcpy(values, bytes.data() + kHeaderBytes + f * kFacetBytes, sizeof(values));
    for (int i = 3; i < 12; i += 3) {
      welder.add_corner(Vec3(values[i], values[i + 1], values[i + 2]));
    }
    mesh.offsets.push_back(static_cast<Index>(mesh.corners.size()));
  }
  return mesh;
}

PolyMesh read_ascii(std::string_view bytes, ReadReport& report) {
  report.format = "STL, ascii";
  constexpr std::size_t kTypicalFacet = 200;
  PolyMesh mesh;
  VertexWelder welder(3 * (bytes.size() / kTypicalFacet), mesh);
  TextScanner scanner(bytes);
  bool in_facet = false;
  const auto drop_open_facet = [&] {
    if (!in_facet) return;
    ++report.missing_faces;
    mesh.corners.resize(mesh.offsets.back());
    in_facet = false;
  };
  while (scanner.skip_space()) {
    const std::string_view word = scanner.word();
    if (equals_ignoring_case(word, "vertex")) {
      Vec3 position;
      for (int i = 0; i < 3; ++i) scanner.number(position[i]);
      if (in_facet) welder.add_corner(position);
    } else if (equals_ignoring_case(word, "facet")) {
      drop_open_facet();
      in_facet = true;
    } else if (equals_ignoring_case(word, "endfacet")) {
      if (in_facet) {
        check_countable(mesh.corners.size(), "face corners");
        mesh.offsets.push_back(static_cast<Index>(mesh.corners.size()));
      }
      in_facet = false;
    } else if (equals_ignoring_case(word, "solid") || equals_ignoring_case(word, "endsolid")) {
      scanner.next_line();  // the name may be anything
    }
  }
  drop_open_facet();
  return mesh;
}

}  // namespace

bool looks_like_binary_stl(std::string_view bytes) {
  return bytes.size() >= kHeaderBytes + kFacetBytes &&
         bytes.size() == kHeaderBytes + kFacetBytes * std::size_t{announced_facets(bytes)};
}

bool looks_like_stl(std::string_view bytes) {
  return looks_like_binary_stl(bytes) || starts_with_solid(bytes);
}

PolyMesh read_stl(std::string_view bytes, ReadReport& report) {
  // Binary files may begin with "solid" too; a NUL byte never occurs in text.
  const bool is_text = starts_with_solid(bytes) && !looks_like_binary_stl(bytes) &&
                       bytes.substr(0, 1 << 12).find('\0') == std::string_view::npos;
  PolyMesh mesh = is_text ? read_ascii(bytes, report) : read_binary(bytes, report);
  report.welded_vertices = static_cast<std::int64_t>(mesh.corners.size() - mesh.positions.size());
  return mesh;
}

}  // namespace strake::meshfile
