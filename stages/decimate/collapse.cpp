#include "stages/decimate/collapse.h"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModNormalFlippingT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>
#include <OpenMesh/Tools/Decimater/Observer.hh>
#include <algorithm>
#include <cmath>

#include "common/core/error.h"
#include "common/geometry/angles.h"

namespace strake {
namespace {

/// Share of the fourth power of an edge that is added to what its collapse costs: in flats, where
/// nothing else costs anything, short edges go first. So little that long edges that cost nothing
/// else go before short ones that bend by a few degrees, as in the flutes of a column.
constexpr double kShortFirst = 1e-10;
/// An edge may be turned where its quad turns by less along either diagonal.
constexpr double kFlatBend = 2 * kDegree;
constexpr std::size_t kReported = 1000;  ///< vertices that go from one report to the next
constexpr int kMostTurns = 10;           ///< times that all edges are looked at

struct Traits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
};
using Surface = OpenMesh::TriMesh_ArrayKernelT<Traits>;
using Quadric = OpenMesh::Geometry::QuadricT<double>;

OpenMesh::Vec3d to_openmesh(const Vec3& p) { return {p.x(), p.y(), p.z()}; }
Vec3 from_openmesh(const OpenMesh::Vec3d& p) { return {p[0], p[1], p[2]}; }

bool is_barrier(const Surface& surface, OpenMesh::EdgeHandle edge) {
  return surface.is_boundary(edge) || surface.status(edge).feature();
}

/// What the collapse of an edge costs, and whether feature and boundary lines allow it.
template <class MeshT>
class LineQuadrics : public OpenMesh::Decimater::ModBaseT<MeshT> {
 public:
  DECIMATING_MODULE(LineQuadrics, MeshT, LineQuadrics);

  explicit LineQuadrics(MeshT& surface) : Base(surface, false) {
    Base::mesh().add_property(quadric_);
  }
  LineQuadrics(const LineQuadrics&) = delete;
  LineQuadrics& operator=(const LineQuadrics&) = delete;
  ~LineQuadrics() override { Base::mesh().remove_property(quadric_); }

  /// From now on vertices of feature lines may leave them, and corners go along them.
  void give_up_features() { keeps_features_ = false; }
  /// From now on corners may go anywhere: OpenMesh keeps vertices with this flag to features.
  void give_up_corners() {
    for (const auto vertex : Base::mesh().vertices()) {
      Base::mesh().status(vertex).set_feature(false);
    }
  }

  void initialize() override {
    const MeshT& surface = Base::mesh();
    for (const auto vertex : surface.vertices()) {
      Base::mesh().property(quadric_, vertex).clear();
    }
    for (const auto face : surface.faces()) {
      auto corner = surface.cfv_iter(face);
      const auto a = *corner++;
      const auto b = *corner++;
      const auto c = *corner;
      const Vec3 origin = from_openmesh(surface.point(a));
      const Vec3 cross = (from_openmesh(surface.point(b)) - origin)
                             .cross(from_openmesh(surface.point(c)) - origin);
      add_plane(cross, origin, cross.norm() / 2, {a, b, c});
      for (const auto halfedge : surface.fh_range(face)) {
        if (!is_barrier(surface, surface.edge_handle(halfedge))) continue;
        const auto from = surface.from_vertex_handle(halfedge);
        const auto to = surface.to_vertex_handle(halfedge);
        const Vec3 start = from_openmesh(surface.point(from));
        const Vec3 way = from_openmesh(surface.point(to)) - start;
        add_plane(way.cross(cross), start, way.squaredNorm(), {from, to});
      }
    }
  }

  float collapse_priority(const CollapseInfo& edge) override {
    if (!is_allowed(edge)) return Base::ILLEGAL_COLLAPSE;
    Quadric sum = Base::mesh().property(quadric_, edge.v0);
    sum += Base::mesh().property(quadric_, edge.v1);
    const double square = (edge.p1 - edge.p0).sqrnorm();
    return static_cast<float>(std::max(0.0, sum(edge.p1)) + kShortFirst * square * square);
  }

  void preprocess_collapse(const CollapseInfo& edge) override {
    // Of the sides of a face that goes one is left, for both.
    join(edge.v0vl, edge.vlv1);
    join(edge.vrv0, edge.v1vr);
  }

  void postprocess_collapse(const CollapseInfo& edge) override {
    Base::mesh().property(quadric_, edge.v1) += Base::mesh().property(quadric_, edge.v0);
  }

 private:
  void add_plane(const Vec3& normal, const Vec3& point, double weight,
                 std::initializer_list<OpenMesh::VertexHandle> vertices) {
    const double length = normal.norm();
    if (!(length > 0)) return;
    const Vec3 n = normal / length;
    Quadric plane(n.x(), n.y(), n.z(), -n.dot(point));
    plane *= weight;
    for (const auto vertex : vertices) Base::mesh().property(quadric_, vertex) += plane;
  }

  [[nodiscard]] bool is_allowed(const CollapseInfo& edge) const {
    const MeshT& surface = edge.mesh;
    const auto along = surface.edge_handle(edge.v0v1);
    if (!keeps_features_) return !surface.is_boundary(edge.v0) || surface.is_boundary(along);
    if (surface.status(edge.v0).feature()) return false;  // a corner
    if (is_barrier(surface, along)) return true;
    for (const auto other : surface.ve_range(edge.v0)) {
      if (is_barrier(surface, other)) return false;
    }
    return true;
  }

  void join(OpenMesh::HalfedgeHandle a, OpenMesh::HalfedgeHandle b) {
    if (!a.is_valid() || !b.is_valid()) return;
    MeshT& surface = Base::mesh();
    const auto first = surface.edge_handle(a);
    const auto second = surface.edge_handle(b);
    const bool is_feature = surface.status(first).feature() || surface.status(second).feature();
    surface.status(first).set_feature(is_feature);
    surface.status(second).set_feature(is_feature);
  }

  OpenMesh::VPropHandleT<Quadric> quadric_;
  bool keeps_features_ = true;
};

using SourceVertex = OpenMesh::VPropHandleT<Index>;

/// A factor that makes the diagonal one to two long: costs, which OpenMesh keeps in floats, go by
/// the fourth power of it. Powers of two round nothing.
double unit_of(const TriMesh& mesh) { return std::exp2(-std::floor(std::log2(mesh.diagonal))); }

Surface to_openmesh(const TriMesh& mesh, const SourceVertex& source_of, Surface surface) {
  const double unit = unit_of(mesh);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const auto vertex = surface.add_vertex(to_openmesh(unit * mesh.positions[v]));
    surface.property(source_of, vertex) = v;
    surface.status(vertex).set_feature(mesh.is_corner[v] != 0);
  }
  for (const auto& [a, b, c] : mesh.faces) {
    const auto face = surface.add_face(OpenMesh::VertexHandle(a), OpenMesh::VertexHandle(b),
                                       OpenMesh::VertexHandle(c));
    if (!face.is_valid()) {
      throw AlgorithmError(
          "OpenMesh cannot build the surface to decimate; please report this model");
    }
  }
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (mesh.is_feature[h] == 0) continue;
    const auto halfedge = surface.find_halfedge(OpenMesh::VertexHandle(mesh.from(h)),
                                                OpenMesh::VertexHandle(mesh.to(h)));
    surface.status(surface.edge_handle(halfedge)).set_feature(true);
  }
  return surface;
}

/// Hands on how far the decimation is.
class Progress : public OpenMesh::Decimater::Observer {
 public:
  Progress(strake::Observer& observer, std::size_t steps)
      : OpenMesh::Decimater::Observer(kReported), observer_(observer), steps_(steps) {}
  void notify(std::size_t step) override {
    observer_.report("decimating", static_cast<double>(step) / static_cast<double>(steps_));
  }

 private:
  strake::Observer& observer_;
  std::size_t steps_;
};

void collapse(Surface& surface, std::size_t count, Observer& observer) {
  if (surface.n_vertices() <= count) return;
  OpenMesh::Decimater::DecimaterT<Surface> decimater(surface);
  LineQuadrics<Surface>::Handle lines;
  decimater.add(lines);
  OpenMesh::Decimater::ModNormalFlippingT<Surface>::Handle flipping;
  decimater.add(flipping);  // else flats fold over, where every collapse costs nothing
  Progress progress(observer, surface.n_vertices() - count);
  decimater.set_observer(&progress);
  if (!decimater.initialize()) throw AlgorithmError("decimation does not start; please report");
  std::size_t left = surface.n_vertices() - decimater.decimate_to(count);
  if (left <= count) return;
  decimater.module(lines).give_up_features();
  left -= decimater.decimate(left - count);
  if (left <= count) return;
  decimater.module(lines).give_up_corners();
  decimater.decimate(left - count);
}

/// The corners of the two triangles at an edge: its ends, and those across.
struct Diamond {
  Vec3 a, b, left, right;
};

Diamond diamond(const Surface& surface, OpenMesh::EdgeHandle edge) {
  const auto h = surface.halfedge_handle(edge, 0);
  const auto g = surface.halfedge_handle(edge, 1);
  const auto at = [&](OpenMesh::VertexHandle v) { return from_openmesh(surface.point(v)); };
  return {at(surface.from_vertex_handle(h)), at(surface.to_vertex_handle(h)),
          at(surface.to_vertex_handle(surface.next_halfedge_handle(h))),
          at(surface.to_vertex_handle(surface.next_halfedge_handle(g)))};
}

/// Whether the other diagonal leaves a flat surface as it is, with a larger smallest angle.
bool is_better_turned(const Diamond& d) {
  const Vec3 left = (d.b - d.a).cross(d.left - d.a);
  const Vec3 right = (d.a - d.b).cross(d.right - d.b);
  const Vec3 at_a = (d.right - d.a).cross(d.left - d.a);
  const Vec3 at_b = (d.left - d.b).cross(d.right - d.b);
  const double most = std::max({angle_between(left, right), angle_between(at_a, at_b),
                                angle_between(left, at_a), angle_between(left, at_b)});
  if (!(most < kFlatBend)) return false;
  const double now = std::min(smallest_angle(d.a, d.b, d.left), smallest_angle(d.b, d.a, d.right));
  const double then =
      std::min(smallest_angle(d.a, d.right, d.left), smallest_angle(d.b, d.left, d.right));
  return then > now + 1e-6;
}

void turn_flat_diagonals(Surface& surface) {
  for (int round = 0; round < kMostTurns; ++round) {
    bool any = false;
    for (const auto edge : surface.edges()) {
      if (is_barrier(surface, edge) || !surface.is_flip_ok(edge) ||
          !is_better_turned(diamond(surface, edge))) {
        continue;
      }
      surface.flip(edge);
      any = true;
    }
    if (!any) return;
  }
}

}  // namespace

CoarseSurface collapse_to(const TriMesh& mesh, Index count, Observer& observer) {
  Surface surface;
  surface.request_vertex_status();
  surface.request_edge_status();
  surface.request_halfedge_status();
  surface.request_face_status();
  surface.request_face_normals();
  SourceVertex source_of;
  surface.add_property(source_of);
  surface = to_openmesh(mesh, source_of, std::move(surface));
  surface.update_face_normals();
  collapse(surface, static_cast<std::size_t>(count), observer);
  surface.garbage_collection();
  turn_flat_diagonals(surface);

  CoarseSurface result;
  for (const auto vertex : surface.vertices()) {
    result.positions.emplace_back(from_openmesh(surface.point(vertex)) / unit_of(mesh));
    result.vertex.push_back(surface.property(source_of, vertex));
  }
  for (const auto face : surface.faces()) {
    std::array<Index, 3> corners = {};
    std::size_t i = 0;
    for (const auto halfedge : surface.fh_range(face)) {
      corners[i++] = surface.from_vertex_handle(halfedge).idx();
      result.is_barrier.push_back(is_barrier(surface, surface.edge_handle(halfedge)) ? 1 : 0);
    }
    result.faces.push_back(corners);
  }
  return result;
}

}  // namespace strake
