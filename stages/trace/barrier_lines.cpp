#include "stages/trace/barrier_lines.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "common/core/disjoint_sets.h"
#include "common/geometry/mesh_measures.h"
#include "common/geometry/topology/vertex_ring.h"

namespace strake {
namespace {

/// Free ends shorter than this many line distances are left out.
constexpr double kShortestFreeEnd = 2.5;
/// Groups of joined lines shorter than this in all are left out, with and without a ring.
constexpr double kSmallestTree = 6;
constexpr double kSmallestRing = 0.25;
/// Lines that cross a ring: three, with some room for the distance at which lines stop.
constexpr double kFewestOnRing = 3.5;

using Flags = std::vector<std::uint8_t>;

/// The barrier half-edge that continues a line after `h`, or kNone at a corner or end.
Index next_along(const TriMesh& mesh, const Flags& is_corner, Index h, bool boundary) {
  const Index v = mesh.to(h);
  if (is_corner[v] != 0) return kNone;
  if (boundary) return find_outgoing(mesh, v, [&](Index out) { return mesh.is_boundary(out); });
  Index onward = kNone;
  Index count = 0;
  for_each_outgoing(mesh, v, [&](Index out) {
    if (mesh.is_feature[out] == 0 || out == mesh.twin[h]) return;
    onward = out;
    ++count;
  });
  return count == 1 ? onward : kNone;
}

Vec3 edge_vector(const TriMesh& mesh, Index h) {
  return mesh.positions[mesh.to(h)] - mesh.positions[mesh.from(h)];
}

/// Corners of feature and boundary lines, but for teeth of ragged boundaries.
const Flags& corners(const TraceDomain& domain) {
  return domain.borders.is_corner.empty() ? domain.mesh.is_corner : domain.borders.is_corner;
}

/// Along barrier half-edge h, or the course of a ragged boundary there; a unit vector then.
Vec3 direction_along(const TraceDomain& domain, Index h) {
  const BorderCourse& borders = domain.borders;
  if (!borders.is_off(domain.mesh, h)) return edge_vector(domain.mesh, h);
  const Vec3& direction = borders.direction[domain.mesh.from(h)];
  return direction.isZero(0) ? borders.direction[domain.mesh.to(h)] : direction;
}

/// How far barrier half-edge h leads along its line, or along the course of a ragged boundary.
double way_along(const TraceDomain& domain, Index h) {
  const Vec3 edge = edge_vector(domain.mesh, h);
  if (!domain.borders.is_off(domain.mesh, h)) return edge.norm();
  return std::max(0.0, edge.dot(direction_along(domain, h)));
}

/// Distance wanted between crossing lines along barrier half-edge h, the smaller of its two sides.
double spacing_along_edge(const TraceDomain& domain, Index h) {
  double least = std::numeric_limits<double>::infinity();
  for (const Index side : {h, domain.mesh.twin[h]}) {
    if (side == kNone) continue;
    const FieldContext context = field_context(domain, TriMesh::face_of(side));
    const int i = side % 3;
    const Vec2 edge = context.chart.corner[(i + 1) % 3] - context.chart.corner[i];
    const Vec2 middle = context.chart.corner[i] + 0.5 * edge;
    const double length = edge.norm();
    Vec2 heading = length > 0 ? Vec2(edge / length) : Vec2(1, 0);
    if (domain.borders.is_off(domain.mesh, h)) {
      heading = chart_direction(domain, context, direction_along(domain, h)).normalized();
    }
    least = std::min(least, spacing_at(domain, context, middle, heading).along);
  }
  return least;
}

std::vector<BarrierLine> all_lines(const TriMesh& mesh, const Flags& is_corner) {
  std::vector<BarrierLine> lines;
  std::vector<char> used(mesh.halfedge_count(), 0);
  const auto starts_line = [&](Index h) {
    const Index v = mesh.from(h);
    if (is_corner[v] != 0) return true;
    Index degree = 0;  // a vertex that is no corner has two barrier edges of one kind
    for_each_outgoing(mesh, v, [&](Index out) { degree += mesh.is_feature[out]; });
    return !mesh.is_boundary(h) && degree != 2;
  };
  const auto collect = [&](Index start) {
    BarrierLine line;
    line.boundary = mesh.is_boundary(start);
    Index h = start;
    while (h != kNone && used[h] == 0) {
      used[h] = 1;
      if (mesh.twin[h] != kNone) used[mesh.twin[h]] = 1;
      line.halfedges.push_back(h);
      h = next_along(mesh, is_corner, h, line.boundary);
    }
    line.closed = h == start;
    lines.push_back(std::move(line));
  };
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (used[h] == 0 && mesh.is_barrier(h) && starts_line(h)) collect(h);
  }
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (used[h] == 0 && mesh.is_barrier(h)) collect(h);
  }
  return lines;
}

/// The two ends of open lines, as far as these are not left out.
class LineEnds {
 public:
  LineEnds(const TriMesh& mesh, const std::vector<BarrierLine>& lines)
      : mesh_(mesh), lines_(lines), at_(mesh.positions.size()) {
    for (Index l = 0; l < line_count(); ++l) {
      if (lines[l].closed) continue;
      for (const Index v : of(l)) at_[v] = {at_[v].count + 1, at_[v].sum + l};
    }
  }

  [[nodiscard]] Index line_count() const { return static_cast<Index>(lines_.size()); }
  [[nodiscard]] std::array<Index, 2> of(Index line) const {
    const std::vector<Index>& halfedges = lines_[line].halfedges;
    return {mesh_.from(halfedges.front()), mesh_.to(halfedges.back())};
  }
  [[nodiscard]] bool is_free(Index vertex) const { return at_[vertex].count == 1; }

  /// The lines from a free end of one to where lines meet or end; no more of them than it takes to
  /// be long enough.
  [[nodiscard]] std::vector<Index> chain_from(Index line, Index free_end) const {
    std::vector<Index> chain;
    double measure = 0;
    for (Index v = free_end;;) {
      chain.push_back(line);
      measure += lines_[line].measure;
      const auto [a, b] = of(line);
      v = v == a ? b : a;
      if (measure >= kShortestFreeEnd || at_[v].count != 2) return chain;
      line = static_cast<Index>(at_[v].sum - line);
      if (lines_[line].boundary) return chain;
    }
  }

  [[nodiscard]] double measure(const std::vector<Index>& chain) const {
    double sum = 0;
    for (const Index line : chain) sum += lines_[line].measure;
    return sum;
  }

  void leave_out(Index line) {
    for (const Index v : of(line)) at_[v] = {at_[v].count - 1, at_[v].sum - line};
  }

 private:
  struct AtVertex {
    Index count = 0;
    std::int64_t sum = 0;  ///< of the lines' numbers: of two, one tells the other
  };

  const TriMesh& mesh_;
  const std::vector<BarrierLine>& lines_;
  std::vector<AtVertex> at_;  ///< [V]
};

/// Marks lines that are too small for the wanted distances, until no more are found.
std::vector<char> too_small(const TriMesh& mesh, const std::vector<BarrierLine>& lines) {
  std::vector<char> dropped(lines.size(), 0);
  LineEnds ends(mesh, lines);
  for (bool changed = true; changed;) {
    changed = false;
    for (Index l = 0; l < ends.line_count(); ++l) {
      if (dropped[l] != 0 || lines[l].closed || lines[l].boundary) continue;
      const auto [a, b] = ends.of(l);
      if (!ends.is_free(a) && !ends.is_free(b)) continue;
      // Corners in its course make a line no shorter.
      const std::vector<Index> chain = ends.chain_from(l, ends.is_free(a) ? a : b);
      if (ends.measure(chain) >= kShortestFreeEnd) continue;
      for (const Index line : chain) {
        dropped[line] = 1;
        ends.leave_out(line);
      }
      changed = true;
    }
  }
  // Groups: the smallest line index names the group of each end vertex.
  std::vector<Index> group(mesh.vertex_count(), kNone);
  DisjointSets groups(static_cast<Index>(lines.size()));
  std::vector<char> ring(lines.size(), 0);
  for (std::size_t l = 0; l < lines.size(); ++l) {
    if (dropped[l] != 0) continue;
    if (lines[l].closed || lines[l].boundary) ring[groups.find(static_cast<Index>(l))] = 1;
    if (lines[l].closed) continue;
    for (const Index v : ends.of(static_cast<Index>(l))) {
      const Index own = groups.find(static_cast<Index>(l));
      if (group[v] == kNone) {
        group[v] = own;
        continue;
      }
      const Index other = groups.find(group[v]);
      const bool is_ring = !groups.unite(own, other) || ring[own] != 0 || ring[other] != 0;
      if (is_ring) ring[groups.find(own)] = 1;
    }
  }
  std::vector<double> total(lines.size(), 0);
  for (std::size_t l = 0; l < lines.size(); ++l) {
    if (dropped[l] == 0) total[groups.find(static_cast<Index>(l))] += lines[l].measure;
  }
  for (std::size_t l = 0; l < lines.size(); ++l) {
    const Index g = groups.find(static_cast<Index>(l));
    if (!lines[l].boundary && total[g] < (ring[g] != 0 ? kSmallestRing : kSmallestTree))
      dropped[l] = 1;
  }
  return dropped;
}

}  // namespace

void bound_rings(const TriMesh& mesh, SpacingModel& model) {
  for (const BarrierLine& line : all_lines(mesh, mesh.is_corner)) {
    if (!line.closed) continue;
    double length = 0;
    for (const Index h : line.halfedges) length += edge_vector(mesh, h).norm();
    model.bound_along(line.halfedges, length / kFewestOnRing);
  }
}

std::vector<BarrierLine> barrier_lines(const TraceDomain& domain) {
  std::vector<BarrierLine> lines = all_lines(domain.mesh, corners(domain));
  for (BarrierLine& line : lines) {
    for (const Index h : line.halfedges) {
      line.measure += edge_vector(domain.mesh, h).norm() / spacing_along_edge(domain, h);
    }
  }
  const std::vector<char> dropped = too_small(domain.mesh, lines);
  std::vector<BarrierLine> kept;
  for (std::size_t l = 0; l < lines.size(); ++l) {
    if (dropped[l] == 0) kept.push_back(std::move(lines[l]));
  }
  return kept;
}

std::vector<std::uint8_t> barrier_flags(const TriMesh& mesh,
                                        const std::vector<BarrierLine>& lines) {
  std::vector<std::uint8_t> flags(mesh.halfedge_count(), 0);
  for (const BarrierLine& line : lines) {
    for (const Index h : line.halfedges) {
      flags[h] = 1;
      if (mesh.twin[h] != kNone) flags[mesh.twin[h]] = 1;
    }
  }
  return flags;
}

TracedLine to_traced_line(const BarrierLine& line) {
  TracedLine result;
  result.family = line.boundary ? LineFamily::boundary : LineFamily::feature;
  result.start_reason = line.closed ? LineEnd::closed : LineEnd::node;
  result.end_reason = result.start_reason;
  for (const Index h : line.halfedges) {
    result.points.push_back({h, 0});
    result.chord_face.push_back(kNone);
    result.chord_family.push_back(result.family);
  }
  return result;
}

void seed_along(const TraceDomain& domain, const BarrierLine& line, std::vector<Seed>& seeds) {
  std::vector<double> measure(line.halfedges.size() + 1, 0);  // length in units of the spacing
  for (std::size_t i = 0; i < line.halfedges.size(); ++i) {
    const Index h = line.halfedges[i];
    measure[i + 1] = measure[i] + way_along(domain, h) / spacing_along_edge(domain, h);
  }
  const double total = measure.back();
  const auto parts = static_cast<Index>(std::max(line.closed ? 3.0 : 1.0, std::round(total)));
  std::size_t at = 0;
  for (Index k = line.closed ? 0 : 1; k < parts; ++k) {
    const double wanted = total * k / parts;
    while (at + 1 < line.halfedges.size() && measure[at + 1] <= wanted) ++at;
    const double span = measure[at + 1] - measure[at];
    const double lambda = span > 0 ? (wanted - measure[at]) / span : 0.5;
    const Index h = line.halfedges[at];
    Seed seed;
    seed.face = TriMesh::face_of(h);
    seed.anchor = {h, std::clamp(lambda, 0.02, 0.98)};
    seed.direction = domain.face_normals[seed.face].cross(direction_along(domain, h)).normalized();
    seeds.push_back(seed);
  }
}

void seed_at_corners(const TraceDomain& domain, const std::vector<std::uint8_t>& barriers,
                     std::vector<Seed>& seeds) {
  const TriMesh& mesh = domain.mesh;
  std::vector<char> done(mesh.wedge_count(), 0);
  for (Index start = 0; start < mesh.halfedge_count(); ++start) {
    const Index w = mesh.wedge_of(start);
    if (done[w] != 0 || corners(domain)[mesh.from(start)] == 0) continue;
    done[w] = 1;
    Index first = start;  // clockwise-most corner of the wedge
    while (!mesh.is_barrier(first)) {
      first = mesh.rotate_cw(first);
      if (first == start) break;
    }
    if (barriers[first] == 0) continue;
    double angle = 0;
    Index corner = first;
    do {
      angle += corner_angle(mesh, corner);
      if (mesh.is_barrier(TriMesh::prev(corner))) break;
      corner = mesh.rotate_ccw(corner);
    } while (corner != first);
    const auto lines = static_cast<int>(std::round(angle / (M_PI / 2))) - 1;
    for (int k = 1; k <= lines; ++k) {
      double wanted = angle * k / (lines + 1);
      corner = first;
      while (wanted > corner_angle(mesh, corner) && !mesh.is_barrier(TriMesh::prev(corner))) {
        wanted -= corner_angle(mesh, corner);
        corner = mesh.rotate_ccw(corner);
      }
      const double here = corner_angle(mesh, corner);
      wanted = std::clamp(wanted, 0.02 * here, 0.98 * here);
      Seed seed;
      seed.face = TriMesh::face_of(corner);
      seed.anchor = {corner, 0};
      const Vec3 edge = edge_vector(mesh, corner).normalized();
      seed.direction =
          edge * std::cos(wanted) + domain.face_normals[seed.face].cross(edge) * std::sin(wanted);
      seeds.push_back(seed);
    }
  }
}

}  // namespace strake
