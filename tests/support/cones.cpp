#include "tests/support/cones.h"

#include <array>
#include <cmath>

namespace strake::support {

PolyMesh cone(int sides, int rings, double height) {
  PolyMesh mesh;
  mesh.positions.emplace_back(0, 0, height);
  for (int ring = 1; ring <= rings; ++ring) {
    const double radius = double(ring) / rings;
    for (int i = 0; i < sides; ++i) {
      const double turn = 2 * M_PI * i / sides;
      mesh.positions.emplace_back(radius * std::cos(turn), radius * std::sin(turn),
                                  height * (1 - radius));
    }
  }
  mesh.positions.emplace_back(0, 0, 0);
  const Index base = mesh.vertex_count() - 1;
  const auto vertex = [&](int ring, int i) { return Index(1 + (ring - 1) * sides + i % sides); };
  const auto add = [&](Index a, Index b, Index c) { mesh.add_face(std::array{a, b, c}); };
  for (int i = 0; i < sides; ++i) {
    add(0, vertex(1, i), vertex(1, i + 1));
    for (int ring = 1; ring < rings; ++ring) {
      add(vertex(ring, i), vertex(ring + 1, i), vertex(ring + 1, i + 1));
      add(vertex(ring, i), vertex(ring + 1, i + 1), vertex(ring, i + 1));
    }
    add(base, vertex(rings, i + 1), vertex(rings, i));
  }
  return mesh;
}

}  // namespace strake::support
