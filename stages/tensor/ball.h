#pragma once

#include <array>
#include <vector>

#include "common/core/tri_mesh.h"

namespace strake {

/// Length of the part of segment a-b inside the ball of radius r around the origin.
double clipped_length(const Vec3& a, const Vec3& b, double r);

/// Area of the part of triangle a-b-c inside the ball of radius r around the origin.
double clipped_area(const Vec3& a, const Vec3& b, const Vec3& c, double r);

/// What the faces of a mesh add to the balls that hold them whole: most faces of a ball.
///
/// An edge's normal cycle is shared by its two faces, half each.
class FaceCycles {
 public:
  struct Tile {
    std::array<float, 3> centre;
    float radius;                    ///< of a ball around `centre` that holds the face, rounded up
    std::array<Index, 3> neighbour;  ///< face across each edge; kNone at barriers
    float area;
    std::array<float, 6> cycle;  ///< xx, xy, xz, yy, yz, zz
  };

  /// \param normals [F] unit; kept by reference
  FaceCycles(const TriMesh& mesh, const std::vector<Vec3>& normals);

  [[nodiscard]] const TriMesh& mesh() const { return mesh_; }
  [[nodiscard]] const Vec3& normal(Index face) const { return normals_[face]; }
  [[nodiscard]] const Tile& tile(Index face) const { return tiles_[face]; }
  /// Half of the signed dihedral angle over the length of the edge, positive where convex; 0 on
  /// barriers and where the edge has no length.
  [[nodiscard]] float half_bend(Index h) const { return half_bend_[h]; }

 private:
  [[nodiscard]] float half_bend_of(Index h) const;
  [[nodiscard]] Tile tile_of(Index face) const;

  const TriMesh& mesh_;
  const std::vector<Vec3>& normals_;
  std::vector<float> half_bend_;  ///< [3F]
  std::vector<Tile> tiles_;       ///< [F]
};

/// How large a ball is to be.
struct BallSize {
  double radius;             ///< model units
  double least_radius = 0;   ///< below which the ball does not shrink, model units
  Index most_faces = kNone;  ///< beyond which it shrinks; kNone: never
};

/// Sums normal cycles over mesh-connected balls; keeps its work arrays between calls.
class BallWalker {
 public:
  /// \param cycles  kept by reference
  explicit BallWalker(const FaceCycles& cycles);

  /// The tensor (xx, xy, xz, yy, yz, zz) of the ball around the corner `h`, reached from its wedge
  /// without crossing features or faces that turn away from `normal`.
  ///
  /// Where it shrinks it holds about half of the most faces.
  std::array<double, 6> tensor(Index h, const Vec3& normal, const BallSize& size);
  /// Balls so far that have shrunk.
  [[nodiscard]] Index shrunk() const { return shrunk_; }

 private:
  bool sum(Index h, const Vec3& normal, double radius, Index most);
  [[nodiscard]] double median_distance(const Vec3& centre);
  bool visit(Index face, const Vec3& normal);
  void add_whole(Index face, const Vec3& normal);
  void add_large(Index face, const Vec3& centre, double radius, const Vec3& normal);
  void add_small(Index face, const Vec3& centre, double radius, const Vec3& normal);

  const FaceCycles& cycles_;
  std::vector<std::uint32_t> stamp_;
  std::uint32_t current_ = 0;
  std::vector<Index> front_;
  std::vector<float> distance_;
  Index shrunk_ = 0;
  double area_ = 0;
  std::array<double, 6> sum_{};
};

}  // namespace strake
