#include "strake/report/result_edges.h"

#include "stages/evaluate/measured_surface.h"

namespace strake::report {

std::vector<double> ResultEdges::face_angles() const {
  if (angles.empty()) return {};
  std::vector<double> angle(mesh.face_count(), 0);
  std::vector<double> length(mesh.face_count(), 0);
  for (Index e = 0; e < edges.edge_count(); ++e) {
    if (angles[e].principal_deg < 0) continue;
    for (const Index side : edges.sides_of(e)) {
      const Index face = edges.corner_face[side];
      angle[face] += angles[e].principal_deg * angles[e].length;
      length[face] += angles[e].length;
    }
  }
  for (std::size_t f = 0; f < angle.size(); ++f)
    angle[f] = length[f] > 0 ? angle[f] / length[f] : -1;
  return angle;
}

ResultEdges measure_edges(const TriMesh& mesh, const PrincipalField* field, const QuadMesh& quads) {
  ResultEdges result{quads.mesh, {}, {}};
  for (Vec3& p : result.mesh.positions) p -= mesh.origin;
  result.edges = collect_edges(result.mesh);
  if (field != nullptr) {
    const evaluation::MeasuredSurface surface(mesh.positions, mesh.faces, "the mesh");
    result.angles =
        evaluation::measure_edge_angles(mesh, surface, *field, result.mesh, result.edges);
  }
  return result;
}

}  // namespace strake::report
