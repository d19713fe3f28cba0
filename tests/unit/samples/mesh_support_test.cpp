#include "tests/support/mesh_support.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <set>

#include "common/geometry/samples/samples.h"
#include "common/geometry/topology/topology.h"
#include "tests/support/matchers.h"

namespace strake::support {
namespace {

PolyMesh cylinder() {
  SampleOptions options;
  options.faces = 1000;
  return make_sample(SampleKind::cylinder, options);
}

double volume(const PolyMesh& mesh) {
  double sum = 0;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const auto v = mesh.face(f);
    sum += mesh.positions[v[0]].dot(mesh.positions[v[1]].cross(mesh.positions[v[2]])) / 6;
  }
  return sum;
}

TEST(MeshSupport, PlainMeshIsValid) {
  const TriMesh mesh = plain_tri_mesh(cylinder());
  EXPECT_NO_THROW(validate(mesh));
  EXPECT_EQ(mesh.wedge_count(), mesh.vertex_count());
}

TEST(MeshSupport, RotationAndReflectionAreIsometriesAndKeepOutside) {
  for (const Mat3& m : {oblique_rotation(), oblique_reflection()}) {
    EXPECT_LT((m * m.transpose() - Mat3::Identity()).norm(), 1e-14);
  }
  EXPECT_NEAR(oblique_rotation().determinant(), 1, 1e-14);
  EXPECT_NEAR(oblique_reflection().determinant(), -1, 1e-14);
  const PolyMesh mesh = cylinder();
  const double exact = volume(mesh);
  EXPECT_GT(exact, 0);
  EXPECT_NEAR(volume(transformed(mesh, oblique_rotation(), Vec3(1, 2, 3))), exact, 1e-12);
  EXPECT_NEAR(volume(transformed(mesh, oblique_reflection())), exact, 1e-12);
  EXPECT_NEAR(volume(transformed(mesh, 10 * Mat3::Identity())), 1000 * exact, 1e-9);
}

TEST(MeshSupport, PermutedMeshIsTheSameMesh) {
  const PolyMesh mesh = cylinder();
  const PermutedMesh shuffled = permuted(mesh, 3);
  EXPECT_NE(shuffled.old_vertex.front(), 0);
  std::set<Index> used(shuffled.old_face.begin(), shuffled.old_face.end());
  EXPECT_EQ(used.size(), static_cast<std::size_t>(mesh.face_count()));
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    EXPECT_EQ(shuffled.mesh.positions[v], mesh.positions[shuffled.old_vertex[v]]);
  }
  for (Index f = 0; f < mesh.face_count(); ++f) {
    std::vector<Index> face;
    for (const Index v : shuffled.mesh.face(f)) face.push_back(shuffled.old_vertex[v]);
    const auto old = mesh.face(shuffled.old_face[f]);
    const auto first = std::find(face.begin(), face.end(), old[0]);
    ASSERT_NE(first, face.end());
    std::rotate(face.begin(), first, face.end());
    EXPECT_TRUE(std::equal(face.begin(), face.end(), old.begin(), old.end()));
  }
}

TEST(MeshSupport, DihedralAngleOfAHingeIsItsBendAndPositiveWhereConvex) {
  for (const double bend : {-2.5, -0.3, 0.0, 1e-9, 0.7, 3.0}) {
    PolyMesh hinge;  // a face in the plane z = 0, its normal up, and one folded down by the bend
    hinge.positions = {Vec3(0, 0, 0), Vec3(0, 1, 0), Vec3(-1, 0.5, 0),
                       Vec3(std::cos(bend), 0.5, -std::sin(bend))};
    hinge.add_face(std::vector<Index>{0, 1, 2});
    hinge.add_face(std::vector<Index>{1, 0, 3});
    const TriMesh mesh = plain_tri_mesh(hinge);
    EXPECT_NEAR(dihedral_angle(mesh, 0), bend, 1e-15);
    EXPECT_NEAR(dihedral_angle(mesh, mesh.twin[0]), bend, 1e-15);
  }
}

TEST(MeshSupport, ObservedOrderOfAPowerIsItsExponent) {
  const std::vector<double> sizes = {1, 0.5, 0.2};
  std::vector<double> errors;
  for (const double h : sizes) errors.push_back(7 * std::pow(h, 1.5));
  EXPECT_NEAR(observed_order(sizes, errors), 1.5, 1e-12);
}

TEST(Matchers, LinesHaveNoSign) {
  EXPECT_TRUE(same_line(Vec3(1, 2, 3), Vec3(-2, -4, -6), 1e-12));
  EXPECT_FALSE(same_line(Vec3::UnitX(), Vec3::UnitY(), 1.5));
  EXPECT_TRUE(near(Vec3(1, 0, 0), Vec3(1, 0, 0.5), 0.5));
  EXPECT_FALSE(near(Vec3(1, 0, 0), Vec3(1, 0, 0.6), 0.5));
}

}  // namespace
}  // namespace strake::support
