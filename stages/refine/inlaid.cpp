#include "stages/refine/inlaid.h"

#include <algorithm>
#include <array>
#include <set>
#include <span>

#include "common/geometry/patch_fill/drop_unused_vertices.h"
#include "stages/refine/cells_beyond.h"

namespace strake {
namespace {

/// Places of the input whose vertex is searched for over the surface. More are left bare by an
/// inlay that is wrong altogether; each search would go all over what is bare.
constexpr std::size_t kMostSearched = 1000;

/// Whether a cell has a vertex on the outline of an inlay.
bool is_beside(std::span<const Index> cell, const Inlay& inlay) {
  const auto is_of_outline = [&](Index v) {
    return std::ranges::find(inlay.outline, v) != inlay.outline.end();
  };
  return std::ranges::any_of(cell, is_of_outline);
}

}  // namespace

Inlaid InlayHost::with(const std::vector<Inlay>& inlays) const {
  Inlaid result;
  result.quads.mesh_id = quads_.mesh_id;
  QuadMesh& quads = result.quads;
  quads.mesh.positions = quads_.mesh.positions;
  quads.provenance = quads_.provenance;
  std::vector<char> goes(static_cast<std::size_t>(quads_.mesh.face_count()), 0);
  for (const Inlay& inlay : inlays) {
    for (const Index f : inlay.cells) goes[f] = 1;
  }
  const auto add_face = [&](std::span<const Index> face, Index inlay, Index part) {
    quads.mesh.add_face(face);
    result.inlay.push_back(inlay);
    result.part.push_back(part);
  };
  for (Index f = 0; f < quads_.mesh.face_count(); ++f) {
    if (goes[f] == 0) add_face(quads_.mesh.face(f), kNone, f);
  }
  for (std::size_t s = 0; s < inlays.size(); ++s) {
    const Inlay& inlay = inlays[s];
    std::vector<Index> number = inlay.outline;
    for (const SurfacePoint& point : inlay.points) {
      number.push_back(quads.mesh.vertex_count());
      quads.mesh.positions.push_back(place_of(surfaces_.mesh(), point) + surfaces_.mesh().origin);
      add_foot(quads.provenance, point);
    }
    for (std::size_t i = 0; i < inlay.faces.size(); ++i) {
      const auto& [a, b, c] = inlay.faces[i];
      add_face(std::array{number[a], number[b], number[c]}, static_cast<Index>(s),
               static_cast<Index>(i));
    }
  }
  drop_unused_vertices(quads);
  return result;
}

Faults InlayHost::beyond(const Inlaid& inlaid) const {
  const auto excess = proof_.check(ComparedSurfaces(proof_.input(), inlaid.quads));
  std::set<Index> faces;
  const bool on_surface = excess.size() <= kMostSearched;
  for (const Target& t : cells_beyond(proof_.input()->mesh, inlaid.quads, excess, on_surface)) {
    faces.insert(t.face);
  }
  return {{faces.begin(), faces.end()}, !excess.empty()};
}

std::vector<std::size_t> InlayHost::inlays_at(const std::vector<Inlay>& inlays,
                                              const Inlaid& inlaid, Index face) const {
  if (inlaid.inlay[face] != kNone) return {static_cast<std::size_t>(inlaid.inlay[face])};
  std::vector<std::size_t> result;
  for (std::size_t s = 0; s < inlays.size(); ++s) {
    if (is_beside(quads_.mesh.face(inlaid.part[face]), inlays[s])) result.push_back(s);
  }
  return result;
}

}  // namespace strake
