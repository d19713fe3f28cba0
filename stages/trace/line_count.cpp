#include "stages/trace/line_count.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

namespace strake {
namespace {

constexpr double kMostScaled = 4;

/// A chord from one place of the outline of its face to another, each the number of an edge plus a
/// share of it.
struct OutlineChord {
  Index face = kNone;
  double first = 0;  ///< the smaller
  double second = 0;
  bool operator<(const OutlineChord& other) const {
    return std::tie(face, first, second) < std::tie(other.face, other.first, other.second);
  }
};

bool is_barrier_line(LineFamily family) {
  return family == LineFamily::feature || family == LineFamily::boundary;
}

std::optional<double> place_on_outline(const TriMesh& mesh, Index face, const LinePoint& point) {
  const Index twin = mesh.twin[point.halfedge];
  if (TriMesh::face_of(point.halfedge) == face) return point.halfedge % 3 + point.lambda;
  if (twin == kNone || TriMesh::face_of(twin) != face) return std::nullopt;
  return std::fmod(twin % 3 + 1 - point.lambda, 3.0);
}

/// Pairs of chords of one face whose ends alternate around it.
std::int64_t count_alternating(const std::vector<OutlineChord>& chords, std::size_t begin,
                               std::size_t end) {
  std::int64_t count = 0;
  for (std::size_t i = begin; i < end; ++i) {
    for (std::size_t k = i + 1; k < end && chords[k].first < chords[i].second; ++k) {
      count += chords[k].first > chords[i].first && chords[k].second > chords[i].second ? 1 : 0;
    }
  }
  return count;
}

}  // namespace

LineCount count_places(const TriMesh& mesh, const LineSet& lines) {
  std::vector<OutlineChord> chords;
  std::vector<std::pair<Index, double>> on_barriers;
  for (Index line = 0; line < lines.line_count(); ++line) {
    if (is_barrier_line(lines.family[line])) continue;
    for (Index i = lines.offsets[line]; i < lines.offsets[line + 1]; ++i) {
      const LinePoint& point = lines.points[i];
      const Index h = point.halfedge;
      if (mesh.is_barrier(h) && point.lambda > 0) {
        const bool is_lower = mesh.twin[h] == kNone || h < mesh.twin[h];
        on_barriers.emplace_back(is_lower ? h : mesh.twin[h],
                                 is_lower ? point.lambda : 1 - point.lambda);
      }
      if (lines.chord_face[i] == kNone) continue;
      const bool is_last = i + 1 == lines.offsets[line + 1];
      const LinePoint& next = lines.points[is_last ? lines.offsets[line] : i + 1];
      const auto from = place_on_outline(mesh, lines.chord_face[i], point);
      const auto to = place_on_outline(mesh, lines.chord_face[i], next);
      if (!from || !to) continue;
      chords.push_back({lines.chord_face[i], std::min(*from, *to), std::max(*from, *to)});
    }
  }
  std::sort(chords.begin(), chords.end());
  std::sort(on_barriers.begin(), on_barriers.end());
  LineCount count;
  for (std::size_t begin = 0, end = 0; begin < chords.size(); begin = end) {
    while (end < chords.size() && chords[end].face == chords[begin].face) ++end;
    count.crossings += count_alternating(chords, begin, end);
  }
  count.on_barriers = std::unique(on_barriers.begin(), on_barriers.end()) - on_barriers.begin();
  count.corners = std::count(mesh.is_corner.begin(), mesh.is_corner.end(), 1);
  return count;
}

double scale_for(const LineCount& count, double wanted) {
  // The root x of crossings x^2 + on_barriers x + corners = wanted is the inverse of the factor.
  const auto a = static_cast<double>(count.crossings);
  const auto b = static_cast<double>(count.on_barriers);
  const double c = static_cast<double>(count.corners) - wanted;
  if (c >= 0) return kMostScaled;
  const double denominator = b + std::sqrt(b * b - 4 * a * c);
  return std::clamp(denominator / (-2 * c), 1 / kMostScaled, kMostScaled);
}

}  // namespace strake
