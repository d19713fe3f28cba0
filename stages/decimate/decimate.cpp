#include "stages/decimate/decimate.h"

#include <utility>

#include "common/geometry/carry_attributes.h"
#include "common/geometry/poly_topology/face_shape.h"
#include "common/geometry/poly_topology/poly_topology.h"
#include "common/geometry/poly_topology/same_topology.h"
#include "common/geometry/surface_point.h"
#include "stages/decimate/collapse.h"
#include "stages/decimate/pair_triangles.h"

namespace strake {
namespace {

/// Vertices of a result that are those of the surface.
VertexProvenance provenance_of(const TriMesh& mesh, const std::vector<Index>& vertices) {
  VertexProvenance result;
  for (const Index v : vertices) add_foot(result, point_at_vertex(mesh, v));
  return result;
}

}  // namespace

DecimateResult decimate_to_quads(const TriMesh& mesh, const DecimateOptions& options,
                                 Observer& observer) {
  const auto count = static_cast<Index>(options.vertices);
  const CoarseSurface coarse = collapse_to(mesh, count, observer);
  observer.report("pairing triangles", 0);
  DecimateResult result;
  result.quads.mesh_id = mesh.id;
  result.quads.mesh = pair_triangles(coarse);
  for (Vec3& p : result.quads.mesh.positions) p += mesh.origin;
  result.quads.provenance = provenance_of(mesh, coarse.vertex);
  begin_faces_at_fans(result.quads.mesh);
  result.quads.mesh.attributes = carry_attributes(mesh, result.quads.mesh, result.quads.provenance);
  const PolyTopology topology = analyse(result.quads.mesh);
  require_same_topology(mesh, topology, "the decimated mesh");
  const Index reached = result.quads.mesh.vertex_count();
  if (reached > count) {
    result.report.warn("decimation ends at " + std::to_string(reached) + " vertices where " +
                       std::to_string(count) +
                       " were wanted: fewer would change the topology of the surface");
  }
  result.report.set("decimate.vertices", std::int64_t{reached});
  result.report.set("decimate.faces", std::int64_t{topology.faces});
  result.report.set("decimate.quads", std::int64_t{topology.quads});
  return result;
}

}  // namespace strake
