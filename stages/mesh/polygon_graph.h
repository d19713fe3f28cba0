#pragma once

#include <array>
#include <boost/container/small_vector.hpp>
#include <vector>

#include "common/geometry/border_course.h"
#include "stages/mesh/overlay.h"

namespace strake {

/// How firmly a node stays where it is; a node may be merged into one of equal or higher rank.
enum class NodeRank : std::uint8_t { line, barrier, corner };

/// Darts around a cell or a few of them, in order; hardly ever more than twelve.
using DartLoop = boost::container::small_vector<Index, 12>;

/// The cells between lines as polygons: nodes are crossings and corners, edges are pieces of lines.
class PolygonGraph {
 public:
  /// Contracts an overlay that `reduce_to_lines` has prepared: nodes of degree two become part of
  /// their edges, except corners and where the kind of line changes. Those of ragged boundaries lie
  /// on their course.
  PolygonGraph(const TriMesh& mesh, const Overlay& overlay, const BorderCourse& borders);
  /// Likewise, with boundaries as they are.
  PolygonGraph(const TriMesh& mesh, const Overlay& overlay)
      : PolygonGraph(mesh, overlay, BorderCourse{{}, {}, mesh.is_corner}) {}

  [[nodiscard]] const DartGraph& graph() const { return graph_; }
  [[nodiscard]] const SurfaceNode& node(Index n) const { return nodes_[n]; }
  [[nodiscard]] Index node_count() const { return static_cast<Index>(nodes_.size()); }
  [[nodiscard]] const Vec3& position(Index n) const { return nodes_[n].position; }
  /// Unit normal of the face of the mesh that a node lies on.
  [[nodiscard]] Vec3 surface_normal(Index n) const;
  [[nodiscard]] NodeRank rank(Index n) const { return rank_[n]; }
  [[nodiscard]] EdgeKind kind(Index dart) const { return kind_[DartGraph::edge_of(dart)]; }
  [[nodiscard]] Index line(Index dart) const { return line_[DartGraph::edge_of(dart)]; }
  [[nodiscard]] bool is_barrier(Index dart) const {
    return kind(dart) == EdgeKind::feature || kind(dart) == EdgeKind::boundary;
  }
  /// Whether the dart lies on the far side of a boundary edge, where there is no surface.
  [[nodiscard]] bool is_outer(Index dart) const { return outer_[dart] != 0; }
  [[nodiscard]] bool is_hole(Index dart) const;
  [[nodiscard]] Index degree(Index dart) const;
  /// Darts of the cell left of `dart`, starting with it.
  [[nodiscard]] DartLoop cell(Index dart) const;
  /// Calls use(dart, cell) for every cell that is no hole, by its least dart, ascending.
  template <class Use>
  void for_each_cell(const Use& use) const {
    std::vector<char> seen(graph().dart_count(), 0);
    for (Index d = 0; d < graph().dart_count(); ++d) {
      if (!graph().is_alive(d) || seen[d] != 0) continue;
      const DartLoop loop = cell(d);
      for (const Index other : loop) seen[other] = 1;
      if (!is_hole(d)) use(d, loop);
    }
  }
  /// The least dart of the cell left of `dart`, to tell cells apart.
  [[nodiscard]] Index name_of_cell(Index dart) const;
  /// A dart from a to b where `around` leaves a; kNone where there is no such edge.
  [[nodiscard]] Index find_edge(Index around, Index b) const;
  /// Length of the edge along the surface.
  [[nodiscard]] double length(Index dart) const;

  /// Joins the origins of two darts of a cell by a straight edge.
  Index connect(Index a, Index b);
  void remove_edge(Index dart) { graph_.remove_edge(dart); }
  /// From now on the edge counts as a feature and its nodes as corners: nothing merges or removes
  /// them.
  void hold(Index dart);
  /// Forgets the course of an edge that is on no feature or boundary: it becomes the straight way.
  void straighten(Index dart) { course_[DartGraph::edge_of(dart)].clear(); }
  /// From now on the node is merged with no other one.
  void keep(Index n) { is_kept_[n] = 1; }
  [[nodiscard]] bool is_kept(Index n) const { return is_kept_[n] != 0; }
  /// Merges from(dart) into to(dart). Along a feature or boundary line the course of the edge goes
  /// to the next edge of the line, so that no part of it is forgotten.
  /// \pre as for DartGraph::contract
  void contract(Index dart);
  /// Replaces the edges inside a part of the surface by those of triangles.
  /// \param outlines   darts around the part and around its holes, the part on their left
  /// \param inside     a dart of each edge inside
  /// \param triangles  nodes of the outlines, each side an edge of them or one of two triangles
  /// \return a dart of each triangle; nothing is done and returned where the triangles do not fit,
  ///         an edge would be double, or the topology another one
  std::vector<Index> refill(const std::vector<std::vector<Index>>& outlines,
                            const std::vector<Index>& inside,
                            const std::vector<std::array<Index, 3>>& triangles);
  /// Joins the two edges at from(dart).
  void dissolve(Index dart);
  /// Splits the edge at the point of its course nearest to `share` of its length, in (0, 1).
  /// \return dart that leaves the new node towards to(dart)
  Index split(Index dart, double share);
  /// The place on the course of an edge that is farthest from the straight way.
  struct Bend {
    double distance = 0;  ///< model units
    double share = 0;     ///< of the length, as for `split`
  };
  [[nodiscard]] Bend bend(Index dart) const;
  /// Where `split` would put the new node.
  [[nodiscard]] Vec3 split_position(Index dart, double share) const;
  /// Moves a node on or near the surface; its place in the mesh stays that of its foot.
  void move(Index n, const Vec3& position) { nodes_[n].position = position; }
  /// Points along the edge, both ends included, in the direction of `dart`.
  [[nodiscard]] std::vector<Vec3> course(Index dart) const;

 private:
  /// A place on an edge, and which points of its course come before and after it. Points count
  /// along the even dart, both ends included.
  struct Cut {
    std::size_t stop = 0;    ///< points 1 .. stop - 1 come before the place
    std::size_t resume = 0;  ///< points from here on come after it
    double local = 0;        ///< share of the way from point stop - 1 to the next, where it is none

    /// Whether it is a point of the course, which is left out then.
    [[nodiscard]] bool is_point() const { return resume > stop; }
  };

  /// Of an edge that is being added and is part of no traced line.
  void describe_plain_edge();
  [[nodiscard]] Cut cut(Index dart, double share) const;
  [[nodiscard]] const SurfaceNode& point(Index even, std::size_t i) const;
  void add_chain(const Overlay& overlay, const BorderCourse& borders, Index first,
                 std::vector<Index>& dart_of, const std::vector<char>& kept,
                 std::vector<Index>& node_of);
  void extend_course(Index first, Index dart);
  [[nodiscard]] SurfaceNode between(const SurfaceNode& a, const SurfaceNode& b, double share) const;

  const TriMesh* mesh_;  ///< not owned
  DartGraph graph_;
  std::vector<SurfaceNode> nodes_;
  std::vector<NodeRank> rank_;
  std::vector<char> is_kept_;                     ///< [nodes]
  std::vector<EdgeKind> kind_;                    ///< [edges]
  std::vector<Index> line_;                       ///< [edges]
  std::vector<char> outer_;                       ///< [darts]
  std::vector<std::vector<SurfaceNode>> course_;  ///< [edges] inner points, along the even dart
};

}  // namespace strake
