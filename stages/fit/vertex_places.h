#pragma once

#include <cstdint>
#include <vector>

#include "common/core/fields.h"
#include "common/core/poly_mesh.h"
#include "common/core/tri_mesh.h"
#include "common/geometry/border_course.h"
#include "common/geometry/mesh_measures.h"
#include "common/geometry/surface_distance/surface_distance.h"
#include "common/geometry/surface_point.h"
#include "common/geometry/topology/own_component.h"

namespace strake::fitting {

/// Where the vertices of a result may go, and where they belong on the surface.
///
/// A vertex on a feature or boundary line stays on it: it slides along the line's edges, up to the
/// corner where the line ends, or once around. One that comes off a ragged boundary slides along
/// the course of that. Corners do not move at all, nor does a component that is the input's
/// triangles. One beside a guide line of the field is put onto it, and moves along the surface's
/// normal only. All others move freely, and their foot on the surface follows, on its component.
class VertexPlaces {
 public:
  /// \param mesh, surface  the input and its faces, in the same order
  /// \param field          its normals are taken, to save time and memory; nullptr: those of `mesh`,
  ///                       and no guide lines
  VertexPlaces(const TriMesh& mesh, const SurfaceDistance& surface, const QuadMesh& quads,
               const PrincipalField* field = nullptr);
  VertexPlaces(const VertexPlaces&) = delete;
  VertexPlaces& operator=(const VertexPlaces&) = delete;

  /// [V] relative to the mesh's origin.
  [[nodiscard]] const std::vector<Vec3>& positions() const { return positions_; }
  /// Unit normal of the surface at the vertex's foot.
  [[nodiscard]] const Vec3& normal(Index v) const { return normals_[v]; }
  /// Distance from the surface's tangent plane there; negative inside.
  [[nodiscard]] double height(Index v) const;
  /// Of the input, the second [W] unit.
  [[nodiscard]] const FaceNormals& face_normals() const { return face_normals_; }
  [[nodiscard]] const std::vector<Vec3>& wedge_normals() const { return wedge_normals_; }
  [[nodiscard]] bool is_free(Index v) const { return lines_[v].kind == Kind::free; }
  [[nodiscard]] bool is_on_line(Index v) const { return lines_[v].kind == Kind::line; }
  /// Unit direction of the line that the vertex slides along. \pre is_on_line(v)
  [[nodiscard]] Vec3 line_tangent(Index v) const { return tangent(lines_[v]); }
  /// One arm of the cross that edges turn to at the vertex's foot; zero where it cancels.
  [[nodiscard]] Vec3 cross_arm(const PrincipalField& field, Index v) const;
  /// |k_max - k_min| at the vertex's foot, 1/length.
  [[nodiscard]] double anisotropy(const PrincipalField& field, Index v) const;
  /// Places of the input's boundary vertices between two vertices of a boundary edge, in the order
  /// of its face; four of them where there are more. None where neither can slide.
  [[nodiscard]] std::vector<Vec3> boundary_between(Index a, Index b) const;
  /// Projects onto the directions in which the vertex may move: rank 3, 1 or 0.
  [[nodiscard]] Mat3 freedom(Index v) const;

  /// Moves a vertex as far as it may go; on a line by the share of `move` along it.
  void move(Index v, const Vec3& move);
  /// Finds the feet and normals of vertices again after moves.
  void update_feet();

  /// [V] where the vertices are, to return to.
  struct State;
  [[nodiscard]] std::vector<State> states() const;
  [[nodiscard]] State state(Index v) const;
  void restore(Index v, const State& state);

  /// Writes positions and provenance to a result.
  void store(QuadMesh& quads) const;

 private:
  enum class Kind : std::uint8_t { free, line, guided, fixed };
  /// A place on the line of barrier edges that a vertex slides along.
  struct LinePlace {
    Kind kind = Kind::free;
    Index halfedge = kNone;     ///< a barrier
    double along = 0;           ///< in [0, 1] from its origin
    bool is_on_course = false;  ///< of a ragged boundary, instead of on its edges
  };

  void place_on_line(Index v);
  /// \param way  from the vertex's foot to the guide
  void put_on_guide(Index v, const Vec3& way);
  /// The point of the sheet on which the foot of a vertex lies that is nearest to `p`.
  [[nodiscard]] ClosestPoint nearest_foot(Index v, const Vec3& p) const;
  /// Whether lines end at a vertex of the input.
  [[nodiscard]] bool is_corner(Index vertex) const {
    return (borders_.is_corner.empty() ? mesh_.is_corner : borders_.is_corner)[vertex] != 0;
  }
  /// Whether a vertex on a line is where the course of a ragged boundary is, and not that.
  [[nodiscard]] bool is_off_boundary(Index v) const;
  [[nodiscard]] std::vector<Index> barriers_around(Index vertex) const;
  [[nodiscard]] Index other_barrier(Index vertex, Index halfedge) const;
  /// An end of the half-edge that a vertex slides along.
  [[nodiscard]] Vec3 line_end(const LinePlace& place, Index vertex) const;
  [[nodiscard]] Vec3 tangent(const LinePlace& place) const;
  /// The half-edge of the boundary that a vertex lies on, or that goes on from it; kNone: inside.
  [[nodiscard]] Index boundary_at(Index v) const;
  [[nodiscard]] LinePlace slide(LinePlace place, double distance) const;
  [[nodiscard]] Vec3 at(const LinePlace& place) const;
  [[nodiscard]] Vec3 normal_at_foot(Index v) const;

  const TriMesh& mesh_;
  const SurfaceDistance& surface_;
  OwnComponent components_;  ///< of the input
  BorderCourse borders_;
  FaceNormals face_normals_;                ///< of the input
  std::vector<Vec3> own_normals_;           ///< [W] empty where the field has them
  const std::vector<Vec3>& wedge_normals_;  ///< of the input
  std::vector<Vec3> positions_;             ///< [V] of the result
  std::vector<Vec3> normals_;               ///< [V] at the feet
  std::vector<LinePlace> lines_;            ///< [V]
  std::vector<SurfacePoint> feet_;          ///< [V]
};

struct VertexPlaces::State {
  Vec3 position;
  LinePlace line;
};

}  // namespace strake::fitting
