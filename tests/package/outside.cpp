// Remeshes a mesh from arrays with nothing but the installed library.
#include <strake/strake.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

namespace {

/// A torus as a grid of triangles: `columns` around, `rows` around the tube.
strake::PolyMesh torus(int columns, int rows) {
  strake::PolyMesh mesh;
  const auto vertex = [&](int i, int j) { return (i % columns) * rows + j % rows; };
  for (int i = 0; i < columns; ++i) {
    for (int j = 0; j < rows; ++j) {
      const double u = 2 * std::numbers::pi * i / columns;
      const double v = 2 * std::numbers::pi * j / rows;
      const double r = 1 + 0.4 * std::cos(v);
      mesh.positions.push_back({r * std::cos(u), r * std::sin(u), 0.4 * std::sin(v)});
      const int a = vertex(i, j), b = vertex(i + 1, j), c = vertex(i + 1, j + 1),
                d = vertex(i, j + 1);
      mesh.add_face(std::array{a, b, c});
      mesh.add_face(std::array{a, c, d});
    }
  }
  return mesh;
}

int failures = 0;
void check(bool holds, const char* what) {
  if (holds) return;
  std::printf("failed: %s\n", what);
  ++failures;
}

}  // namespace

int main() {
  strake::RemeshOptions options;
  options.trace.vertices = 500;
  const strake::RemeshResult result = strake::remesh({.mesh = torus(96, 48)}, options);
  const strake::PolyMesh& mesh = result.quads.mesh;
  check(std::abs(mesh.vertex_count() - 500) <= 25, "the count is met within 5 %");
  // Euler's formula for a torus: V - E + F = 0 with E the half of all corners.
  check(2 * (mesh.vertex_count() + mesh.face_count()) == static_cast<int>(mesh.corners.size()),
        "the result is a torus");
  double farthest = 0;
  for (const strake::Vec3& p : mesh.positions) {
    farthest = std::max(farthest, std::abs(std::hypot(std::hypot(p.x(), p.y()) - 1, p.z()) - 0.4));
  }
  check(farthest < 0.02, "vertices are near the torus");
  check(result.reports.back().first == "evaluate", "the result is measured");

  const strake::RemeshResult again = strake::remesh({.mesh = torus(96, 48)}, options);
  check(again.quads.mesh.positions == mesh.positions, "the same input gives the same result");

  options.trace.tolerance = strake::percent(0.1);
  try {
    strake::remesh({.mesh = torus(12, 6)}, options);
    check(false, "two goals are refused");
  } catch (const strake::UsageError& error) {
    check(std::string(error.what()).find("exclude") != std::string::npos, "and explained");
  }
  options.trace.tolerance.reset();
  options.import.feature_angle_deg = 400;
  try {
    strake::remesh({.mesh = torus(12, 6)}, options);
    check(false, "an option out of range is refused");
  } catch (const strake::UsageError& error) {
    check(std::string(error.what()).find("feature-angle") != std::string::npos, "by its name");
  }
  std::printf("%d vertices, %d faces\n", mesh.vertex_count(), mesh.face_count());
  return failures;
}
