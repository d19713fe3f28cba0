#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/core/poly_mesh.h"
#include "common/core/types.h"
#include "common/geometry/poly_topology/face_shape.h"
#include "stages/fit/vertex_places.h"

namespace strake::fitting {

/// Finds the faces that a move has made worse than they may get.
///
/// A face must not become concave, turn away from the surface, or get a smaller least angle than it
/// had where that is below 20 degrees, which it is where a side has no length, no side may get
/// shorter than it was where it is below a twentieth of the mean one of its face and half of what
/// it was at first, and no two faces may begin to cross.
class FaceGuard {
 public:
  /// Faces that cross at these places may go on crossing.
  FaceGuard(const PolyMesh& mesh, const VertexPlaces& places);

  /// Whether so many faces cross from the start that sheets must lie on top of each other: any move
  /// makes others cross.
  [[nodiscard]] bool is_tangled() const;
  /// Pairs of faces that crossed from the start; no others do.
  [[nodiscard]] std::size_t crossing_count() const { return allowed_.size(); }
  /// Takes the shapes of the faces as they are now as the state to compare with.
  void set_start(const VertexPlaces& places);
  /// Takes the part off the moves of two ends of a side towards each other by which it would get
  /// too short: put back, they would not move along it either.
  /// \param moves  [V] model units
  void keep_apart(const VertexPlaces& places, std::vector<Vec3>& moves) const;
  /// Whether a face got worse in shape.
  [[nodiscard]] bool is_spoilt(const VertexPlaces& places, Index face) const;
  /// [V] 1 at the vertices of such faces; where nothing but a side got too short, at its ends.
  [[nodiscard]] std::vector<std::uint8_t> spoilt(const VertexPlaces& places) const;
  /// [V] 1 at the vertices of faces that have begun to cross. Looks only at faces that have moved
  /// since the last call: all moves of the vertices returned must be taken back before the next.
  [[nodiscard]] std::vector<std::uint8_t> newly_crossing(const VertexPlaces& places);

 private:
  struct Form {
    bool is_concave = false;
    bool faces_away = false;
    double least_angle = 0;  ///< radians
  };

  [[nodiscard]] Form form(const VertexPlaces& places, Index face) const;
  struct Side {
    double length = 0;  ///< model units
    double least = 0;   ///< length below which it is short, model units
  };

  /// Calls use(corner the side begins at, Side) for each side of a face.
  template <class Use>
  void for_sides(const VertexPlaces& places, Index face, const Use& use) const;
  [[nodiscard]] bool is_too_short(std::size_t corner, const Side& side) const;
  /// Whether a face got worse in more than the lengths of its sides.
  [[nodiscard]] bool is_worse(const VertexPlaces& places, Index face) const;

  const PolyMesh& mesh_;
  std::vector<Form> start_;                    ///< [F]
  std::vector<double> start_sides_;            ///< [corners] length of the side, model units
  std::vector<std::array<Index, 2>> allowed_;  ///< pairs of faces that may cross, ascending
  std::vector<Vec3> looked_at_;                ///< [V] where crossings were last looked for
  std::vector<double> first_sides_;            ///< [corners] length of the side at first
};

}  // namespace strake::fitting
