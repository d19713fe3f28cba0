#include "stages/refine/division_faults.h"

#include <algorithm>

#include "common/geometry/face_crossings/face_crossings.h"
#include "common/geometry/poly_topology/face_shape.h"

namespace strake {

bool has_any(std::span<const Index> face, const std::vector<std::uint8_t>& flags) {
  return std::ranges::any_of(
      face, [&](Index v) { return static_cast<std::size_t>(v) < flags.size() && flags[v] != 0; });
}

std::vector<std::uint8_t> vertices_of_faults(const PolyMesh& mesh,
                                             const std::vector<std::uint8_t>& known) {
  const auto first_new = static_cast<Index>(known.size());
  std::vector<std::uint8_t> is_new(static_cast<std::size_t>(mesh.face_count()), 0);
  for (Index f = 0; f < mesh.face_count(); ++f) {
    is_new[f] = std::ranges::any_of(mesh.face(f), [&](Index v) { return v >= first_new; });
  }
  std::vector<std::uint8_t> faulty(mesh.positions.size(), 0);
  const auto note = [&](Index f) {
    for (const Index v : mesh.face(f)) faulty[v] = 1;
  };
  for (Index f = 0; f < mesh.face_count(); ++f) {
    if (first_new > 0 && is_new[f] != 0 && is_concave_face(mesh.positions, mesh.face(f))) note(f);
  }
  for (const auto& [f, g] :
       find_crossing_faces(mesh.positions, triangulate_faces(mesh), is_new, {})) {
    if (has_any(mesh.face(f), known) && has_any(mesh.face(g), known)) continue;
    note(f);
    note(g);
  }
  return faulty;
}

}  // namespace strake
