#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "common/core/poly_mesh.h"

namespace strake {

/// Vertices on edges, by edge.
class EdgeMarks {
 public:
  /// The vertex in the middle of an edge; kNone where it is not divided, or by a chain.
  [[nodiscard]] Index at(Index a, Index b) const {
    const auto found = vertices_.find(key(a, b));
    return found == vertices_.end() ? kNone : found->second;
  }
  void set(Index a, Index b, Index vertex) { vertices_[key(a, b)] = vertex; }
  /// Several vertices on an edge of one face, in the face's sense; empty where there are none.
  [[nodiscard]] std::span<const Index> chain(Index a, Index b) const {
    const auto found = chains_.find(key(a, b));
    return found == chains_.end() ? std::span<const Index>{} : std::span(found->second);
  }
  void set_chain(Index a, Index b, std::vector<Index> vertices) {
    chains_[key(a, b)] = std::move(vertices);
  }

 private:
  static std::uint64_t key(Index a, Index b) {
    return static_cast<std::uint64_t>(std::min(a, b)) << 32 |
           static_cast<std::uint64_t>(std::max(a, b));
  }
  std::unordered_map<std::uint64_t, Index> vertices_;
  std::unordered_map<std::uint64_t, std::vector<Index>> chains_;
};

/// Gives a new vertex in the middle of a face: between two opposite vertices of its ring.
using AddCentre = std::function<Index(Index, Index, const std::vector<Index>& ring)>;

/// Divides faces whose edges are marked so that the faces around fit again, into quads where that
/// is possible.
///
/// A quad with two opposite marks becomes two quads, one with four marks four, one with two marks
/// side by side three around a new vertex; a triangle with three marks three; a pentagon with one
/// mark opposite a corner two. Faces that are not to be divided keep the new vertices as corners
/// while they have at most `max_sides` and are not concave. A face with a chain on an edge becomes
/// triangles, and quads of two of these.
/// \param positions  [V] of all vertices, those on the marked edges included
/// \param divide     [F] 1: a face to be divided, whatever its number of corners
/// \param add_centre may let `positions` grow
/// \return the faces; each old one is a run of new ones. \post no edge of a face is marked
PolyMesh split_cells(const PolyMesh& mesh, const std::vector<char>& divide, const EdgeMarks& marks,
                     std::size_t max_sides, const std::vector<Vec3>& positions,
                     const AddCentre& add_centre);

}  // namespace strake
