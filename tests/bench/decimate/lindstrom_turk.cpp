#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <CGAL/boost/graph/IO/polygon_mesh_io.h>

#include <array>

#include "tests/bench/decimate/decimate.h"
#include "tests/bench/decimate/read_mesh.h"

namespace strake::bench {
namespace {

using Point = CGAL::Simple_cartesian<double>::Point_3;
using Surface = CGAL::Surface_mesh<Point>;

/// Stops at a number of vertices; CGAL's own predicates count edges.
struct VertexCount {
  std::size_t wanted;

  template <class Cost, class Profile>
  bool operator()(const Cost& /*cost*/, const Profile& profile, std::size_t /*initial*/,
                  std::size_t /*current*/) const {
    return profile.surface_mesh().number_of_vertices() <= wanted;
  }
};

/// The vertices that faces use, and the faces. CGAL's own readers refuse some files of the tests.
Surface surface_of(const Mesh& mesh) {
  Surface surface;
  std::vector<Surface::Vertex_index> copies(mesh.n_vertices());
  for (const auto vertex : mesh.vertices()) {
    if (mesh.is_isolated(vertex)) continue;
    const Mesh::Point& p = mesh.point(vertex);
    copies[static_cast<std::size_t>(vertex.idx())] = surface.add_vertex(Point(p[0], p[1], p[2]));
  }
  for (const auto face : mesh.faces()) {
    std::array<Surface::Vertex_index, 3> corners;
    std::size_t i = 0;
    for (const auto vertex : mesh.fv_range(face)) {
      corners[i++] = copies[static_cast<std::size_t>(vertex.idx())];
    }
    if (surface.add_face(corners[0], corners[1], corners[2]) == Surface::null_face()) {
      throw DecimationError("CGAL does not take the mesh as a manifold");
    }
  }
  return surface;
}

}  // namespace

std::size_t decimate_by_lindstrom_turk(const std::string& input, const std::string& output,
                                       std::size_t vertices) {
  Surface surface = surface_of(read_mesh(input));
  CGAL::Surface_mesh_simplification::edge_collapse(surface, VertexCount{vertices});
  surface.collect_garbage();
  if (!CGAL::IO::write_polygon_mesh(output, surface, CGAL::parameters::stream_precision(12))) {
    throw DecimationError("CGAL cannot write '" + output + "'");
  }
  return surface.number_of_vertices();
}

}  // namespace strake::bench
