#include <nlohmann/json.hpp>

#include "common/geometry/line_chord.h"
#include "strake/report/quantise.h"
#include "strake/report/scene.h"
#include "strake/report/thin_line.h"

namespace strake::report {
namespace {

/// One line as the viewer gets it.
struct LineRow {
  std::uint32_t first_point = 0;
  std::uint32_t seed_point = 0;
  float length = 0;  ///< model units
  std::uint8_t family = 0;
  std::uint8_t start_reason = 0;
  std::uint8_t end_reason = 0;
  std::uint8_t is_closed = 0;
};

/// Positions of a line's points, the first one again at the end of a closed line.
std::vector<Vec3> positions_of(const TriMesh& mesh, const LineSet& lines, Index line) {
  std::vector<Vec3> result;
  for (Index p = lines.offsets[line]; p < lines.offsets[line + 1]; ++p) {
    result.push_back(line_point_position(mesh, lines.points[p]));
  }
  if (lines.is_closed(line) && !result.empty()) result.push_back(result.front());
  return result;
}

/// Points of a line that have to stay: its ends, its seed, and where its family changes.
std::vector<std::uint8_t> fixed_points(const LineSet& lines, Index line, std::size_t count) {
  std::vector<std::uint8_t> is_fixed(count, 0);
  const Index first = lines.offsets[line];
  is_fixed.front() = is_fixed.back() = 1;
  const Index seed = lines.seed_point[line] - first;
  if (seed >= 0 && static_cast<std::size_t>(seed) < count) is_fixed[seed] = 1;
  for (std::size_t i = 1; i + 1 < count; ++i) {
    const Index p = first + static_cast<Index>(i);
    if (lines.chord_family[p] != lines.chord_family[p - 1]) is_fixed[i] = 1;
  }
  return is_fixed;
}

/// Indices of the points that are kept of each line.
using KeptPoints = std::vector<std::vector<std::size_t>>;

/// \param deviation  of lines from what is kept of them, model units
KeptPoints thin_lines(const TriMesh& mesh, const LineSet& lines, double deviation) {
  KeptPoints kept(static_cast<std::size_t>(lines.line_count()));
  for (Index line = 0; line < lines.line_count(); ++line) {
    const std::vector<Vec3> positions = positions_of(mesh, lines, line);
    if (positions.empty()) continue;
    kept[line] = thin_line(positions, fixed_points(lines, line, positions.size()), deviation);
  }
  return kept;
}

KeptPoints few_points(const TriMesh& mesh, const LineSet& lines, std::size_t most_points) {
  constexpr double kMostDeviation = 16 * kLineDeviation;
  for (double deviation = kLineDeviation;; deviation *= 2) {
    KeptPoints kept = thin_lines(mesh, lines, deviation * mesh.diagonal);
    std::size_t count = 0;
    for (const std::vector<std::size_t>& points : kept) count += points.size();
    if (count <= most_points || deviation >= kMostDeviation) return kept;
  }
}

}  // namespace

nlohmann::ordered_json line_scene(const TriMesh& mesh, const LineSet& lines,
                                  std::size_t most_points, Blocks& blocks) {
  const Grid grid(mesh.positions);
  const KeptPoints kept = few_points(mesh, lines, most_points);
  std::vector<GridPoint> points;
  std::vector<LineRow> rows;
  for (Index line = 0; line < lines.line_count(); ++line) {
    const Index first = lines.offsets[line];
    const std::vector<Vec3> positions = positions_of(mesh, lines, line);
    LineRow row{.first_point = static_cast<std::uint32_t>(points.size()),
                .seed_point = static_cast<std::uint32_t>(points.size()),
                .family = static_cast<std::uint8_t>(lines.family[line]),
                .start_reason = static_cast<std::uint8_t>(lines.start_reason[line]),
                .end_reason = static_cast<std::uint8_t>(lines.end_reason[line]),
                .is_closed = static_cast<std::uint8_t>(lines.is_closed(line))};
    double length = 0;
    for (std::size_t i = 1; i < positions.size(); ++i) {
      length += (positions[i] - positions[i - 1]).norm();
    }
    row.length = static_cast<float>(length);
    for (const std::size_t i : kept[line]) {
      const Index p = first + static_cast<Index>(i);
      if (p == lines.seed_point[line]) row.seed_point = static_cast<std::uint32_t>(points.size());
      const bool again = p == lines.offsets[line + 1];  // the first point of a closed line
      points.push_back(grid.quantise(
          positions[i], static_cast<std::uint16_t>(lines.chord_family[again ? first : p])));
    }
    rows.push_back(row);
  }
  return {{"lines", lines.line_count()},
          {"low", {grid.low().x(), grid.low().y(), grid.low().z()}},
          {"step", grid.step()},
          {"points", blocks.vertices(points)},
          {"rows", blocks.vertices(rows)}};
}

}  // namespace strake::report
