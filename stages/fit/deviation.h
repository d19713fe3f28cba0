#pragma once

#include <array>
#include <vector>

#include "common/core/tri_mesh.h"
#include "common/geometry/mesh_measures.h"
#include "common/geometry/surface_distance/surface_distance.h"
#include "stages/fit/block_system.h"

namespace strake::fitting {

/// The distance of result and surface at a sample, as it was last measured.
struct Gap {
  double distance = 0;            ///< along `direction`; may be negative
  Vec3 direction = Vec3::Zero();  ///< unit, in which a move of the result by
                                  ///< `distance` closes the gap; zero: no such
  Index nearest = kNone;          ///< triangle that was nearest, of the surface or of the result
};

/// The distance between a result and the surface, both ways, as a sum of squares.
///
/// Six samples of every triangle of the result, enough for the square of a quadratic distance to be
/// summed exactly, are taken to the surface, and vertices of the input, at most four for every
/// triangle, to the result: without these, tips of the surface that no face reaches would not
/// count. Where the nearest surface faces another way (thin walls), a sample moves nothing, but its
/// distance counts, so that it cannot be made to grow unseen.
class Deviation {
 public:
  /// \param mesh, surface  the input and its faces, in the same order
  /// \param face_normals   of the input; kept by reference
  /// \param wedge_normals  [W] of the input
  /// \param triangles      number of them in the results that will be measured
  Deviation(const TriMesh& mesh, const SurfaceDistance& surface, const FaceNormals& face_normals,
            const std::vector<Vec3>& wedge_normals, std::size_t triangles);

  /// Measures from all samples again, but for those in triangles that are as they were.
  void measure(const std::vector<Vec3>& positions,
               const std::vector<std::array<Index, 3>>& triangles);

  /// Sum of area times squared distance, and the mean of the squared distance.
  [[nodiscard]] double sum() const;
  [[nodiscard]] double mean() const;
  /// The largest distance of a sample.
  [[nodiscard]] double largest() const;

  /// What moves are to lower: that sum, in which a distance d counts 1 + d / far times, where far
  /// is twice the root mean square of the first measurement. A few far places are what one sees,
  /// and weigh little in a sum of squares.
  [[nodiscard]] double cost() const;

  /// Adds the least-squares problem of closing all gaps by moves of the vertices, by the slope of
  /// the cost.
  void add_to(BlockSystem& system) const;

 private:
  using Triangle = std::array<Index, 3>;

  /// A gap measured from the surface, and where its other end was in the nearest triangle.
  struct SurfaceGap {
    Gap gap;
    std::array<double, 3> at = {0, 0, 0};  ///< barycentric
  };

  void measure_result(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles);
  void measure_surface(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles);
  [[nodiscard]] double slope_of(const Gap& gap) const;
  /// Area that a sample of the result stands for.
  [[nodiscard]] double weight(std::size_t sample) const;
  /// The sum of term(weight, gap) over all samples.
  template <class Term>
  [[nodiscard]] double sum_over(Term term) const;

  const TriMesh& mesh_;
  const SurfaceDistance& surface_;
  const FaceNormals& face_normals_;   ///< of the input
  std::vector<Vec3> positions_;       ///< of the result, as last measured
  std::vector<Triangle> triangles_;   ///< likewise
  std::vector<double> double_areas_;  ///< [T] of those
  std::vector<Gap> from_result_;      ///< [6 T] at the places of the quadrature
  std::size_t step_;                  ///< sample s of the surface is vertex s * step_ of the input
  std::vector<Vec3> normals_;         ///< [samples of the surface] of the input there
  std::vector<double> areas_;         ///< [samples of the surface] that they stand for
  std::vector<SurfaceGap> from_surface_;
  double per_far_ = -1;  ///< 1 / far, in units of length; 0 where all distances are
};

}  // namespace strake::fitting
