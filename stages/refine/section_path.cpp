#include "stages/refine/section_path.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "common/geometry/surface_distance/surface_distance.h"
#include "common/geometry/topology/vertex_ring.h"
#include "stages/refine/way_split.h"

namespace strake {
namespace {

constexpr int kMostSteps = 100000;

/// The cut of a plane with the mesh, followed face by face.
class Section {
 public:
  Section(const TriMesh& mesh, const Vec3& origin, const Vec3& normal)
      : mesh_(mesh), origin_(origin), normal_(normal) {}

  /// Whether the plane cuts the half-edge; vertices in the plane count as above it.
  [[nodiscard]] bool cuts(Index h) const {
    return (height(mesh_.from(h)) >= 0) != (height(mesh_.to(h)) >= 0);
  }
  [[nodiscard]] Vec3 cut(Index h) const {
    const Index v = std::min(mesh_.from(h), mesh_.to(h));
    const Index w = std::max(mesh_.from(h), mesh_.to(h));
    const double a = height(v);
    const double share = a / (a - height(w));
    return mesh_.positions[v] + share * (mesh_.positions[w] - mesh_.positions[v]);
  }
  /// The half-edge by which the cut leaves the face into which `h` leads; kNone at the boundary.
  [[nodiscard]] Index next(Index h) const {
    const Index in = mesh_.twin[h];
    if (in == kNone) return kNone;
    const Index left = TriMesh::next(in);
    return cuts(left) ? left : TriMesh::next(left);
  }

 private:
  [[nodiscard]] double height(Index v) const { return normal_.dot(mesh_.positions[v] - origin_); }

  const TriMesh& mesh_;
  Vec3 origin_;
  Vec3 normal_;
};

/// A way over faces: straight from places[i] to places[i + 1] in faces[i].
struct Way {
  std::vector<Vec3> places;
  std::vector<Index> faces;
  double length = 0;

  void go(Index face, const Vec3& to) {
    length += (to - places.back()).norm();
    places.push_back(to);
    faces.push_back(face);
  }
};

bool contains(const std::vector<Index>& faces, Index face) {
  return std::find(faces.begin(), faces.end(), face) != faces.end();
}

SurfacePoint split_of(const TriMesh& mesh, const Way& way) {
  const auto [piece, share] = split_of_way(way.places);
  const Vec3 p = way.places[piece] + share * (way.places[piece + 1] - way.places[piece]);
  const auto& [a, b, c] = mesh.faces[way.faces[piece]];
  const ClosestPoint at =
      closest_point_on_triangle(p, mesh.positions[a], mesh.positions[b], mesh.positions[c]);
  return {way.faces[piece], at.barycentric};
}

}  // namespace

std::vector<Index> faces_around(const TriMesh& mesh, const SurfacePoint& point) {
  std::vector<Index> faces;
  const Index corner = corner_at(point);
  if (corner != kNone) {
    for_each_outgoing(mesh, mesh.from(corner),
                      [&](Index h) { faces.push_back(TriMesh::face_of(h)); });
    return faces;
  }
  faces.push_back(point.face);
  const Index inner = edge_at(point, [&](Index h) { return !mesh.is_boundary(h); });
  if (inner != kNone) faces.push_back(TriMesh::face_of(mesh.twin[inner]));
  return faces;
}

std::optional<SurfacePoint> split_of_section(const TriMesh& mesh, const SurfacePoint& a,
                                             const SurfacePoint& b, const Vec3& normal,
                                             double longest) {
  const Vec3 from = place_of(mesh, a);
  const Vec3 to = place_of(mesh, b);
  const Vec3 across = (to - from).cross(normal);
  if (!(across.norm() > 0)) return std::nullopt;
  const Section section(mesh, from, across.normalized());
  const std::vector<Index> starts = faces_around(mesh, a);
  const std::vector<Index> ends = faces_around(mesh, b);
  for (const Index face : starts) {
    if (!contains(ends, face)) continue;
    Way way{{from}, {}, 0};
    way.go(face, to);
    return split_of(mesh, way);
  }
  std::optional<Way> best;
  for (const Index face : starts) {
    for (int i = 0; i < 3; ++i) {
      Index h = 3 * face + i;
      if (!section.cuts(h)) continue;
      Way way{{from}, {}, 0};
      way.go(face, section.cut(h));
      for (int step = 0; step < kMostSteps && way.length <= longest; ++step) {
        if (mesh.is_boundary(h)) break;
        const Index entered = TriMesh::face_of(mesh.twin[h]);
        if (contains(ends, entered)) {
          way.go(entered, to);
          if (way.length <= longest && (!best || way.length < best->length)) best = way;
          break;
        }
        h = section.next(h);
        way.go(entered, section.cut(h));
      }
    }
  }
  if (!best) return std::nullopt;
  return split_of(mesh, *best);
}

}  // namespace strake
