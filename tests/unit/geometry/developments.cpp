#include "tests/unit/geometry/developments.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <random>

#include "common/core/poly_mesh.h"
#include "tests/support/mesh_support.h"

namespace strake {
namespace {

/// Triangulates a grid of columns and rows, each cell along a random diagonal, without the cells
/// that `skip` names, and folds it.
Development grid_development(const std::vector<std::vector<Vec2>>& columns,
                             const std::function<bool(std::size_t, std::size_t)>& skip,
                             std::function<Vec3(const Vec2&)> fold, std::mt19937_64& random) {
  const std::size_t rows = columns[0].size();
  std::vector<Index> vertex_of(columns.size() * rows, kNone);
  Development result;
  PolyMesh soup;
  const auto vertex = [&](std::size_t i, std::size_t j) {
    Index& v = vertex_of[i * rows + j];
    if (v == kNone) {
      v = soup.vertex_count();
      result.flat.push_back(columns[i][j]);
      soup.positions.push_back(fold(columns[i][j]));
    }
    return v;
  };
  for (std::size_t i = 0; i + 1 < columns.size(); ++i) {
    for (std::size_t j = 0; j + 1 < rows; ++j) {
      if (skip(i, j)) continue;
      std::array<Index, 4> c = {vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1),
                                vertex(i, j + 1)};
      if (random() % 2 == 0) std::rotate(c.begin(), c.begin() + 1, c.end());
      soup.add_face(std::array<Index, 3>{c[0], c[1], c[2]});
      soup.add_face(std::array<Index, 3>{c[0], c[2], c[3]});
    }
  }
  result.mesh = support::plain_tri_mesh(soup);
  result.fold = std::move(fold);
  return result;
}

double jitter(std::mt19937_64& random, double size) {
  return std::uniform_real_distribution<double>(-size, size)(random);
}

constexpr int kPrismFacets = 24;
constexpr int kPrismRows = 17;
constexpr int kPyramidFacets = 18;
constexpr int kPyramidRows = 14;
constexpr double kOpening = 0.6;  ///< angle of the pyramid's sides to its axis
constexpr int kHalf = 6;          ///< cells per side of a square of the cube

constexpr auto kSkipNothing = [](std::size_t, std::size_t) { return false; };

}  // namespace

Development cylinder_development(std::uint64_t seed) {
  const double width = 2 * std::sin(M_PI / kPrismFacets);  // of a facet, radius 1
  std::mt19937_64 random(seed);
  std::vector<std::vector<Vec2>> columns;
  for (int i = 0; i <= kPrismFacets; ++i) {
    columns.emplace_back();
    for (int j = 0; j < kPrismRows; ++j) {
      columns.back().emplace_back(i * width, 4.0 * j / (kPrismRows - 1) + jitter(random, 0.08));
    }
  }
  const auto fold = [=](const Vec2& p) {
    const double at = std::clamp(std::floor(p.x() / width), 0.0, kPrismFacets - 1.0);
    const auto corner = [](double k) {
      const double angle = 2 * M_PI * k / kPrismFacets;
      return Vec2(std::cos(angle), std::sin(angle));
    };
    const double share = p.x() / width - at;
    const Vec2 q = (1 - share) * corner(at) + share * corner(at + 1);
    return Vec3(q.x(), q.y(), p.y());
  };
  return grid_development(columns, kSkipNothing, fold, random);
}

Development cone_development(std::uint64_t seed) {
  const auto generator = [](double k) {
    const double turn = 2 * M_PI * k / kPyramidFacets;
    return Vec3(std::sin(kOpening) * std::cos(turn), std::sin(kOpening) * std::sin(turn),
                -std::cos(kOpening));
  };
  const double wedge = std::acos(generator(0).dot(generator(1)));
  std::mt19937_64 random(seed);
  std::vector<std::vector<Vec2>> columns;
  for (int i = 0; i <= kPyramidFacets; ++i) {
    columns.emplace_back();
    for (int j = 0; j < kPyramidRows; ++j) {
      const double r = 3 - 2.5 * j / (kPyramidRows - 1) + jitter(random, 0.06);
      columns.back().push_back(r * Vec2(std::cos(i * wedge), std::sin(i * wedge)));
    }
  }
  const auto fold = [=](const Vec2& p) {
    double angle = std::atan2(p.y(), p.x());
    if (angle < -0.1) angle += 2 * M_PI;  // the development is wider than a half turn
    const double at = std::clamp(std::floor(angle / wedge), 0.0, kPyramidFacets - 1.0);
    // Two rays of the plane go to two generators; linear between them.
    Mat2 rays;
    rays << std::cos(at * wedge), std::cos((at + 1) * wedge), std::sin(at * wedge),
        std::sin((at + 1) * wedge);
    const Vec2 share = rays.inverse() * p;
    return Vec3(share[0] * generator(at) + share[1] * generator(at + 1));
  };
  return grid_development(columns, kSkipNothing, fold, random);
}

Development cube_corner_development(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<std::vector<Vec2>> columns;
  for (int i = -kHalf; i <= kHalf; ++i) {
    columns.emplace_back();
    for (int j = -kHalf; j <= kHalf; ++j) {
      const bool inside = std::abs(i) < kHalf && std::abs(j) < kHalf;
      const double size = inside ? 0.25 / kHalf : 0.0;
      // Vertices on the folds stay there.
      columns.back().emplace_back(double(i) / kHalf + (i != 0 ? jitter(random, size) : 0.0),
                                  double(j) / kHalf + (j != 0 ? jitter(random, size) : 0.0));
    }
  }
  const auto fold = [](const Vec2& p) -> Vec3 {
    if (p.x() >= 0 && p.y() >= 0) return {p.x(), p.y(), 0};
    if (p.y() >= 0) return {0, p.y(), -p.x()};
    return {-p.y(), 0, -p.x()};
  };
  const auto skip = [](std::size_t i, std::size_t j) { return i >= kHalf && j < kHalf; };
  return grid_development(columns, skip, fold, random);
}

}  // namespace strake
