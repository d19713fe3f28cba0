#pragma once

#include <array>
#include <vector>

#include "common/core/tri_mesh.h"
#include "common/geometry/surface_distance/surface_distance.h"
#include "stages/fit/block_system.h"

namespace strake::fitting {

/// A place where the distance of result and surface was measured.
struct DistanceSample {
  Vec3 place = Vec3::Zero();      ///< it was measured from
  double distance = 0;            ///< along `direction`; may be negative
  Vec3 direction = Vec3::Zero();  ///< unit, in which a move of the result by
                                  ///< `distance` closes the gap; zero: no such
  double weight = 0;              ///< area that it stands for
  std::array<Index, 3> corners = {kNone, kNone, kNone};  ///< of the result's triangle there
  std::array<double, 3> at = {0, 0, 0};                  ///< barycentric, in that triangle
  Index nearest = kNone;  ///< triangle that was nearest, of the surface or of the result
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
  /// \param face_normals   [F] of the input; kept by reference
  /// \param wedge_normals  [W] of the input
  Deviation(const TriMesh& mesh, const SurfaceDistance& surface,
            const std::vector<Vec3>& face_normals, const std::vector<Vec3>& wedge_normals);

  /// Measures from all samples again. \param triangles  as many as the last time
  void measure(const std::vector<Vec3>& positions,
               const std::vector<std::array<Index, 3>>& triangles);

  /// Sum of area times squared distance, and the mean of the squared distance.
  [[nodiscard]] double sum() const;
  [[nodiscard]] double mean() const;

  /// What moves are to lower: that sum, in which a distance d counts 1 + d / far times, where far
  /// is twice the root mean square of the first measurement. A few far places are what one sees,
  /// and weigh little in a sum of squares.
  [[nodiscard]] double cost() const;

  /// Adds the least-squares problem of closing all gaps by moves of the vertices, by the slope of
  /// the cost.
  void add_to(BlockSystem& system) const;

 private:
  void measure_result(const std::vector<Vec3>& positions,
                      const std::vector<std::array<Index, 3>>& triangles);
  [[nodiscard]] double slope_of(const DistanceSample& sample) const;
  void measure_surface(const std::vector<Vec3>& positions,
                       const std::vector<std::array<Index, 3>>& triangles);

  const TriMesh& mesh_;
  const SurfaceDistance& surface_;
  const std::vector<Vec3>& face_normals_;    ///< of the input
  std::vector<Vec3> vertex_normals_;         ///< of the input
  std::vector<double> vertex_areas_;         ///< of the input
  std::vector<DistanceSample> from_result_;  ///< six for each triangle
  std::vector<DistanceSample> from_surface_;
  double per_far_ = -1;  ///< 1 / far, in units of length; 0 where all distances are
};

}  // namespace strake::fitting
