#include "tests/support/plates.h"

#include <array>
#include <cmath>

#include "common/geometry/plane/triangulate_outlines.h"

namespace strake::support {
namespace {

/// Points around a square, and around each disk; outlines of what is between.
struct Drawing {
  std::vector<Vec2> points;
  std::vector<std::vector<Index>> outlines;
};

Drawing draw(double half, const std::vector<Disk>& disks) {
  Drawing drawing{{{-half, -half}, {half, -half}, {half, half}, {-half, half}}, {{0, 1, 2, 3}}};
  for (const Disk& disk : disks) {
    std::vector<Index>& outline = drawing.outlines.emplace_back();
    for (int i = 0; i < disk.sides; ++i) {
      const double angle = -2 * M_PI * i / disk.sides;
      outline.push_back(static_cast<Index>(drawing.points.size()));
      drawing.points.emplace_back(disk.centre +
                                  disk.radius * Vec2(std::cos(angle), std::sin(angle)));
    }
  }
  return drawing;
}

}  // namespace

PolyMesh pitted_plate(double half, const std::vector<Disk>& disks, double depth) {
  const Drawing drawing = draw(half, disks);
  PolyMesh mesh;
  for (const Vec2& p : drawing.points) mesh.positions.emplace_back(p.x(), p.y(), 0);
  for (const auto& triangle : triangulate_outlines(drawing.points, drawing.outlines)) {
    mesh.add_face(triangle);
  }
  // The square goes on downwards as its sides, each disk as its wall.
  for (std::size_t o = 0; o < drawing.outlines.size(); ++o) {
    const std::vector<Index>& upper = drawing.outlines[o];
    std::vector<Index> lower;
    for (const Index p : upper) {
      lower.push_back(mesh.vertex_count());
      mesh.positions.push_back(mesh.positions[p] - (o == 0 ? 1 : depth) * Vec3::UnitZ());
    }
    for (std::size_t i = 0; i < upper.size(); ++i) {
      const std::size_t j = (i + 1) % upper.size();
      mesh.add_face(std::array<Index, 3>{upper[j], upper[i], lower[i]});
      mesh.add_face(std::array<Index, 3>{upper[j], lower[i], lower[j]});
    }
    // Around both floors the walls run the other way.
    for (std::size_t i = 1; i + 1 < lower.size(); ++i) {
      mesh.add_face(std::array<Index, 3>{lower[0], lower[i + 1], lower[i]});
    }
  }
  return mesh;
}

}  // namespace strake::support
