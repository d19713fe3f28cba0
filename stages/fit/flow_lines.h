#pragma once

#include <array>
#include <vector>

#include "common/core/fields.h"
#include "common/core/poly_mesh.h"
#include "common/core/types.h"
#include "stages/fit/block_system.h"
#include "stages/fit/vertex_places.h"

namespace strake::fitting {

/// The lines that the edges of a result form, and where they want to go: straight on through every
/// vertex where they can be followed, in even steps, along the arms of the cross field, and at a
/// right angle off feature and boundary lines. Where directions mean little a T-joint that is a
/// corner of a quad bends out of it, and edges hardly move the vertices of those lines.
class FlowLines {
 public:
  explicit FlowLines(const PolyMesh& mesh);

  /// [V] which vertices a face or a line couples, ascending.
  [[nodiscard]] std::vector<std::vector<Index>> neighbours() const;

  /// The sum of weight times squared residual over all wishes at the present places.
  /// \param field        nullptr: lines only want to be straight and even
  /// \param squares      [V] squared distance that an edge turned by one radian is worth there
  [[nodiscard]] double cost(const VertexPlaces& places, const PrincipalField* field,
                            const std::vector<double>& squares) const;
  /// Adds the least-squares problem of fulfilling these wishes by moves of the vertices.
  void add_to(BlockSystem& system, const VertexPlaces& places, const PrincipalField* field,
              const std::vector<double>& squares) const;

  /// Moves T-joints that make their face concave onto the line between their neighbours, within the
  /// face's plane.
  void straighten_joints(VertexPlaces& places) const;

 private:
  /// A line of edges through a vertex.
  struct Through {
    Index before;
    Index vertex;
    Index after;
    bool is_quad_corner = false;  ///< whether it is the straight corner of a quad
  };
  struct Joint {
    Index face;     ///< whose straight corner it is
    Through along;  ///< in the face's order
  };

  [[nodiscard]] std::vector<Index> corners_around(const std::vector<Index>& opposite,
                                                  Index first) const;
  /// [edges] the part of an edge's wishes that moves its end on a feature or boundary line, where
  /// the other end is free; 1 elsewhere. Directions count there as much as they matter beside those
  /// of the line's other edges: else the radii of a flat disk would crowd the lines of the wall
  /// around it.
  [[nodiscard]] std::vector<double> shares_for_lines(const VertexPlaces& places,
                                                     const PrincipalField& field,
                                                     const std::vector<double>& squares) const;
  void follow_lines(Index vertex, const std::vector<Index>& around);
  /// Calls use(term) for every wish.
  template <class Use>
  void for_terms(const VertexPlaces& places, const PrincipalField* field,
                 const std::vector<double>& squares, const Use& use) const;

  const PolyMesh& mesh_;
  std::vector<Index> face_of_;  ///< [C]
  std::vector<std::array<Index, 2>> edges_;
  std::vector<Through> through_;
  std::vector<Joint> joints_;
};

}  // namespace strake::fitting
