#include "stages/prolong/prolong.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <complex>

#include "common/core/error.h"
#include "common/geometry/frames.h"
#include "common/geometry/mesh_measures.h"
#include "common/geometry/surface_distance/surface_distance.h"
#include "common/geometry/topology/own_component.h"

namespace strake {
namespace {

using Complex = std::complex<double>;

/// How much farther than the nearest face one may be that faces the same way, in lengths of the
/// longest edge of that one.
constexpr double kFarther = 2;
/// Sums of crosses shorter than this have no direction.
constexpr double kCancelled = 1e-6;

/// A place of the coarser mesh.
struct CoarsePlace {
  std::array<Index, 3> wedges;
  std::array<double, 3> weights;  ///< barycentric
};

/// Finds places of the mesh on its coarser one.
class Descent {
 public:
  Descent(const TriMesh& mesh, const TriMesh& coarse)
      : mesh_(mesh),
        coarse_(coarse),
        surface_(coarse.positions, coarse.faces),
        face_normals_(coarse) {}

  /// \param normal  unit, of the wedge
  /// \param guess   a face near it, or kNone; becomes the face that was nearest
  [[nodiscard]] CoarsePlace place(Index wedge, const Vec3& normal, Index& guess) const {
    const Vec3& p = mesh_.positions[mesh_.wedge_vertex[wedge]];
    ClosestPoint at = surface_.closest_near(p, guess);
    guess = at.triangle;
    const auto faces_same_way = [&](Index f) { return face_normals_[f].dot(normal) > kSameSheet; };
    if (!faces_same_way(at.triangle)) {
      const double reach = at.distance + kFarther * longest_edge(at.triangle);
      const ClosestPoint beyond = surface_.closest_if(p, reach, faces_same_way);
      if (beyond.triangle != kNone) at = beyond;
    }
    return {coarse_.face_wedges[at.triangle], at.barycentric};
  }

 private:
  [[nodiscard]] double longest_edge(Index face) const {
    const auto& [a, b, c] = coarse_.faces[face];
    const std::vector<Vec3>& p = coarse_.positions;
    return std::max({(p[b] - p[a]).norm(), (p[c] - p[b]).norm(), (p[a] - p[c]).norm()});
  }

  const TriMesh& mesh_;
  const TriMesh& coarse_;
  SurfaceDistance surface_;
  FaceNormals face_normals_;
};

/// Sets the field at a wedge whose normal is known to what it is at a place of the coarser mesh.
void interpolate(const PrincipalField& coarse, const CoarsePlace& at, Index wedge,
                 PrincipalField& field) {
  const Vec3& normal = field.normal[wedge];
  const TangentFrame frame = tangent_frame(normal);
  double mean = 0;    // of a tensor's two curvatures
  Complex deviation;  // of that along the frame's x from it, and the part between x and y
  Complex cross;
  double confidence = 0;
  for (int i = 0; i < 3; ++i) {
    const Index w = at.wedges[i];
    const auto flatten = [&](const Vec3& v) {
      return frame.tangent_from_world(rotate_between(coarse.normal[w], normal, v));
    };
    const Vec2 t_min = flatten(coarse.t_min[w]);
    const Complex turn(t_min.x(), t_min.y());
    mean += at.weights[i] * (coarse.k_min[w] + coarse.k_max[w]) / 2;
    deviation += at.weights[i] * (coarse.k_min[w] - coarse.k_max[w]) / 2 * turn * turn;
    cross += at.weights[i] * cross_power(flatten(coarse.cross[w]));
    confidence += at.weights[i] * coarse.wedge_confidence[w];
  }
  const Eigen2 eigen =
      eigen_symmetric2(mean + deviation.real(), deviation.imag(), mean - deviation.real());
  const Vec2 t_min(-eigen.direction_of_larger.y(), eigen.direction_of_larger.x());
  field.k_min[wedge] = eigen.smaller;
  field.k_max[wedge] = eigen.larger;
  field.t_min[wedge] = frame.world_from_tangent(t_min).normalized();
  const bool has_cross = coarse.cross_extended && std::abs(cross) > kCancelled;
  field.cross[wedge] = has_cross ? frame.world_from_tangent(cross_arm(cross, t_min)).normalized()
                                 : field.t_min[wedge];
  field.wedge_confidence[wedge] = std::clamp(confidence, 0.0, 1.0);
}

void copy_wedge(const PrincipalField& coarse, Index from, PrincipalField& field, Index to) {
  field.normal[to] = coarse.normal[from];
  field.t_min[to] = coarse.t_min[from];
  field.k_min[to] = coarse.k_min[from];
  field.k_max[to] = coarse.k_max[from];
  field.cross[to] = coarse.cross[from];
  field.wedge_confidence[to] = coarse.wedge_confidence[from];
}

}  // namespace

PrincipalField prolong_field(const TriMesh& mesh, const TriMesh& coarse,
                             const PrincipalField& field) {
  if (field.guides.line_count() > 0) {
    throw UsageError(
        "the field follows guides, whose places are on the coarser mesh; smooth on the mesh "
        "itself");
  }
  const auto count = static_cast<std::size_t>(mesh.wedge_count());
  PrincipalField own;
  own.mesh_id = mesh.id;
  own.cross_extended = field.cross_extended;
  own.normal = wedge_normals(mesh, FaceNormals(mesh));
  own.t_min.resize(count);
  own.k_min.resize(count);
  own.k_max.resize(count);
  own.cross.resize(count);
  own.wedge_confidence.resize(count);
  std::vector<Index> child(count, kNone);
  for (Index w = 0; w < coarse.wedge_count(); ++w) child[coarse.parent_wedge[w]] = w;
  const Descent descent(mesh, coarse);
  tbb::parallel_for(tbb::blocked_range<Index>(0, mesh.wedge_count()), [&](const auto& range) {
    Index guess = kNone;
    for (Index w = range.begin(); w != range.end(); ++w) {
      if (child[w] != kNone) {
        copy_wedge(field, child[w], own, w);
      } else {
        interpolate(field, descent.place(w, own.normal[w], guess), w, own);
      }
    }
  });
  own.face_confidence.reserve(mesh.faces.size());
  for (const auto& [a, b, c] : mesh.face_wedges) {
    own.face_confidence.push_back(
        (own.wedge_confidence[a] + own.wedge_confidence[b] + own.wedge_confidence[c]) / 3);
  }
  return own;
}

}  // namespace strake
