#include "common/geometry/density.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "common/core/error.h"
#include "common/core/place_text.h"
#include "common/geometry/topology/vertex_ring.h"

namespace strake {
namespace {

/// A vertex of a density is that of the mesh where it is no farther from it than this share of the
/// diagonal, as one of a coarser mesh is.
constexpr double kElsewhere = 0.01;

/// [V] the density of each vertex; of those that import inserted the mean of the ones around them,
/// from those that were in the file inwards; 1 where there is none.
std::vector<double> density_at_vertices(const TriMesh& mesh, const DensityField& density) {
  constexpr double kUnknown = 0;
  std::vector<double> values(mesh.positions.size(), kUnknown);
  std::vector<Index> inserted;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (mesh.source_vertex[v] == kNone) {
      inserted.push_back(v);
    } else {
      values[v] = density.value[mesh.source_vertex[v]];
    }
  }
  while (!inserted.empty()) {
    std::vector<std::pair<Index, double>> found;
    for (const Index v : inserted) {
      double sum = 0;
      int count = 0;
      for_each_neighbour(mesh, v, [&](Index other) {
        sum += values[other];
        if (values[other] != kUnknown) ++count;
      });
      if (count > 0) found.emplace_back(v, sum / count);
    }
    if (found.empty()) break;
    for (const auto& [v, value] : found) values[v] = value;
    std::erase_if(inserted, [&](Index v) { return values[v] != kUnknown; });
  }
  for (const Index v : inserted) values[v] = 1;
  return values;
}

/// \throw PreconditionError where most vertices of the density lie elsewhere
void require_same_places(const TriMesh& mesh, const DensityField& density) {
  if (density.position.empty()) return;
  Index known = 0;
  Index elsewhere = 0;
  Index example = kNone;
  const auto place = [&](Index v) { return Vec3(mesh.positions[v] + mesh.origin); };
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (mesh.source_vertex[v] == kNone) continue;
    ++known;
    const Vec3& p = density.position[mesh.source_vertex[v]];
    if ((p - place(v)).norm() <= kElsewhere * mesh.diagonal) continue;
    if (elsewhere++ == 0) example = v;
  }
  if (2 * elsewhere <= known) return;
  const Index source = mesh.source_vertex[example];
  throw PreconditionError("vertex " + std::to_string(source) + " of the density lies at " +
                          place_text(density.position[source], mesh.diagonal) +
                          ", and that of the mesh at " + place_text(place(example), mesh.diagonal) +
                          "; give a density of that file's vertices, in their order");
}

}  // namespace

std::vector<double> density_at_wedges(const TriMesh& mesh, const DensityField& density) {
  if (mesh.source_vertex.empty()) {
    throw PreconditionError("the mesh does not say which vertices of its file it has");
  }
  const Index last = *std::max_element(mesh.source_vertex.begin(), mesh.source_vertex.end());
  if (last >= static_cast<Index>(density.value.size())) {
    throw PreconditionError("the density has " + std::to_string(density.value.size()) +
                            " vertices, but the mesh was made from a file with " +
                            std::to_string(last + 1) +
                            " or more; give a density of that file's vertices");
  }
  require_same_places(mesh, density);
  for (std::size_t i = 0; i < density.value.size(); ++i) {
    if (density.value[i] > 0 && std::isfinite(density.value[i])) continue;
    throw InputError("the density of vertex " + std::to_string(i) + " is no positive number");
  }
  std::vector<double> values;
  values.reserve(mesh.wedge_vertex.size());
  const std::vector<double> at_vertices = density_at_vertices(mesh, density);
  for (const Index v : mesh.wedge_vertex) values.push_back(at_vertices[v]);
  return values;
}

}  // namespace strake
