#include "strake/chain/counted.h"

#include <algorithm>

#include "common/core/poly_mesh.h"
#include "common/core/tri_mesh.h"

namespace strake {

std::int64_t count_of(const Session& session, const char* port, Counted counted) {
  const PolyMesh& mesh = session.get<QuadMesh>(port).mesh;
  return counted == Counted::vertices ? mesh.vertex_count() : mesh.face_count();
}

const char* result_port(const Session& session) {
  for (const char* port : {"improved", "uncrossed"}) {
    if (session.has(port)) return port;
  }
  return "fitted";
}

std::int64_t given_vertex_count(const Session& session) {
  const auto& mesh = session.get<TriMesh>("mesh");
  return mesh.vertex_count() - std::ranges::count(mesh.source_vertex, kNone);
}

bool is_input_spent(const Session& session) {
  constexpr double kNearlyAll = 0.95;
  return session.has("decimated") && session.get<QuadMesh>("decimated").mesh.vertex_count() >=
                                         kNearlyAll * session.get<TriMesh>("mesh").vertex_count();
}

Index corner_count(const Session& session) {
  return static_cast<Index>(std::ranges::count(session.get<TriMesh>("mesh").is_corner, 1));
}

}  // namespace strake
