#include "stages/mesh/face_arrangement.h"

#include <algorithm>
#include <bit>
#include <string>

#include "common/core/error.h"

namespace strake {
namespace {

/// Chords from which on their order matters: those of one line that winds through a face come one
/// beside the other, and each would walk all that is left of the outline.
constexpr std::size_t kManyChords = 256;

/// The numbers below `count`, each far from those just before it: by their bits, the last first.
std::vector<std::size_t> scattered(std::size_t count) {
  const auto bits = static_cast<int>(std::bit_width(count));
  std::vector<std::size_t> order;
  order.reserve(count);
  for (std::size_t i = 0; i < std::size_t{1} << bits; ++i) {
    std::size_t turned = 0;
    for (int bit = 0; bit < bits; ++bit) turned = 2 * turned + (i >> bit & 1);
    if (turned < count) order.push_back(turned);
  }
  return order;
}

/// Parameter along a-b of its crossing with c-d, both in barycentric coordinates of a triangle.
double crossing_parameter(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  // With weights summing to one, the first two coordinates are affine coordinates of the plane.
  const auto side = [&](const Vec3& p) {
    return (d[0] - c[0]) * (p[1] - c[1]) - (d[1] - c[1]) * (p[0] - c[0]);
  };
  const double at_a = side(a);
  const double at_b = side(b);
  const double span = at_a - at_b;
  return span != 0 ? std::clamp(at_a / span, 0.0, 1.0) : 0.5;
}

}  // namespace

void FaceArrangement::label(Index edge, EdgeKind kind, Index line, Index chord) {
  const auto size = static_cast<std::size_t>(overlay_.graph.dart_count()) / 2;
  overlay_.kind.resize(size);
  overlay_.line.resize(size);
  chord_.resize(size - first_edge_);
  overlay_.kind[edge] = kind;
  overlay_.line[edge] = line;
  chord_[edge - first_edge_] = chord;
}

Index FaceArrangement::chord_of(Index dart) const {
  const Index edge = DartGraph::edge_of(dart);
  return edge < first_edge_ ? kNone : chord_[edge - first_edge_];
}

void FaceArrangement::walk_outline(Index face, Index first) {
  outline_dart_.clear();
  barycentric_.clear();
  Index corner = 0;  // of the edge the walk is on
  Index d = first;
  do {
    const Index node = overlay_.graph.from(d);
    position_[node] = static_cast<Index>(outline_dart_.size());
    outline_dart_.push_back(d);
    const SurfaceNode info = overlay_.nodes[node];
    if (info.vertex != kNone) {
      while (mesh_.faces[face][corner] != info.vertex) ++corner;
      barycentric_.push_back(Vec3::Unit(corner));
    } else if (info.at.face == face) {
      const auto& [a, b, c] = info.at.barycentric;
      barycentric_.emplace_back(a, b, c);
    } else {  // stored in the face across the edge
      // The twin starts where this edge ends: its origin's weight is the share of the way here.
      const double lambda = info.at.barycentric[mesh_.twin[3 * face + corner] % 3];
      barycentric_.push_back((1 - lambda) * Vec3::Unit(corner) +
                             lambda * Vec3::Unit((corner + 1) % 3));
    }
    d = overlay_.graph.next(d);
  } while (d != first);
}

void FaceArrangement::insert(Index face, Index first, const std::vector<Chord>& chords) {
  walk_outline(face, first);
  ends_.clear();
  placed_.clear();
  first_edge_ = overlay_.graph.dart_count() / 2;
  chord_.clear();
  if (chords.size() < kManyChords) {
    for (const Chord& chord : chords) insert_chord(face, chord);
  } else {
    for (const std::size_t i : scattered(chords.size())) insert_chord(face, chords[i]);
  }
}

/// The dart at the start of a chord whose cell the chord enters: at a corner of the face the cells
/// between earlier chords are told apart by where those end on the outline.
Index FaceArrangement::start_corner(const Chord& chord) const {
  const DartGraph& graph = overlay_.graph;
  const Index from = position_[chord.from];
  const auto length = static_cast<Index>(outline_dart_.size());
  const auto around = [&](Index position) { return (position - from + length) % length; };
  const Index wanted = around(position_[chord.to]);
  Index best = outline_dart_[from];
  for (Index d = graph.rotate_ccw(best);; d = graph.rotate_ccw(d)) {
    const Index id = chord_of(d);
    if (id == kNone) break;  // the outline again
    const Index far = ends_[id].from == from ? ends_[id].to : ends_[id].from;
    if (around(far) > wanted) break;
    best = d;
  }
  return best;
}

/// The piece of a chord on the outline of the cell at `corner` that the new chord crosses next.
Index FaceArrangement::next_crossing(Index corner) const {
  Index best = kNone;
  double best_at = 2;
  Index d = corner;
  do {
    const Index id = chord_of(d);
    if (id != kNone && placed_[id].pending && placed_[id].at < best_at) {
      best = d;
      best_at = placed_[id].at;
    }
    d = overlay_.graph.next(d);
  } while (d != corner);
  return best;
}

/// Leads the new chord from `corner` over `dart`; returns the corner it goes on from.
Index FaceArrangement::cross(Index corner, Index dart, Index face, const Vec3& barycentric) {
  DartGraph& graph = overlay_.graph;
  const Index node = overlay_.nodes.add_crossing(face, barycentric);
  const Index crossed = DartGraph::edge_of(dart);
  const Index second = graph.split_edge(dart, node);
  label(DartGraph::edge_of(second), overlay_.kind[crossed], overlay_.line[crossed], chord_of(dart));
  graph.connect(corner, second);
  return DartGraph::opposite(dart);
}

void FaceArrangement::insert_chord(Index face, const Chord& chord) {
  DartGraph& graph = overlay_.graph;
  const auto id = static_cast<Index>(placed_.size());
  const Ends ends = {position_[chord.from], position_[chord.to]};
  const Placed own = {.a = barycentric_[ends.from], .b = barycentric_[ends.to]};
  const auto [low, high] = std::minmax(ends.from, ends.to);
  const auto within = [low = low, high = high](Index p) { return low < p && p < high; };
  const auto on = [low = low, high = high](Index p) { return p == low || p == high; };
  Index pending = 0;
  for (std::size_t i = 0; i < ends_.size(); ++i) {
    const auto [from, to] = ends_[i];
    if (within(from) == within(to) || on(from) || on(to)) continue;
    ++pending;
    placed_[i].pending = true;
    placed_[i].at = crossing_parameter(own.a, own.b, placed_[i].a, placed_[i].b);
  }
  Index corner = start_corner(chord);
  double at = 0;
  for (; pending > 0; --pending) {
    const Index dart = next_crossing(corner);
    if (dart == kNone) {
      throw AlgorithmError("face " + std::to_string(face) +
                           ": its chords do not form an arrangement");
    }
    Placed& other = placed_[chord_of(dart)];
    other.pending = false;
    at = std::max(at, other.at);
    corner = cross(corner, dart, face, own.a + at * (own.b - own.a));
    label(graph.dart_count() / 2 - 1, EdgeKind::line, chord.line, id);
  }
  Index end = corner;
  while (graph.from(end) != chord.to) end = graph.next(end);
  graph.connect(corner, end);
  label(graph.dart_count() / 2 - 1, EdgeKind::line, chord.line, id);
  ends_.push_back(ends);
  placed_.push_back(own);
}

}  // namespace strake
