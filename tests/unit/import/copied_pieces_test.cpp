#include "stages/import/copied_pieces.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "stages/import/triangulate.h"
#include "tests/unit/import/shapes.h"

namespace strake {
namespace {

using shapes::count;

/// Both meshes, with vertices of their own.
PolyMesh together(PolyMesh mesh, const PolyMesh& other) {
  const Index first = mesh.vertex_count();
  mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
  for (Index f = 0; f < other.face_count(); ++f) {
    std::vector<Index> face;
    for (const Index v : other.face(f)) face.push_back(first + v);
    mesh.add_face(face);
  }
  return mesh;
}

PolyMesh turned_over(const PolyMesh& mesh) {
  return shapes::turned(mesh, [](Index) { return true; });
}

std::int64_t faces_dropped(const PolyMesh& mesh) {
  import::Repairs repairs;
  import::Soup soup = import::triangulate(mesh, repairs);
  import::drop_copied_pieces(soup, repairs);
  return repairs.duplicate_faces;
}

TEST(CopiedPieces, BacksOfSheetsGo) {
  const PolyMesh sheet =
      shapes::grid(8, 8, [](double x, double y) { return 0.1 * std::sin(5 * x) * y; });
  const ImportResult one = shapes::imported(sheet);
  for (const PolyMesh& back : {turned_over(sheet), sheet}) {
    const ImportResult both = shapes::imported(together(sheet, back));
    EXPECT_EQ(count(both.report, "repairs.duplicate_faces"), one.mesh.face_count());
    EXPECT_EQ(both.mesh.id, one.mesh.id);
  }
}

TEST(CopiedPieces, CopiesOfSolidsGo) {
  const PolyMesh torus = shapes::torus(12, 8);
  const ImportResult result = shapes::imported(together(torus, turned_over(torus)));
  EXPECT_EQ(result.mesh.id, shapes::imported(torus).mesh.id);
}

TEST(CopiedPieces, SheetsThatDifferStay) {
  const PolyMesh sheet = shapes::grid(8, 8, [](double x, double) { return x * x; });
  PolyMesh other = turned_over(sheet);
  other.positions[40].z() += 0.01;
  EXPECT_EQ(faces_dropped(together(sheet, other)), 0);
}

/// Sides of a box as sheets with vertices of their own; `z` is where the lowest lies.
PolyMesh box_of_sheets(double z) {
  const PolyMesh side = shapes::grid(4, 4, [](double, double) { return 0.0; });
  PolyMesh box;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double place : {0.0, 1.0}) {
      PolyMesh moved = side;
      for (Vec3& p : moved.positions) {
        Vec3 turned;
        turned[(axis + 1) % 3] = p.x();
        turned[(axis + 2) % 3] = p.y();
        turned[axis] = place;
        p = turned + Vec3(0, 0, z);
      }
      box = together(box, place > 0 ? moved : turned_over(moved));
    }
  }
  return box;
}

/// Both have the wall between them, which is part of either.
TEST(CopiedPieces, WallsBetweenSolidsStay) {
  EXPECT_EQ(faces_dropped(together(box_of_sheets(0), box_of_sheets(1))), 0);
}

}  // namespace
}  // namespace strake
