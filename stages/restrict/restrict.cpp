#include "stages/restrict/restrict.h"

#include "common/core/error.h"

namespace strake {
namespace {

template <class Row>
std::vector<Row> at_wedges(const TriMesh& coarse, const std::vector<Row>& rows) {
  std::vector<Row> own;
  if (rows.empty()) return own;
  own.reserve(coarse.parent_wedge.size());
  for (const Index wedge : coarse.parent_wedge) own.push_back(rows[wedge]);
  return own;
}

}  // namespace

PrincipalField restrict_field(const TriMesh& coarse, const PrincipalField& field) {
  if (field.guides.line_count() > 0) {
    throw UsageError(
        "the field follows guides, which a coarser mesh may not have edges for; trace on the mesh "
        "itself");
  }
  PrincipalField own;
  own.mesh_id = coarse.id;
  own.normal = at_wedges(coarse, field.normal);
  own.t_min = at_wedges(coarse, field.t_min);
  own.k_min = at_wedges(coarse, field.k_min);
  own.k_max = at_wedges(coarse, field.k_max);
  own.cross = at_wedges(coarse, field.cross);
  own.wedge_confidence = at_wedges(coarse, field.wedge_confidence);
  own.cross_extended = field.cross_extended;
  own.face_confidence.reserve(coarse.faces.size());
  for (const auto& [a, b, c] : coarse.face_wedges) {
    own.face_confidence.push_back(
        (own.wedge_confidence[a] + own.wedge_confidence[b] + own.wedge_confidence[c]) / 3);
  }
  return own;
}

}  // namespace strake
