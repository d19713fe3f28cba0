#include "common/stage/invariants.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/core/error.h"
#include "common/geometry/poly_topology/poly_topology.h"
#include "common/geometry/topology/topology.h"
#include "common/stage/overloaded.h"

namespace strake {
namespace {

/// Of doubles, vectors or arrays of doubles.
template <class Row>
bool finite(const std::vector<Row>& rows) {
  const auto* values = reinterpret_cast<const double*>(rows.data());
  return std::all_of(values, values + rows.size() * sizeof(Row) / sizeof(double),
                     [](double value) { return std::isfinite(value); });
}

/// Also says no to numbers that are none.
bool positive(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return value > 0; }) &&
         finite(values);
}

std::string fault_unless(bool sound, const char* fault) { return sound ? "" : fault; }

std::string fault_of(const TriMesh& mesh) {
  try {
    validate(mesh);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// \param tensors  a TensorField or a TensorPart
template <class Tensors>
std::string fault_of_tensors(const Tensors& tensors) {
  return fault_unless(finite(tensors.tensor) && finite(tensors.normal),
                      "tensors that are no finite numbers");
}

std::string fault_of_distances(const std::vector<double>& some, const std::vector<double>& others) {
  return fault_unless(positive(some) && positive(others),
                      "distances of lines that are not positive");
}

std::string fault_of(const PrincipalField& field) {
  const bool directions = finite(field.normal) && finite(field.t_min) && finite(field.cross);
  const bool curvatures = finite(field.k_min) && finite(field.k_max);
  return fault_unless(
      directions && curvatures && finite(field.wedge_confidence) && finite(field.face_confidence),
      "directions or curvatures that are no finite numbers");
}

std::string fault_of(const LineSet& lines) {
  const bool on_edges =
      std::all_of(lines.points.begin(), lines.points.end(), [](const LinePoint& point) {
        return point.halfedge >= 0 && point.lambda >= 0 && point.lambda < 1;
      });
  if (!on_edges) return "a point of a line that is on no edge";
  return fault_of_distances(lines.spacing_along_min, lines.spacing_along_max);
}

std::string fault_of(const QuadMesh& quads) {
  if (!finite(quads.mesh.positions)) return "a vertex that is nowhere";
  const PolyTopology topology = analyse(quads.mesh);
  if (!topology.is_oriented_manifold()) return topology.defects();
  return fault_unless(topology.unused_vertices == 0, "a vertex of no face");
}

}  // namespace

std::string broken_invariant(const Value& value) {
  return std::visit(
      Overloaded{
          [](const TriMesh& mesh) { return fault_of(mesh); },
          [](const TensorField& field) { return fault_of_tensors(field); },
          [](const TensorPart& part) { return fault_of_tensors(part); },
          [](const PrincipalField& field) { return fault_of(field); },
          [](const LineSet& lines) { return fault_of(lines); },
          [](const SizeField& size) { return fault_of_distances(size.along, size.across); },
          [](const QuadMesh& quads) { return fault_of(quads); },
          [](const auto&) { return std::string(); },
      },
      value);
}

}  // namespace strake
