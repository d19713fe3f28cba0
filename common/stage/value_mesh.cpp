#include <algorithm>
#include <limits>

#include "common/core/error.h"
#include "common/stage/overloaded.h"
#include "common/stage/value.h"

namespace strake {
namespace {

/// Whether every index that `lines` holds exists in `mesh`.
bool fits(const TriMesh& mesh, const LineSet& lines) {
  return lines.spacing_along_min.size() == mesh.wedge_vertex.size() &&
         std::all_of(
             lines.points.begin(), lines.points.end(),
             [&](const LinePoint& point) { return point.halfedge < mesh.halfedge_count(); }) &&
         std::all_of(lines.chord_face.begin(), lines.chord_face.end(),
                     [&](Index face) { return face < mesh.face_count(); });
}

bool fits(const TriMesh& mesh, const Value& value) {
  const std::size_t wedges = mesh.wedge_vertex.size();
  return std::visit(Overloaded{
                        [&](const TensorField& field) { return field.tensor.size() == wedges; },
                        [&](const PrincipalField& field) {
                          const auto& faces = field.guides.face;
                          return field.normal.size() == wedges &&
                                 field.face_confidence.size() == mesh.faces.size() &&
                                 std::all_of(faces.begin(), faces.end(),
                                             [&](Index face) { return face < mesh.face_count(); });
                        },
                        [&](const LineSet& lines) { return fits(mesh, lines); },
                        [&](const TensorPart& part) {
                          return part.wedge.empty() || part.wedge.back() < mesh.wedge_count();
                        },
                        [&](const QuadMesh& quads) {
                          const auto& faces = quads.provenance.face;
                          return std::all_of(faces.begin(), faces.end(),
                                             [&](Index face) { return face < mesh.face_count(); });
                        },
                        [&](const SizeField& size) { return size.along.size() == wedges; },
                        [](const auto&) { return true; },
                    },
                    value);
}

/// Of a mesh, or a field on one.
std::size_t wedge_count(const Value& value) {
  return std::visit(Overloaded{[](const TriMesh& mesh) { return mesh.wedge_vertex.size(); },
                               [](const PrincipalField& field) { return field.normal.size(); },
                               [](const auto&) { return std::size_t{0}; }},
                    value);
}

/// Of the faces: files have vertices that no face uses, and corners that are no vertices.
double diagonal_of_faces(const PolyMesh& mesh) {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 high = -low;
  for (const Index v : mesh.corners) {
    if (v < 0 || v >= mesh.vertex_count()) continue;
    low = low.cwiseMin(mesh.positions[v]);
    high = high.cwiseMax(mesh.positions[v]);
  }
  return low.x() <= high.x() ? (high - low).norm() : 0;
}

}  // namespace

double diagonal_of(const Value& value) {
  return std::visit(Overloaded{[](const TriMesh& mesh) { return mesh.diagonal; },
                               [](const OpenedMesh& mesh) { return mesh->header().diagonal; },
                               [](const Polygons& mesh) { return diagonal_of_faces(mesh.mesh); },
                               [](const auto&) { return 0.0; }},
                    value);
}

std::string mesh_id_of(const Value& value) {
  return std::visit(Overloaded{[](const TriMesh& mesh) { return mesh.id; },
                               [](const OpenedMesh& mesh) { return mesh->header().id; },
                               [](const EdgeList&) { return std::string(); },
                               [](const GuideLines&) { return std::string(); },
                               [](const auto& other) { return other.mesh_id; }},
                    value);
}

void check_parent(const TriMesh& coarse, const std::string& coarse_name, const Value& value,
                  const std::string& name) {
  const std::string id = mesh_id_of(value);
  if (coarse.parent_id.empty() || id != coarse.parent_id) {
    throw PreconditionError("'" + coarse_name + "' is no coarser mesh of that of '" + name + "' (" +
                            id + ", not " +
                            (coarse.parent_id.empty() ? "any mesh" : coarse.parent_id) +
                            "); give the mesh it was made from, or make it again");
  }
  const std::size_t wedges = wedge_count(value);
  if (std::any_of(coarse.parent_wedge.begin(), coarse.parent_wedge.end(),
                  [&](Index wedge) { return static_cast<std::size_t>(wedge) >= wedges; })) {
    throw InputError("'" + coarse_name + "' names elements that '" + name +
                     "' does not have; the file is damaged, make it again");
  }
}

void check_belongs(const TriMesh& mesh, const std::string& mesh_name, const Value& value,
                   const std::string& name) {
  const std::string id = mesh_id_of(value);
  if (id.empty() &&
      (std::holds_alternative<Polygons>(value) || std::holds_alternative<DensityField>(value) ||
       std::holds_alternative<GuideLines>(value))) {
    return;
  }
  if (id != mesh.id) {
    throw PreconditionError("'" + name + "' belongs to another mesh than '" + mesh_name + "' (" +
                            id + ", not " + mesh.id +
                            "); give the mesh it was made from, or make it again");
  }
  if (!fits(mesh, value)) {
    throw InputError("'" + name + "' names elements that '" + mesh_name +
                     "' does not have; the file is damaged, make it again");
  }
}

}  // namespace strake
