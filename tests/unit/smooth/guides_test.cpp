// Guide lines: how they are laid onto a surface, turn the cross field, and become edges.

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>

#include "common/artifact/meshfile/guide_reader.h"
#include "common/core/error.h"
#include "common/geometry/angles.h"
#include "common/geometry/frames.h"
#include "common/geometry/samples/samples.h"
#include "stages/smooth/guide_layout.h"
#include "tests/support/chain.h"
#include "tests/support/mesh_support.h"
#include "tests/unit/smooth/cross_angles.h"

namespace strake {
namespace {

PolyMesh sample(SampleKind kind, std::int64_t faces) {
  SampleOptions options;
  options.faces = faces;
  return make_sample(kind, options);
}

/// A guide through `count` points of a curve over [0, 1].
GuideLines guide_along(const std::function<Vec3(double)>& curve, int count) {
  GuideLines guides;
  guides.name = "guides.obj";
  std::vector<Vec3>& line = guides.lines.emplace_back();
  for (int i = 0; i < count; ++i) line.push_back(curve(double(i) / (count - 1)));
  return guides;
}

/// Where a point lies beside a guide.
struct Beside {
  double distance;  ///< from the curve that the guide is a part of
  double along;     ///< length along the guide, that of its end beyond it
};

/// Length of a guide along which a result has edges: both ends `near` it.
double length_along(const QuadMesh& quads, const std::function<Beside(const Vec3&)>& beside,
                    double near) {
  double length = 0;
  for (Index f = 0; f < quads.mesh.face_count(); ++f) {
    const auto face = quads.mesh.face(f);
    for (std::size_t i = 0; i < face.size(); ++i) {
      const Beside p = beside(quads.mesh.positions[face[i]]);
      const Beside q = beside(quads.mesh.positions[face[(i + 1) % face.size()]]);
      if (p.distance > near || q.distance > near) continue;
      length += 0.5 * std::abs(q.along - p.along);  // each edge has two faces
    }
  }
  return length;
}

/// Where curvature says nothing a guide decides; a line of the result runs along it from end to
/// end.
TEST(Guides, TurnTheFieldOfAPlane) {
  const Vec3 along(std::cos(27 * kDegree), std::sin(27 * kDegree), 0);
  const GuideLines guides =
      guide_along([&](double t) -> Vec3 { return (1.2 * t - 0.6) * along; }, 2);
  const support::Prepared plane =
      support::prepare(sample(SampleKind::plane, 4000), {}, {}, {}, &guides);
  double worst = 0;
  for (const Index f : plane.field.guides.face) {
    for (const Index w : plane.mesh.face_wedges[f]) {
      worst = std::max(worst, angle_to_cross(plane.field, w, along));
    }
  }
  EXPECT_LT(worst, 1 * kDegree);
  TraceOptions options;
  options.vertices = 600;
  const QuadMesh quads = support::mesh(plane, support::trace(plane, options));
  const double spacing = std::sqrt(4.0 / 600);
  const auto beside = [&](const Vec3& p) -> Beside {
    return {p.cross(along).norm(), std::clamp(p.dot(along), -0.6, 0.6)};
  };
  EXPECT_GT(length_along(quads, beside, 0.2 * spacing), 1.1);
}

TEST(Guides, TurnTheFieldOfASphere) {
  const Vec3 pole = Vec3(0.3, -0.5, 0.8).normalized();
  const Vec3 x = pole.unitOrthogonal();
  const Vec3 y = pole.cross(x);
  // Two thirds of a great circle in chords of 12 degrees, which run 0.3 % of the diagonal inside.
  const auto arc = [&](double t) -> Vec3 {
    const double angle = 240 * kDegree * t;
    return std::cos(angle) * x + std::sin(angle) * y;
  };
  const GuideLines guides = guide_along(arc, 21);
  const support::Prepared sphere =
      support::prepare(sample(SampleKind::sphere, 12000), {}, {}, {}, &guides);
  double worst = 0;
  for (const Index f : sphere.field.guides.face) {
    for (const Index w : sphere.mesh.face_wedges[f]) {
      worst = std::max(worst, angle_to_cross(sphere.field, w, pole));
    }
  }
  EXPECT_LT(worst, 1.5 * kDegree);
  TraceOptions options;
  options.vertices = 1000;
  const QuadMesh quads = support::mesh(sphere, support::trace(sphere, options));
  const double spacing = std::sqrt(4 * M_PI / 1000);
  const auto beside = [&](const Vec3& p) -> Beside {
    const double angle = std::atan2(p.dot(y), p.dot(x));
    if (angle > -90 * kDegree && angle < -30 * kDegree) return {1, 0};  // opposite to the guide
    return {std::abs(p.dot(pole)),
            std::clamp(angle < -90 * kDegree ? angle + 2 * M_PI : angle, 0.0, 240 * kDegree)};
  };
  EXPECT_GT(length_along(quads, beside, 0.2 * spacing), 0.9 * 240 * kDegree);
}

constexpr double kSteep = 30 * kDegree;

/// On a cylinder, at 30 degrees to the axis.
GuideLines helix() {
  return guide_along(
      [](double t) {
        const double z = 1.4 * t - 0.7;
        const double angle = std::tan(kSteep) * z / kCylinderRadius;
        return Vec3(kCylinderRadius * std::cos(angle), kCylinderRadius * std::sin(angle), z);
      },
      15);
}

/// In the plane that the cylinder rolls out to; the helix is the line through its origin.
double distance_to_helix(const Vec3& p) {
  const double u = kCylinderRadius * std::atan2(p.y(), p.x());
  return std::abs(u * std::cos(kSteep) - p.z() * std::sin(kSteep));
}

TEST(Guides, OverrideTheCurvatureWithinTheirReachAndNotBeyond) {
  const GuideLines guides = helix();
  const support::Prepared tube =
      support::prepare(sample(SampleKind::open_cylinder, 12000), {}, {}, {}, &guides);
  const double reach = SmoothOptions{}.guide_reach.resolve(tube.mesh.diagonal);
  Index near = 0;
  Index far = 0;
  for (Index w = 0; w < tube.mesh.wedge_count(); ++w) {
    const Vec3& p = tube.mesh.positions[tube.mesh.wedge_vertex[w]];
    if (std::abs(p.z()) > 0.5) continue;  // beyond the ends of the guide, or near them
    const Vec3 around(-p.y(), p.x(), 0);
    const Vec3 along = std::cos(kSteep) * Vec3::UnitZ() + std::sin(kSteep) * around.normalized();
    const double distance = distance_to_helix(p);
    if (distance < 0.4 * reach) {
      EXPECT_LT(angle_to_cross(tube.field, w, along), 5 * kDegree);
      ++near;
    } else if (distance > 2 * reach) {
      EXPECT_LT(angle_to_cross(tube.field, w, Vec3::UnitZ()), 3 * kDegree);
      ++far;
    }
  }
  EXPECT_GT(near, 30);
  EXPECT_GT(far, 1000);
  TraceOptions options;
  options.vertices = 3000;
  const QuadMesh quads = support::mesh(tube, support::trace(tube, options));
  const double spacing = std::sqrt(4 * M_PI / 3000);
  const auto beside = [&](const Vec3& p) -> Beside {
    return {p.x() > 0 ? distance_to_helix(p) : 1, std::clamp(p.z(), -0.7, 0.7) / std::cos(kSteep)};
  };
  EXPECT_GT(length_along(quads, beside, 0.2 * spacing), 0.9 * 1.4 / std::cos(kSteep));
}

TEST(Guides, TurnWithTheSurface) {
  const Mat3 rotation = support::oblique_rotation();
  const PolyMesh soup = sample(SampleKind::ellipsoid, 6000);
  const auto arc = [](double t) -> Vec3 {
    return Vec3(kEllipsoidAxes[0] * std::cos(2 * t), kEllipsoidAxes[1] * std::sin(2 * t) * 0.8,
                kEllipsoidAxes[2] * std::sin(2 * t) * 0.6);
  };
  const GuideLines guides = guide_along(arc, 40);
  const GuideLines turned = guide_along([&](double t) -> Vec3 { return rotation * arc(t); }, 40);
  const support::Prepared a = support::prepare(soup, {}, {}, {}, &guides);
  const support::Prepared b =
      support::prepare(support::transformed(soup, rotation), {}, {}, {}, &turned);
  ASSERT_EQ(a.mesh.faces, b.mesh.faces);
  EXPECT_EQ(a.field.guides.face, b.field.guides.face);
  // The solver stops at a residual of 1e-8 or so of the right side; a tenth of a degree is beyond
  // what that can turn a cross that is held by a guide or by curvature.
  std::vector<double> angles;
  for (Index w = 0; w < a.mesh.wedge_count(); ++w) {
    angles.push_back(angle_to_cross(b.field, w, rotation * a.field.cross[w]));
  }
  std::sort(angles.begin(), angles.end());
  EXPECT_LT(angles[angles.size() * 99 / 100], 0.1 * kDegree);
}

TEST(Guides, GiveTheSameBitsForAnyThreadCount) {
  const GuideLines guides = helix();
  const PolyMesh soup = sample(SampleKind::open_cylinder, 6000);
  std::vector<PrincipalField> fields;
  for (const std::size_t threads : {1, 3}) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    fields.push_back(support::prepare(soup, {}, {}, {}, &guides).field);
  }
  EXPECT_EQ(fields[0].cross, fields[1].cross);
  EXPECT_EQ(fields[0].guides.face, fields[1].guides.face);
  EXPECT_EQ(fields[0].guides.step, fields[1].guides.step);
}

double total_length(const LaidGuides& guides) {
  double length = 0;
  for (const Vec3& step : guides.step) length += step.norm();
  return length;
}

TEST(Guides, LieOnTheSurfaceFromEndToEnd) {
  TriMesh plane = support::plain_tri_mesh(sample(SampleKind::plane, 3000));
  plane.origin = Vec3(100, -20, 7);  // guides are in model coordinates
  GuideLines guides = guide_along(
      [&](double t) -> Vec3 { return plane.origin + Vec3(1.6 * t - 0.8, 0.9 * t - 0.3, 0.01); }, 5);
  guides.lines.push_back({plane.origin, plane.origin + Vec3(0, 0.5, 0)});
  const LaidGuides laid = lay_guides(plane, guides);
  ASSERT_EQ(laid.line_count(), 2);
  EXPECT_NEAR(total_length(laid), std::hypot(1.6, 0.9) + 0.5, 1e-9);
  for (Index piece = 0; piece < laid.piece_count(); ++piece) {
    EXPECT_NEAR(laid.barycentric[piece].sum(), 1, 1e-12);
  }
}

/// Off an open boundary the nearest points run along it, which is no direction of the guide.
TEST(Guides, AreLeftOutBesideTheSurface) {
  const TriMesh plane = support::plain_tri_mesh(sample(SampleKind::plane, 3000));
  const GuideLines guides = guide_along([](double t) { return Vec3(1.04 * t, 0.5 * t, 0); }, 2);
  const LaidGuides laid = lay_guides(plane, guides);
  for (const Vec3& step : laid.step) {
    EXPECT_LT(std::abs(step.x() * 0.5 - step.y() * 1.04), 1e-9) << step.transpose();
  }
  EXPECT_NEAR(total_length(laid), std::hypot(1.0, 0.5 / 1.04), 0.01);
}

std::string complaint(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Guides, FarFromTheSurfaceAreRefused) {
  const TriMesh sphere = support::plain_tri_mesh(sample(SampleKind::sphere, 3000));
  GuideLines guides = guide_along([](double t) { return Vec3(std::cos(t), std::sin(t), 0); }, 30);
  EXPECT_EQ(lay_guides(sphere, guides).line_count(), 1);
  guides.lines.push_back({Vec3(1, 0, 0), Vec3(0, 1, 0)});  // its middle is deep inside
  const std::string message = complaint([&] { lay_guides(sphere, guides); });
  EXPECT_NE(message.find("'guides.obj', guide 2"), std::string::npos) << message;
  EXPECT_NE(message.find("more than 2 %"), std::string::npos) << message;
  guides.lines = {{Vec3(1, 0, 0), Vec3(1, 0, 0)}};
  EXPECT_NE(complaint([&] { lay_guides(sphere, guides); }).find("no guide line"),
            std::string::npos);
}

TEST(Guides, NeedACrossField) {
  const GuideLines guides = helix();
  SmoothOptions options;
  options.extension = "paper";
  EXPECT_THROW(support::prepare(sample(SampleKind::open_cylinder, 2000), {}, options, {}, &guides),
               UsageError);
}

TEST(GuideFiles, AreReadFromObjAndPly) {
  const std::vector<std::vector<Vec3>> lines = {{Vec3(0, 0, 0), Vec3(1, 0, 0.5), Vec3(1, 2, 0)},
                                                {Vec3(1, 2, 0), Vec3(0, 0, 0)}};
  const GuideLines obj = parse_guides(
      "# drawn\nv 0 0 0\nv 1 0 .5\nv 1 2 0\nvt 0 0\nl 1/1 2/1 \\\n 3\nf 1 2 3\nl -1 -3\n", "a");
  EXPECT_EQ(obj.lines, lines);
  EXPECT_EQ(parse_guides("\xEF\xBB\xBFv 0 0 0\nv 1 0 .5\nv 1 2 0\nl 1 2 3\nl 3 1\n", "a").lines,
            lines)
      << "as some editors write it";
  const std::string header =
      "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\n"
      "element edge 2\nproperty int vertex1\nproperty int vertex2\nproperty uchar "
      "red\nend_header\n";
  const GuideLines ply = parse_guides(
      "ply\nformat ascii 1.0\n" + header + "0 0 0\n1 0 0.5\n1 2 0\n3 0 1 2\n0 1 255\n1 2 255\n",
      "a");
  ASSERT_EQ(ply.lines.size(), 2u);
  EXPECT_EQ(ply.lines[1], (std::vector<Vec3>{Vec3(1, 0, 0.5), Vec3(1, 2, 0)}));
}

TEST(GuideFiles, WhatMakesNoSenseIsRefusedWithItsPlace) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\n";
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
      "property float z\nelement edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "'a' holds no guide line"},
      {"nothing of use", "holds no guide line"},
      {vertices, "holds no guide line"},
      {vertices + "f 1 2 2\n", "holds no guide line"},
      {vertices + "l\n", "fewer than two points in guide 1"},
      {vertices + "l 1 2\nl 2\n", "fewer than two points in guide 2"},
      {vertices + "l 1 3\n", "names vertex 3 in guide 1"},
      {vertices + "l 1 -3\n", "in guide 1"},
      {vertices + "l 1 0\n", "names vertex 0 in guide 1"},
      {vertices + "l 1 x\n", "names vertex 0 in guide 1"},
      {vertices + "v 0 nan 0\nl 1 2\n", "at vertex 3"},
      {vertices + "v 0 inf 0\nl 1 2\n", "at vertex 3"},
      {vertices + "v 0 0\nl 1 2\n", "at vertex 3"},
      {"ply\n", "'a' "},
      {ply, "ends before vertex 1 of 2"},
      {ply + "0 0 0\n0 nan 0\n0 1\n", "at vertex 2"},
      {ply + "0 0 0\n0 0 1\n", "ends before edge 1 of 1"},
      {ply + "0 0 0\n0 0 1\n0 2\n", "vertex 2 in edge 0"},
      {ply + "0 0 0\n0 0 1\n0 -1\n", "vertex -1 in edge 0"},
      {"ply\nformat ascii 1.0\nelement edge 1\nproperty int vertex1\nend_header\n0\n",
       "no property 'vertex2' of 'edge'"},
  };
  for (const auto& [text, part] : cases) {
    const std::string message = complaint([&, &text = text] { parse_guides(text, "a"); });
    EXPECT_NE(message.find(part), std::string::npos) << text << "\n" << message;
  }
  EXPECT_THROW(read_guides("nowhere.obj"), InputError);
}

}  // namespace
}  // namespace strake
