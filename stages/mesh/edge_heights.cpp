#include "stages/mesh/edge_heights.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "common/core/mix_bits.h"

namespace strake {
namespace {

/// Bits of a hash: each thread remembers two to the power of that many edges, 1.8 MB.
constexpr unsigned kHashBits = 15;

std::size_t hash_of(const Vec3& a, const Vec3& b) {
  std::uint64_t hash = 0;
  for (const Vec3* end : {&a, &b}) {
    for (const double x : *end) hash = mix_bits(hash, std::bit_cast<std::uint64_t>(x));
  }
  return hash >> (64 - kHashBits);
}

}  // namespace

double EdgeHeights::at(const Vec3& a, const Vec3& b) const {
  std::vector<Edge>& last = last_.local();
  if (last.empty()) last.resize(std::size_t{1} << kHashBits);
  Edge& edge = last[hash_of(a, b)];
  if (edge.a != a || edge.b != b) edge = {a, b, measure(a, b)};
  return edge.height;
}

Vec3 EdgeHeights::normal_below(const Vec3& a, const Vec3& b) const {
  const std::vector<Vec3>& p = surface_.positions();
  const auto [i, j, k] = surface_.triangles()[surface_.closest((a + b) / 2).triangle];
  return (p[j] - p[i]).cross(p[k] - p[i]);
}

double EdgeHeights::measure(const Vec3& a, const Vec3& b) const {
  double farthest = 0;
  Index nearest = kNone;
  for (const double share : {0.25, 0.5, 0.75}) {
    const ClosestPoint foot = surface_.closest_near(a + share * (b - a), nearest);
    farthest = std::max(farthest, foot.distance);
    nearest = foot.triangle;
  }
  return farthest;
}

}  // namespace strake
