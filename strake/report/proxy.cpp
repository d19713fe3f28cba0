#include "strake/report/proxy.h"

#include <meshoptimizer.h>

#include <limits>

namespace strake::report {
namespace {

/// Leaves out triangles until about `wanted` corners are left. \return the error, model units
double decimate(const TriMesh& mesh, std::size_t wanted, std::vector<std::uint32_t>& triangles) {
  std::vector<std::array<float, 3>> positions;
  positions.reserve(mesh.wedge_vertex.size());
  for (const Index v : mesh.wedge_vertex) {
    const Vec3& p = mesh.positions[v];
    positions.push_back(
        {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
  }
  constexpr float kAnyError = std::numeric_limits<float>::max();
  constexpr std::size_t kStride = sizeof positions.front();
  std::vector<std::uint32_t> fewer(triangles.size());
  float error = 0;
  fewer.resize(meshopt_simplify(fewer.data(), triangles.data(), triangles.size(),
                                positions.front().data(), positions.size(), kStride, wanted,
                                kAnyError, 0, &error));
  triangles = std::move(fewer);
  return double{error} * meshopt_simplifyScale(positions.front().data(), positions.size(), kStride);
}

}  // namespace

Proxy make_proxy(const TriMesh& mesh, std::size_t most_faces) {
  Proxy proxy;
  proxy.triangles.reserve(3 * mesh.faces.size());
  for (const auto& wedges : mesh.face_wedges) {
    for (const Index w : wedges) proxy.triangles.push_back(static_cast<std::uint32_t>(w));
  }
  if (mesh.faces.size() > most_faces) {
    proxy.deviation = decimate(mesh, 3 * most_faces, proxy.triangles);
  }
  std::vector<std::uint32_t>& triangles = proxy.triangles;
  const std::size_t wedges = mesh.wedge_vertex.size();
  meshopt_optimizeVertexCache(triangles.data(), triangles.data(), triangles.size(), wedges);

  std::vector<std::uint32_t> place(wedges);
  const std::size_t used =
      meshopt_optimizeVertexFetchRemap(place.data(), triangles.data(), triangles.size(), wedges);
  meshopt_remapIndexBuffer(triangles.data(), triangles.data(), triangles.size(), place.data());
  proxy.wedge.resize(used);
  for (std::size_t w = 0; w < wedges; ++w) {
    if (place[w] < used) proxy.wedge[place[w]] = static_cast<Index>(w);
  }
  return proxy;
}

}  // namespace strake::report
