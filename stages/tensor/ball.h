#pragma once

#include <array>
#include <vector>

#include "common/core/tri_mesh.h"

namespace strake {

/// Length of the part of segment a-b inside the ball of radius r around the origin.
double clipped_length(const Vec3& a, const Vec3& b, double r);

/// Area of the part of triangle a-b-c inside the ball of radius r around the origin.
double clipped_area(const Vec3& a, const Vec3& b, const Vec3& c, double r);

/// Sums normal cycles over mesh-connected balls; keeps its work arrays between calls.
class BallWalker {
 public:
  /// \param normals [F] unit;  \param bend [3F] signed dihedral angle over the
  /// length of the edge, 0 on barriers
  BallWalker(const TriMesh& mesh, const std::vector<Vec3>& normals, const std::vector<float>& bend);

  /// The tensor (xx, xy, xz, yy, yz, zz) of the ball around the corner `h`, reached from its wedge
  /// without crossing features or faces that turn away from `normal`.
  std::array<double, 6> tensor(Index h, const Vec3& normal, double radius);

 private:
  void visit(Index face);
  bool is_visited(Index face) const { return stamp_[face] == current_; }

  const TriMesh& mesh_;
  const std::vector<Vec3>& normals_;
  const std::vector<float>& bend_;
  std::vector<std::uint32_t> stamp_;
  std::uint32_t current_ = 0;
  std::vector<Index> front_;
};

}  // namespace strake
