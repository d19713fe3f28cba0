#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/core/poly_mesh.h"
#include "common/core/tri_mesh.h"
#include "common/geometry/cell_error/tolerance_check.h"
#include "common/geometry/face_crossings/crossing_places.h"
#include "common/geometry/surface_point.h"
#include "stages/refine/cells_beyond.h"
#include "stages/refine/changes_within.h"
#include "stages/refine/inlays.h"
#include "stages/refine/split_cells.h"
#include "stages/refine/surface_points.h"

namespace strake {

/// A result whose cells are being divided.
class Refinement {
 public:
  /// \param mesh        kept by reference
  /// \param quads       made from it
  /// \param most_sides  corners that a face beside a divided cell may get; those that it has it may
  Refinement(const TriMesh& mesh, QuadMesh quads, std::int64_t most_sides);

  [[nodiscard]] const QuadMesh& quads() const { return quads_; }
  CrossingPlaces& crossing() { return crossing_; }
  /// Goes on from another result.
  void take(QuadMesh quads) { quads_ = std::move(quads); }

  /// Puts vertices that are farther than this off the surface back onto it.
  void put_back(const SurfaceDistance& input, double tolerance);

  void drop_turned_ears();

  /// Moves the vertex nearest on the surface to each of these places of the input there, so that
  /// they are reached for certain. Vertices on feature and boundary lines stay.
  void reach(const std::vector<Excess>& excess);

  /// Parts faces that cross in a result that is within the tolerance, takes out those without
  /// area, and pairs odd cells.
  void finish(ToleranceProof& proof, const InlayLimits& limits = kInlaysUncrossed);
  /// Pairs odd cells where no tolerance holds.
  void pair_odd_cells(const std::shared_ptr<const InputSurface>& input) {
    pair_odd_cells_as_near(input, points_, quads_);
  }
  /// Cuts cells so that it is whoever measures it. \pre finished
  void cut_in_doubt(ToleranceProof& proof) { cut_cells_in_doubt(proof, quads_); }

  /// Divides cells. \param tolerance  that edges are to keep
  void divide(const ComparedSurfaces& surfaces, const std::vector<Target>& targets,
              double tolerance);

 private:
  [[nodiscard]] SurfacePoint foot_of(Index v) const {
    return strake::foot_of(quads_.provenance, v);
  }

  Index add(const SurfacePoint& point);

  void find_boundary();
  [[nodiscard]] bool is_boundary(Index a, Index b) const { return boundary_.at(a, b) != kNone; }

  /// Puts all corners of a jagged boundary on the edges of a cell that stand for it. One after the
  /// other they would come to lie across what divides the cell by then.
  /// \return whether there are any
  bool add_jags(Index cell, double tolerance, EdgeMarks& marks);

  /// \param a, b  in the sense of a face
  Index add_on_edge(Index a, Index b);

  Index add_between(Index a, Index b, const Vec3& normal);

  /// Whether an edge is farther from the surface than the tolerance, or on the boundary from what
  /// it stands for: the surface may reach beyond it there.
  [[nodiscard]] bool is_beyond(const SurfaceDistance& input, Index a, Index b,
                               double tolerance) const;

  /// Whether an edge of a face is short against the others.
  [[nodiscard]] bool is_short(std::span<const Index> face, std::size_t edge) const;

  /// Which edges of a cell get a vertex: those that are beyond the tolerance, of a quad with the
  /// ones opposite unless they are short; where none is, those across the direction that the cell
  /// is bent in.
  [[nodiscard]] std::vector<std::size_t> edges_to_divide(const ComparedSurfaces& surfaces,
                                                         const Target& target,
                                                         double tolerance) const;

  const TriMesh& mesh_;
  QuadMesh quads_;
  SurfacePoints points_;
  CrossingPlaces crossing_;
  std::size_t max_sides_;
  EdgeMarks boundary_;           ///< edges of one face
  std::vector<Vec3> positions_;  ///< [V] relative to the mesh's origin
  std::vector<Vec3> normals_;    ///< [V] sums over the faces around
};

}  // namespace strake
