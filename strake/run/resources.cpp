#include "strake/run/resources.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <utility>

#include "common/core/number_text.h"

namespace strake {
namespace {

constexpr double kKilo = 1e3;
constexpr double kMega = 1e6;
constexpr double kGiga = 1e9;
constexpr double kLargest = 1e18;  ///< amount that is taken seriously, and fits into 64 bits

struct Cost {
  double bytes = 0;
  double microseconds = 0;
};

/// A number followed by one of the units; 0 needs none.
std::optional<double> parse_with_unit(std::string_view text,
                                      const std::map<std::string, double, std::less<>>& units) {
  std::string_view unit = text;
  const std::optional<double> number = take_number(unit);
  if (!number) return std::nullopt;
  while (unit.starts_with(' ')) unit.remove_prefix(1);
  if (unit.empty() && *number == 0) return 0;
  const auto factor = units.find(unit);
  if (factor == units.end()) return std::nullopt;
  const double amount = *number * factor->second;
  return amount >= 0 && amount <= kLargest ? std::optional(amount) : std::nullopt;
}

}  // namespace

std::int64_t Resources::memory(double faces, double vertices) const {
  const double sum = bytes + bytes_per_face * faces + bytes_per_vertex * vertices;
  return static_cast<std::int64_t>(std::min(sum, kLargest));
}

double Resources::time(double faces, double vertices) const {
  return std::min(seconds + seconds_per_face * faces + seconds_per_vertex * vertices, kLargest);
}

Resources default_resources(std::string_view program) {
  constexpr double kBase = 60 * kMega;
  // Of each: bytes and microseconds, per face of the input and per vertex of the result.
  const auto needs = [](Cost of_face, Cost of_vertex) {
    return Resources{kBase,
                     of_face.bytes,
                     30,
                     of_face.microseconds * 1e-6,
                     0,
                     of_vertex.bytes,
                     of_vertex.microseconds * 1e-6};
  };
  if (program == "sample") return needs({400, 20}, {});
  if (program == "export") return needs({400, 20}, {300, 2});
  if (program == "import") return needs({700, 20}, {});
  if (program == "tensor") return needs({500, 200}, {});
  if (program == "smooth") return needs({1200, 100}, {});
  if (program == "coarsen") return needs({700, 20}, {});
  if (program == "prolong") return needs({400, 10}, {});
  if (program == "lift") return needs({500, 20}, {500, 10});
  if (program == "trace") return needs({1200, 400}, {1000, 50});
  if (program == "mesh") return needs({1500, 100}, {1000, 10});
  if (program == "fit") return needs({1200, 60}, {4000, 200});
  if (program == "size") return needs({600, 60}, {1000, 20});
  if (program == "refine" || program == "refine-uncross" || program == "refine-worst") {
    return needs({800, 400}, {1500, 200});
  }
  if (program == "decimate") return needs({900, 60}, {500, 10});
  if (program == "evaluate") return needs({1200, 50}, {1000, 20});
  return needs({1500, 400}, {4000, 200});
}

double vertices_within(double share) {
  // Distances between lines go with the root of the tolerance. Measured: 1.4 to 4.2 over the share.
  constexpr double kTimesShare = 4;
  return kTimesShare / share;
}

std::optional<double> parse_bytes(std::string_view text) {
  static const std::map<std::string, double, std::less<>> kUnits = {
      {"B", 1},        {"kB", kKilo},      {"KB", kKilo},
      {"MB", kMega},   {"GB", kGiga},      {"TB", 1e12},
      {"KiB", 1024.0}, {"MiB", 1048576.0}, {"GiB", 1073741824.0},
      {"K", 1024.0},   {"M", 1048576.0},   {"G", 1073741824.0}};
  return parse_with_unit(text, kUnits);
}

std::optional<double> parse_seconds(std::string_view text) {
  static const std::map<std::string, double, std::less<>> kUnits = {
      {"us", 1e-6}, {"ms", 1e-3}, {"s", 1}, {"min", 60}, {"h", 3600}, {"d", 86400}};
  return parse_with_unit(text, kUnits);
}

std::string bytes_text(double bytes) {
  for (const auto& [unit, size] : {std::pair{"GB", kGiga}, {"MB", kMega}, {"kB", kKilo}}) {
    if (bytes >= size) return fmt::format("{:.3g} {}", bytes / size, unit);
  }
  return fmt::format("{:.0f} B", bytes);
}

std::string seconds_text(double seconds) {
  if (seconds < 1) return fmt::format("{:.0f} ms", seconds * 1000);
  if (seconds < 120) return fmt::format("{:.1f} s", seconds);
  if (seconds < 7200) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

double estimated_faces(std::int64_t file_bytes, std::string_view file_extension) {
  // The densest way each format has to write a triangle with its share of half a vertex.
  static const std::map<std::string, double, std::less<>> kBytesPerFace = {
      {".stl", 50}, {".ply", 19}, {".off", 20}, {".obj", 25}};
  const auto found = kBytesPerFace.find(file_extension);
  return static_cast<double>(file_bytes) / (found == kBytesPerFace.end() ? 19 : found->second);
}

}  // namespace strake
