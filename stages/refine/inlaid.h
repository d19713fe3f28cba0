#pragma once

#include <cstddef>
#include <vector>

#include "common/core/poly_mesh.h"
#include "common/geometry/cell_error/compared_surfaces.h"
#include "common/geometry/cell_error/tolerance_check.h"
#include "common/geometry/face_crossings/crossing_places.h"
#include "stages/refine/inlay.h"

namespace strake {

/// A result with inlays.
struct Inlaid {
  QuadMesh quads;
  std::vector<Index> inlay;  ///< [F] that a face is of; kNone: of none
  std::vector<Index> part;   ///< [F] its number there, or of the result without inlays
};

/// What is not as it should be.
struct Faults {
  std::vector<Index> faces;  ///< ascending
  bool is_beyond = false;    ///< whether anything is: a place of the input may be near no face
  [[nodiscard]] bool any() const { return is_beyond || !faces.empty(); }
};

/// A result that inlays are put into, and what is wrong with it then.
class InlayHost {
 public:
  /// \param proof, quads, crossing  kept by reference
  InlayHost(ToleranceProof& proof, const QuadMesh& quads, CrossingPlaces& crossing)
      : proof_(proof), quads_(quads), crossing_(crossing), surfaces_(proof.input(), quads_) {}

  /// Without any inlay.
  [[nodiscard]] const QuadMesh& quads() const { return quads_; }
  [[nodiscard]] const ComparedSurfaces& surfaces() const { return surfaces_; }
  [[nodiscard]] double tolerance() const { return proof_.tolerance(); }

  [[nodiscard]] Inlaid with(const std::vector<Inlay>& inlays) const;

  /// Faces beyond the tolerance.
  [[nodiscard]] Faults beyond(const Inlaid& inlaid) const;
  /// Faces that cross others. \return ascending
  [[nodiscard]] std::vector<Index> crossing(const Inlaid& inlaid) const {
    return crossing_.faces_of(inlaid.quads.mesh);
  }

  /// Inlays that a face is of, or that it is beside.
  [[nodiscard]] std::vector<std::size_t> inlays_at(const std::vector<Inlay>& inlays,
                                                   const Inlaid& inlaid, Index face) const;

 private:
  ToleranceProof& proof_;
  const QuadMesh& quads_;
  CrossingPlaces& crossing_;
  ComparedSurfaces surfaces_;
};

}  // namespace strake
