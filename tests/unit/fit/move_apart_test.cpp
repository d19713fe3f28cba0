#include "stages/fit/move_apart.h"

#include <gtest/gtest.h>

#include <array>

#include "common/geometry/face_crossings/face_crossings.h"
#include "common/geometry/surface_distance/surface_distance.h"
#include "stages/fit/face_guard.h"
#include "stages/fit/vertex_places.h"
#include "tests/support/mesh_support.h"

namespace strake {
namespace {

/// Adds columns x rows unit squares at a height; vertex (i, j) is number j (columns + 1) + i of
/// them.
void add_plate(PolyMesh& mesh, Index columns, Index rows, double z) {
  const Index first = mesh.vertex_count();
  const auto at = [&](Index i, Index j) { return first + j * (columns + 1) + i; };
  for (Index j = 0; j <= rows; ++j) {
    for (Index i = 0; i <= columns; ++i) mesh.positions.emplace_back(i, j, z);
  }
  for (Index j = 0; j < rows; ++j) {
    for (Index i = 0; i < columns; ++i) {
      mesh.add_face(std::array<Index, 4>{at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
}

/// A result on a surface of squares of which it is a copy, but for one vertex.
class OneVertexOff {
 public:
  OneVertexOff(const PolyMesh& plates, Index vertex, const Vec3& place)
      : mesh_(support::plain_tri_mesh(triangulated(plates))),
        surface_(mesh_.positions, mesh_.faces) {
    quads_.mesh = plates;
    for (const Vec3& p : plates.positions) {
      const ClosestPoint nearest = surface_.closest(p);
      quads_.provenance.face.push_back(nearest.triangle);
      quads_.provenance.barycentric.push_back(nearest.barycentric);
      quads_.provenance.lines.push_back({kNone, kNone});
    }
    quads_.mesh.positions[vertex] = place;
  }

  /// \return where vertices are in the end
  std::vector<Vec3> moved_apart() {
    fitting::VertexPlaces places(mesh_, surface_, quads_);
    fitting::FaceGuard guard(quads_.mesh, places);
    moved_ = fitting::move_apart(quads_.mesh, guard, places);
    return places.positions();
  }

  [[nodiscard]] std::size_t crossings(const std::vector<Vec3>& positions) const {
    return find_crossing_faces(positions, triangulate_faces(quads_.mesh, positions)).size();
  }
  [[nodiscard]] const std::vector<Vec3>& start() const { return quads_.mesh.positions; }
  [[nodiscard]] Index moved() const { return moved_; }

 private:
  static PolyMesh triangulated(const PolyMesh& plates) {
    PolyMesh triangles;
    triangles.positions = plates.positions;
    for (const auto& triangle : triangulate_faces(plates).corners) triangles.add_face(triangle);
    return triangles;
  }

  TriMesh mesh_;
  SurfaceDistance surface_;
  QuadMesh quads_;
  Index moved_ = 0;
};

TEST(MoveApart, PullsASheetOutOfAnother) {
  PolyMesh plates;
  add_plate(plates, 4, 4, 0);
  add_plate(plates, 4, 4, 0.3);
  const Index middle = 25 + 12;
  OneVertexOff off(plates, middle, Vec3(2, 2, -0.2));
  ASSERT_GT(off.crossings(off.start()), 0u);
  const std::vector<Vec3> moved = off.moved_apart();
  EXPECT_EQ(off.crossings(moved), 0u);
  EXPECT_GT(off.moved(), 0);
  EXPECT_GT(moved[middle].z(), 0);
}

TEST(MoveApart, SlidesVerticesOfLinesAlongThem) {
  PolyMesh strip;
  add_plate(strip, 3, 1, 0);
  OneVertexOff off(strip, 1, Vec3(2.2, 0, 0));
  ASSERT_GT(off.crossings(off.start()), 0u);
  const std::vector<Vec3> moved = off.moved_apart();
  EXPECT_EQ(off.crossings(moved), 0u);
  for (std::size_t v = 0; v < moved.size(); ++v) {
    EXPECT_EQ(moved[v].y(), off.start()[v].y()) << v;
    EXPECT_EQ(moved[v].z(), 0) << v;
  }
}

TEST(MoveApart, LeavesAloneWhatDoesNotCross) {
  PolyMesh plates;
  add_plate(plates, 4, 4, 0);
  add_plate(plates, 4, 4, 0.3);
  OneVertexOff off(plates, 25 + 12, Vec3(2.1, 2, 0.2));
  ASSERT_EQ(off.crossings(off.start()), 0u);
  EXPECT_EQ(off.moved_apart(), off.start());
  EXPECT_EQ(off.moved(), 0);
}

}  // namespace
}  // namespace strake
