#include "stages/import/flat_faces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>

#include "common/core/disjoint_sets.h"
#include "common/core/tri_mesh.h"

namespace strake::import {
namespace {

constexpr double kZeroLength = 1e-10;  ///< of the diagonal
constexpr double kRoundedAway = 1e-6;  ///< the same where a union has left slivers
constexpr double kFlat = 1e-6;         ///< height over longest edge

class FlatFaceRemover {
 public:
  FlatFaceRemover(Soup& soup, std::vector<Index>& twin, double diagonal, Repairs& repairs)
      : soup_(soup),
        twin_(twin),
        shortest_((repairs.folded_slivers > 0 ? kRoundedAway : kZeroLength) * diagonal),
        repairs_(repairs),
        removed_(soup.faces.size(), 0) {}

  void run() {
    for (Index h = 0; h < soup_.halfedge_count(); ++h) {
      if (removed_[h / 3] == 0 && length(h) <= shortest_ && try_collapse(h)) {
        ++repairs_.collapsed_edges;
      }
    }
    // Flips end, as each makes the worse of two shapes better.
    while (flip_round()) {
    }
  }

  [[nodiscard]] const std::vector<std::uint8_t>& removed() const { return removed_; }

 private:
  /// Flips all flat faces that can be flipped, again and again where flips beside allow it.
  /// \return whether there were any: they may allow others, where an edge is gone that was in the way
  bool flip_round() {
    std::set<Index> open;
    for (Index f = 0; f < soup_.face_count(); ++f) add_flat(f, open);
    bool any = false;
    for (Index last = 0; !open.empty();) {  // in order, and once more around
      auto next = open.lower_bound(last);
      if (next == open.end()) next = open.begin();
      const Index f = last = *next;
      open.erase(next);
      const Index h = longest_edge(f);
      const Index t = twin_[h];
      if (!try_flip(h)) continue;
      ++repairs_.flipped_edges;
      any = true;
      for (const Index face : {f, t / 3}) {
        add_flat(face, open);
        for (Index e = 3 * face; e < 3 * face + 3; ++e) {
          if (twin_[e] != kNone) add_flat(twin_[e] / 3, open);
        }
      }
    }
    return any;
  }

  void add_flat(Index f, std::set<Index>& faces) const {
    if (removed_[f] == 0 && shape(soup_.faces[f]) <= kFlat) faces.insert(f);
  }

  [[nodiscard]] const Vec3& position(Index v) const { return soup_.positions[v]; }
  [[nodiscard]] double length(Index h) const {
    return (position(soup_.to(h)) - position(soup_.from(h))).norm();
  }
  [[nodiscard]] Index longest_edge(Index f) const {
    Index best = 3 * f;
    for (const Index h : {3 * f + 1, 3 * f + 2}) {
      if (length(h) > length(best)) best = h;
    }
    return best;
  }
  [[nodiscard]] Vec3 area_vector(const Triangle& face) const {
    const Vec3& p = position(face[0]);
    return (position(face[1]) - p).cross(position(face[2]) - p);
  }
  /// Height over the longest edge.
  [[nodiscard]] double shape(const Triangle& face) const {
    const double longest = std::max({(position(face[1]) - position(face[0])).squaredNorm(),
                                     (position(face[2]) - position(face[1])).squaredNorm(),
                                     (position(face[0]) - position(face[2])).squaredNorm()});
    return longest > 0 ? area_vector(face).norm() / longest : 0;
  }

  /// The vertices around from(h); `is_boundary` tells whether its fan is open.
  std::vector<Index> neighbours(Index h, bool& is_boundary) const {
    Index start = h;
    is_boundary = false;
    while (!is_boundary) {
      if (twin_[start] == kNone) {
        is_boundary = true;
      } else {
        start = TriMesh::next(twin_[start]);
        if (start == h) break;
      }
    }
    std::vector<Index> result;
    Index e = start;
    do {
      result.push_back(soup_.to(e));
      const Index last = TriMesh::prev(e);
      e = twin_[last];
      if (e == kNone) result.push_back(soup_.from(last));
    } while (e != kNone && e != start);
    std::sort(result.begin(), result.end());
    return result;
  }

  [[nodiscard]] std::size_t valence(Index h) const {
    bool ignored = false;
    return neighbours(h, ignored).size();
  }

  /// Moves to(h) into from(h), where the surface stays a manifold of the same kind.
  bool try_collapse(Index h) {
    const Index t = twin_[h];
    bool from_boundary = false;
    bool to_boundary = false;
    const std::vector<Index> around_from = neighbours(h, from_boundary);
    const std::vector<Index> around_to = neighbours(TriMesh::next(h), to_boundary);
    std::vector<Index> common;
    std::set_intersection(around_from.begin(), around_from.end(), around_to.begin(),
                          around_to.end(), std::back_inserter(common));
    if (common.size() != (t == kNone ? 1U : 2U)) return false;
    if (t != kNone && from_boundary && to_boundary) return false;
    constexpr std::size_t kLeastValence = 4;  // else the apex is left with a folded pair of faces
    for (const Index side : {h, t}) {
      if (side == kNone) continue;
      const bool outer = twin_[TriMesh::next(side)] == kNone || twin_[TriMesh::prev(side)] == kNone;
      if (outer ? twin_[TriMesh::next(side)] == twin_[TriMesh::prev(side)]
                : valence(TriMesh::prev(side)) < kLeastValence) {
        return false;
      }
    }
    const Index kept = soup_.from(h);
    for (const Index e : outgoing(TriMesh::next(h))) soup_.faces[e / 3][e % 3] = kept;
    close_up(h);
    if (t != kNone) close_up(t);
    return true;
  }

  [[nodiscard]] std::vector<Index> outgoing(Index h) const {
    std::vector<Index> result = {h};
    Index e = twin_[TriMesh::prev(h)];
    for (; e != kNone && e != h; e = twin_[TriMesh::prev(e)]) result.push_back(e);
    if (e == h) return result;
    for (e = h; twin_[e] != kNone;) {
      e = TriMesh::next(twin_[e]);
      result.push_back(e);
    }
    return result;
  }

  /// Removes the face of h and joins what lies beyond its two other edges.
  void close_up(Index h) {
    const Index a = twin_[TriMesh::next(h)];
    const Index b = twin_[TriMesh::prev(h)];
    if (a != kNone) twin_[a] = b;
    if (b != kNone) twin_[b] = a;
    removed_[h / 3] = 1;
  }

  /// Replaces edge h by the other diagonal of its two faces. What these carry is that of the other
  /// face, which has all of the area.
  /// \pre the face of h is flat, and h its longest edge
  bool try_flip(Index h) {
    const Index t = twin_[h];
    if (t == kNone) return false;
    const Index from = soup_.from(h);
    const Index to = soup_.to(h);
    const Index apex = soup_.from(TriMesh::prev(h));
    const Index other = soup_.from(TriMesh::prev(t));
    const Triangle first = {apex, other, to};
    const Triangle second = {other, apex, from};
    const double before = std::min(shape(soup_.faces[h / 3]), shape(soup_.faces[t / 3]));
    if (!(std::min(shape(first), shape(second)) > 2 * before + kFlat)) return false;
    const Vec3 normal = area_vector(soup_.faces[t / 3]);
    if (area_vector(first).dot(normal) <= 0 || area_vector(second).dot(normal) <= 0) return false;
    bool ignored = false;
    const std::vector<Index> around = neighbours(TriMesh::prev(h), ignored);
    if (std::binary_search(around.begin(), around.end(), other)) return false;

    const std::array<Index, 4> beyond = {twin_[TriMesh::next(h)], twin_[TriMesh::prev(h)],
                                         twin_[TriMesh::next(t)], twin_[TriMesh::prev(t)]};
    if (!soup_.texture.empty()) flip_texture(h, t);
    soup_.source_face[h / 3] = soup_.source_face[t / 3];
    const Index f = 3 * (h / 3);
    const Index g = 3 * (t / 3);
    soup_.faces[f / 3] = first;
    soup_.faces[g / 3] = second;
    link(f, g);
    link(f + 1, beyond[3]);
    link(f + 2, beyond[0]);
    link(g + 1, beyond[1]);
    link(g + 2, beyond[2]);
    return true;
  }

  /// What `try_flip` does to the corners of two faces: that of the apex, which lies on the edge
  /// that goes, gets what the other face has there.
  void flip_texture(Index h, Index t) {
    const auto at = [&](Index corner) { return soup_.texture[corner / 3][corner % 3]; };
    const Vec3 edge = position(soup_.to(t)) - position(soup_.from(t));
    const Vec3 way = position(soup_.from(TriMesh::prev(h))) - position(soup_.from(t));
    const double share = std::clamp(way.dot(edge) / edge.squaredNorm(), 0.0, 1.0);
    const TexturePoint from = at(t);
    const TexturePoint to = at(TriMesh::next(t));
    const TexturePoint apex = {(1 - share) * from[0] + share * to[0],
                               (1 - share) * from[1] + share * to[1]};
    const TexturePoint other = at(TriMesh::prev(t));
    soup_.texture[h / 3] = {apex, other, from};
    soup_.texture[t / 3] = {other, apex, to};
  }

  void link(Index h, Index t) {
    twin_[h] = t;
    if (t != kNone) twin_[t] = h;
  }

  Soup& soup_;
  std::vector<Index>& twin_;
  double shortest_;
  Repairs& repairs_;
  std::vector<std::uint8_t> removed_;
};

/// [V] 1 at the first vertex of pieces that share a source vertex with another one.
std::vector<std::uint8_t> find_cut_off(const Soup& soup, DisjointSets& pieces) {
  const Index sources = 1 + *std::max_element(soup.source_vertex.begin(), soup.source_vertex.end());
  std::vector<Index> piece_at(sources, kNone);
  std::vector<std::uint8_t> is_cut_off(soup.positions.size(), 0);
  for (const Triangle& face : soup.faces) {
    for (const Index v : face) {
      if (soup.source_vertex[v] == kNone) continue;
      const Index piece = pieces.find(v);
      Index& known = piece_at[soup.source_vertex[v]];
      if (known == kNone) known = piece;
      if (known == piece) continue;
      is_cut_off[known] = 1;
      is_cut_off[piece] = 1;
    }
  }
  return is_cut_off;
}

}  // namespace

void remove_flat_faces(Soup& soup, std::vector<Index> twin, double diagonal, Repairs& repairs) {
  FlatFaceRemover remover(soup, twin, diagonal, repairs);
  remover.run();
  remove_faces(soup, remover.removed());
}

void drop_pieces_without_area(Soup& soup, double diagonal, Repairs& repairs) {
  DisjointSets pieces(soup.vertex_count());
  for (const auto& [a, b, c] : soup.faces) {
    pieces.unite(a, b);
    pieces.unite(a, c);
  }
  std::vector<double> area(soup.positions.size(), 0);  // at the piece's first vertex
  std::vector<Eigen::AlignedBox3d> box(soup.positions.size());
  for (Index f = 0; f < soup.face_count(); ++f) {
    const Index piece = pieces.find(soup.faces[f][0]);
    area[piece] += face_area(soup, f);
    for (const Index v : soup.faces[f]) box[piece].extend(soup.positions[v]);
  }
  const std::vector<std::uint8_t> is_cut_off = find_cut_off(soup, pieces);
  std::vector<std::uint8_t> remove(soup.faces.size(), 0);
  std::int64_t count = 0;
  for (Index f = 0; f < soup.face_count(); ++f) {
    const Index piece = pieces.find(soup.faces[f][0]);
    const bool is_line = area[piece] <= kThinnest * box[piece].diagonal().squaredNorm();
    const bool is_sliver = is_cut_off[piece] != 0 && is_narrow(area[piece], box[piece], diagonal);
    remove[f] = is_line || is_sliver ? 1 : 0;
    count += remove[f];
  }
  if (count > 0) remove_faces(soup, remove);
  repairs.faces_without_area += count;
}

}  // namespace strake::import
