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

/// Coordinate up to which products of a few of them are finite, too.
constexpr double kFarthest = 1e100;

bool are_places(const std::vector<Vec3>& positions) {
  return std::ranges::all_of(positions,
                             [](const Vec3& p) { return (p.array().abs() <= kFarthest).all(); });
}

std::string fault_unless(bool sound, const char* fault) { return sound ? "" : fault; }

std::string fault_of(const TriMesh& mesh) {
  try {
    if (!are_places(mesh.positions)) return "a vertex that is nowhere";
    validate(mesh);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// Of what another program may have written in single precision.
constexpr double kRounding = 1e-5;

bool are_units(const std::vector<Vec3>& vectors) {
  return std::ranges::all_of(vectors,
                             [](const Vec3& v) { return std::abs(v.norm() - 1) <= kRounding; });
}

bool are_orthogonal(const std::vector<Vec3>& some, const std::vector<Vec3>& others) {
  return std::ranges::equal(
      some, others, [](const Vec3& a, const Vec3& b) { return std::abs(a.dot(b)) <= kRounding; });
}

bool are_shares(const std::vector<double>& values) {
  return std::ranges::all_of(values, [](double value) { return value >= 0 && value <= 1; });
}

/// \param tensors  a TensorField or a TensorPart
template <class Tensors>
std::string fault_of_tensors(const Tensors& tensors) {
  if (!finite(tensors.tensor)) return "tensors that are no finite numbers";
  return fault_unless(are_units(tensors.normal), "normals that are not of length 1");
}

std::string fault_of_distances(const std::vector<double>& some, const std::vector<double>& others) {
  return fault_unless(positive(some) && positive(others),
                      "distances of lines that are not positive");
}

std::string fault_of(const PrincipalField& field) {
  if (!finite(field.k_min) || !finite(field.k_max)) return "curvatures that are no finite numbers";
  for (const std::vector<Vec3>* vectors : {&field.normal, &field.t_min, &field.cross}) {
    if (!are_units(*vectors)) return "normals or directions that are not of length 1";
  }
  if (!are_orthogonal(field.normal, field.t_min) || !are_orthogonal(field.normal, field.cross)) {
    return "directions that are not orthogonal to the normals";
  }
  return fault_unless(are_shares(field.wedge_confidence) && are_shares(field.face_confidence),
                      "confidences that are not between 0 and 1");
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
  if (!are_places(quads.mesh.positions)) return "a vertex that is nowhere";
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
