#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <vector>

#include "common/core/observer.h"
#include "common/geometry/cell_error/compared_surfaces.h"

namespace strake {

/// A place of a surface that is farther from the other one than it should be.
struct Excess {
  double distance = 0;        ///< model units
  Vec3 place = Vec3::Zero();  ///< relative to the mesh's origin
  Index cell = kNone;         ///< face of the result: that of the place, or that nearest to it
  Index input_face = kNone;   ///< face of the input where the place is on the input
};

/// Finds where two surfaces are not within a tolerance of each other.
///
/// Not by samples: the distance to one triangle is convex, so where all corners of a piece are
/// within the tolerance of the same triangle of the other surface, all of the piece is. Pieces for
/// which that does not hold are cut where one triangle ceases to be near, or halved, down to a
/// small share of the tolerance; what is undecided then counts as an excess. Triangles without area
/// are no part of a surface: they need not be near, and nothing is near to them.
/// \param tolerance  model units, positive
/// \return the worst place of each triangle, of either surface, that is not proven to be within the
///         tolerance everywhere; none where all is. Deterministic for any thread count
/// Cost O(n log n) with few pieces beyond the larger number of faces, unless much lies close to the
/// tolerance.
std::vector<Excess> check_tolerance(const ComparedSurfaces& surfaces, double tolerance);

/// A proof would take more work than it may.
struct ProofTooLong : std::runtime_error {
  ProofTooLong() : std::runtime_error("the proof of a tolerance takes too long") {}
};

/// `check_tolerance` for one result after another of the same input: triangles of a result that
/// were in the one before, and those of the input that such triangles are near to, need not be
/// proven again.
class ToleranceProof {
 public:
  /// \param tolerance  model units, positive
  ToleranceProof(std::shared_ptr<const InputSurface> input, double tolerance);

  [[nodiscard]] const std::shared_ptr<const InputSurface>& input() const { return input_; }
  [[nodiscard]] double tolerance() const { return tolerance_; }

  /// Reports a phase before each check from now on, so that what takes many can be cancelled.
  /// \param observer  kept by reference
  void report_to(Observer& observer, std::string phase);

  /// From now on at most so many pieces of triangles are looked at in all, beside the first few of
  /// each triangle: needles across others would take millions.
  /// \post where that does not do, checks throw ProofTooLong, whatever the number of threads
  void limit(std::int64_t pieces) { pieces_left_ = pieces; }

  /// Takes a result as it is for proven, and what is nearest to the vertices of each face of the
  /// input for near to all of it: from now on only what results have that is not of this one is
  /// checked, besides cells of this one that are not assumed.
  /// \param is_checked  [F of the result] 1: such a cell; empty: none is
  /// \pre `surfaces` compares with `input`
  void assume(const ComparedSurfaces& surfaces, std::span<const char> is_checked = {});

  /// \return as `check_tolerance`. \pre `surfaces` compares with `input`
  std::vector<Excess> check(const ComparedSurfaces& surfaces);

  /// The faces of a result that may be beyond the tolerance for whoever measures it again, as
  /// rounding alone decides how they are cut into triangles (see `other_triangulations`), and those
  /// beside them of which that is so.
  /// \pre `check` finds nothing
  /// \return ascending
  std::vector<Index> cells_in_doubt(const ComparedSurfaces& surfaces);

 private:
  /// Bits of the coordinates of the three corners.
  using Triangle = std::array<std::uint64_t, 9>;
  struct Hash {
    std::size_t operator()(const Triangle& triangle) const;
  };

  std::vector<Excess> check(const SurfaceDistance& result, const std::vector<Index>& cell);
  void carry_over(const SurfaceDistance& result);
  std::vector<char> take_what_is_assumed();

  std::shared_ptr<const InputSurface> input_;
  double tolerance_;
  std::int64_t pieces_left_ = std::numeric_limits<std::int64_t>::max();
  Observer* observer_ = nullptr;
  std::string phase_;
  std::unordered_map<Triangle, Index, Hash> number_;  ///< of the last result's triangles
  std::vector<char> is_proven_;                       ///< [triangles of it] 1: nowhere beyond
  /// [F] a triangle of it that the face is near to, or a part of the face; kNone: not proven
  std::vector<Index> near_;
  /// Faces that take further ones, with these.
  std::unordered_map<Index, std::vector<Index>> others_near_;
  std::unordered_map<Triangle, Index, Hash> assumed_number_;  ///< of the assumed result's triangles
  std::size_t assumed_triangles_ = 0;  ///< of that result, also those that are checked
  std::vector<Index> assumed_near_;    ///< [V] such a triangle, nearest to the vertex; or empty
};

}  // namespace strake
