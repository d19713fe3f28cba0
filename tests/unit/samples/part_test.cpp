#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "common/geometry/samples/samples.h"
#include "tests/support/matchers.h"
#include "tests/support/mesh_support.h"

namespace strake {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
/// As in the import stage's default: what bends by more is a feature edge.
constexpr double kFeatureAngle = 40 * kDegree;

class Part : public ::testing::TestWithParam<int> {
 protected:
  Part() {
    SampleOptions options;
    options.faces = GetParam();
    sample_ = make_labelled_sample(SampleKind::part, options);
    mesh_ = support::plain_tri_mesh(sample_.mesh);
  }

  [[nodiscard]] Index region(Index h) const { return sample_.face_region[TriMesh::face_of(h)]; }
  [[nodiscard]] bool within_region(Index h) const { return region(h) == region(mesh_.twin[h]); }
  [[nodiscard]] bool is_sharp(Index h) const {
    return std::abs(support::dihedral_angle(mesh_, h)) > kFeatureAngle;
  }
  [[nodiscard]] Vec3 area_vector(Index f) const {
    const auto& v = mesh_.faces[f];
    return (mesh_.positions[v[1]] - mesh_.positions[v[0]])
               .cross(mesh_.positions[v[2]] - mesh_.positions[v[0]]) /
           2;
  }

  LabelledSample sample_;
  TriMesh mesh_;
};

INSTANTIATE_TEST_SUITE_P(Sizes, Part, ::testing::Values(8000, 30000, 100000));

TEST_P(Part, SmoothRegionsHaveNoSharpEdgesInside) {
  for (Index h = 0; h < mesh_.halfedge_count(); ++h) {
    ASSERT_NE(mesh_.twin[h], kNone);
    ASSERT_FALSE(within_region(h) && is_sharp(h)) << "in region " << region(h);
  }
}

TEST_P(Part, BordersOfRegionsAreEitherClearlySharpOrTangential) {
  std::map<std::pair<Index, Index>, std::pair<double, double>> extremes;
  for (Index h = 0; h < mesh_.halfedge_count(); ++h) {
    if (within_region(h)) continue;
    const double angle = std::abs(support::dihedral_angle(mesh_, h));
    auto& [least, largest] =
        extremes.try_emplace(std::minmax(region(h), region(mesh_.twin[h])), angle, angle)
            .first->second;
    least = std::min(least, angle);
    largest = std::max(largest, angle);
  }
  for (const auto& [pair, range] : extremes) {
    EXPECT_TRUE(range.first > kFeatureAngle || range.second < kFeatureAngle)
        << "between regions " << pair.first << " and " << pair.second << ": "
        << range.first / kDegree << " to " << range.second / kDegree << " degrees";
  }
}

TEST_P(Part, SharpEdgesFormTheCurvesOfTheDesign) {
  std::map<Index, std::vector<Index>> neighbours;
  for (Index h = 0; h < mesh_.halfedge_count(); ++h) {
    if (is_sharp(h)) neighbours[mesh_.from(h)].push_back(mesh_.to(h));
  }
  Index corners = 0, curves = 0;
  std::set<Index> seen;
  for (const auto& [start, around] : neighbours) {
    EXPECT_GE(around.size(), 2U) << "a sharp edge ends at vertex " << start;
    if (around.size() != 2) ++corners;
    if (!seen.insert(start).second) continue;
    ++curves;
    std::vector<Index> stack = {start};
    while (!stack.empty()) {
      const Index v = stack.back();
      stack.pop_back();
      for (const Index w : neighbours.at(v)) {
        if (seen.insert(w).second) stack.push_back(w);
      }
    }
  }
  // The lower outline; three circles at each of four bolt holes and at the bore; the boss's rim;
  // two rims of the cross hole; the rib's outline, the only one with corners: two at each end.
  EXPECT_EQ(curves, 1 + 3 * 4 + 3 + 1 + 2 + 1);
  EXPECT_EQ(corners, 4);
}

TEST_P(Part, FlatsAreExactlyFlatAndStraightSidedOnesHaveTheirExactArea) {
  std::map<Index, Vec3> normal, sum;
  std::map<Index, double> spread;
  for (Index f = 0; f < mesh_.face_count(); ++f) {
    const Index r = sample_.face_region[f];
    const Vec3 unit = area_vector(f).normalized();
    const Vec3& reference = normal.try_emplace(r, unit).first->second;
    sum.try_emplace(r, Vec3::Zero()).first->second += area_vector(f);
    spread[r] = std::max(spread[r], (unit - reference).norm());
  }
  EXPECT_EQ(spread.size(), 35U);
  Index flats = 0;
  std::vector<double> wall_areas;
  for (const auto& [r, width] : spread) {
    // Positions are rounded to 1e-14 at edges of 0.3: normals of a flat agree to 1e-12.
    if (width > 1e-12) {
      EXPECT_GT(width, 10 * kDegree) << "region " << r << " is neither flat nor bent";
      continue;
    }
    ++flats;
    if (std::abs(normal.at(r).z()) < 1e-12 && sum.at(r).norm() < 900 && sum.at(r).norm() > 455) {
      wall_areas.push_back(sum.at(r).norm());
    }
  }
  // Top, bottom, four walls, the ring on the boss, two flanks of the rib and its ramp.
  EXPECT_EQ(flats, 10);
  std::sort(wall_areas.begin(), wall_areas.end());
  const std::vector<double> expected = {46 * 10, 46 * 10, 86 * 10, 86 * 10};
  ASSERT_EQ(wall_areas.size() >= 4, true);
  for (const double area : expected) {
    EXPECT_EQ(std::count_if(wall_areas.begin(), wall_areas.end(),
                            [&](double a) { return std::abs(a - area) < 1e-9; }),
              2);
  }
}

TEST_P(Part, StandsOnTheGroundInItsBox) {
  Vec3 lower = mesh_.positions[0], upper = lower;
  for (const Vec3& p : mesh_.positions) {
    lower = lower.cwiseMin(p);
    upper = upper.cwiseMax(p);
  }
  EXPECT_TRUE(support::near(lower, Vec3(-55, -35, 0), 1e-13));
  EXPECT_TRUE(support::near(upper, Vec3(55, 35, 52), 1e-13));
}

/// Whether segment p-q passes through triangle a-b-c, with room to spare: volumes are of the order
/// of 0.01 to 10 where something passes through something, and 1e-13 where four points are
/// coplanar.
bool pierces(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  const double tolerance = 1e-9;
  const auto side = [&](const Vec3& u, const Vec3& v, const Vec3& w, const Vec3& x) {
    const double volume = (v - u).cross(w - u).dot(x - u);
    return volume > tolerance ? 1 : (volume < -tolerance ? -1 : 0);
  };
  if (side(a, b, c, p) * side(a, b, c, q) >= 0) return false;
  const int first = side(p, q, a, b);
  return first != 0 && first == side(p, q, b, c) && first == side(p, q, c, a);
}

TEST_P(Part, DoesNotIntersectItself) {
  // Triangles meet only where an edge of one passes through the other (up to coplanar ones, which
  // the flats' exact areas exclude). Candidates come from a grid of cells about as large as edges.
  const double cell = 3;
  using Cell = std::array<int, 3>;
  const auto cells_of = [&](std::initializer_list<Index> vertices) {
    Vec3 lower = mesh_.positions[*vertices.begin()], upper = lower;
    for (const Index v : vertices) {
      lower = lower.cwiseMin(mesh_.positions[v]);
      upper = upper.cwiseMax(mesh_.positions[v]);
    }
    std::vector<Cell> cells;
    const Eigen::Vector3i from = (lower / cell).array().floor().cast<int>();
    const Eigen::Vector3i to = (upper / cell).array().floor().cast<int>();
    for (int x = from.x(); x <= to.x(); ++x) {
      for (int y = from.y(); y <= to.y(); ++y) {
        for (int z = from.z(); z <= to.z(); ++z) cells.push_back({x, y, z});
      }
    }
    return cells;
  };
  std::map<Cell, std::vector<Index>> faces;
  for (Index f = 0; f < mesh_.face_count(); ++f) {
    const auto& v = mesh_.faces[f];
    for (const Cell& c : cells_of({v[0], v[1], v[2]})) faces[c].push_back(f);
  }
  for (Index h = 0; h < mesh_.halfedge_count(); ++h) {
    if (mesh_.edge_of(h) != h) continue;
    const Index p = mesh_.from(h), q = mesh_.to(h);
    for (const Cell& c : cells_of({p, q})) {
      const auto found = faces.find(c);
      if (found == faces.end()) continue;
      for (const Index f : found->second) {
        const auto& v = mesh_.faces[f];
        if (std::count(v.begin(), v.end(), p) + std::count(v.begin(), v.end(), q) > 0) continue;
        ASSERT_FALSE(pierces(mesh_.positions[p], mesh_.positions[q], mesh_.positions[v[0]],
                             mesh_.positions[v[1]], mesh_.positions[v[2]]))
            << "edge " << p << " " << q << " and face " << f;
      }
    }
  }
}

}  // namespace
}  // namespace strake
