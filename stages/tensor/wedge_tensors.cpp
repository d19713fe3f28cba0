#include "stages/tensor/wedge_tensors.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>

#include "common/geometry/frames.h"
#include "common/geometry/mesh_measures.h"
#include "stages/tensor/ball.h"

namespace strake {
namespace {

constexpr Length kDefaultRadius = percent(1);
/// Of meshes whose balls have the default radius.
constexpr double kMostFacesOfDefault = 2e6;
/// Almost twice as many as in any ball of usual meshes of up to a million faces.
constexpr Index kMostFacesOfBall = 4000;

constexpr Index kBlock = 256;
/// Of two, in the radius of balls: beyond it areas and bends are no numbers in single precision.
constexpr int kLargestExponent = 50;

/// Mean length of the edges around each wedge.
std::vector<double> wedge_edge_lengths(const TriMesh& mesh) {
  std::vector<double> sum(mesh.wedge_count(), 0);
  std::vector<Index> count(mesh.wedge_count(), 0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    const double length = (mesh.positions[mesh.to(h)] - mesh.positions[mesh.from(h)]).norm();
    for (const Index corner : {h, TriMesh::next(h)}) {
      sum[mesh.wedge_of(corner)] += length;
      ++count[mesh.wedge_of(corner)];
    }
  }
  for (Index w = 0; w < mesh.wedge_count(); ++w) sum[w] /= std::max(count[w], Index{1});
  return sum;
}

/// The same by way of a mesh whose lengths are divided by a power of two.
WedgeTensors estimate_in_other_unit(int exponent, const TriMesh& mesh,
                                    const std::vector<Index>& wedges, const BallRule& rule,
                                    Observer& observer) {
  TriMesh scaled = mesh;
  for (Vec3& p : scaled.positions) p *= std::exp2(-exponent);
  WedgeTensors result = estimate_wedge_tensors(
      scaled, wedges, {std::ldexp(rule.radius, -exponent), rule.most_faces}, observer);
  for (auto& tensor : result.tensor) {
    for (double& entry : tensor) entry = std::ldexp(entry, -exponent);
  }
  return result;
}

}  // namespace

BallRule ball_rule(const TensorOptions& options, double diagonal, Index faces) {
  if (options.radius) return {options.radius->resolve(diagonal)};
  const double share = kMostFacesOfDefault / std::max<Index>(faces, 1);
  return {std::sqrt(std::min(1.0, share)) * kDefaultRadius.resolve(diagonal), kMostFacesOfBall};
}

WedgeTensors estimate_wedge_tensors(const TriMesh& mesh, const std::vector<Index>& wedges,
                                    const BallRule& rule, Observer& observer) {
  if (const int exponent = std::ilogb(rule.radius); std::abs(exponent) > kLargestExponent) {
    return estimate_in_other_unit(exponent, mesh, wedges, rule, observer);
  }
  const FaceNormals face_normals(mesh);
  WedgeTensors result;
  {  // first, while there is nothing else to remember
    const std::vector<Vec3> all = wedge_normals(mesh, face_normals);
    result.normal.reserve(wedges.size());
    for (const Index w : wedges) result.normal.push_back(all[w]);
  }
  const std::vector<Vec3> normals = face_normals.all();
  const FaceCycles cycles(mesh, normals);
  const std::vector<double> edge_length = wedge_edge_lengths(mesh);

  std::vector<Index> wedge_corner(mesh.wedge_count(), kNone);
  for (Index h = mesh.halfedge_count() - 1; h >= 0; --h) wedge_corner[mesh.wedge_of(h)] = h;

  const auto count = static_cast<Index>(wedges.size());
  result.tensor.resize(wedges.size());

  tbb::enumerable_thread_specific<BallWalker> walkers([&] { return BallWalker(cycles); });
  std::atomic<Index> grown{0};
  const Index blocks = (count + kBlock - 1) / kBlock;
  const Index reports = std::min<Index>(blocks, 64);
  for (Index part = 0; part < reports; ++part) {
    const Index first = static_cast<Index>(std::int64_t{blocks} * part / reports) * kBlock;
    const Index last = std::min<Index>(
        static_cast<Index>(std::int64_t{blocks} * (part + 1) / reports) * kBlock, count);
    tbb::parallel_for(tbb::blocked_range<Index>(first, last, 32), [&](const auto& range) {
      BallWalker& walker = walkers.local();
      for (Index i = range.begin(); i != range.end(); ++i) {
        const Index w = wedges[i];
        const double one_ring = 1.5 * edge_length[w];
        const double r = std::clamp(one_ring, rule.radius, kLargestGrowth * rule.radius);
        if (r > rule.radius) grown.fetch_add(1, std::memory_order_relaxed);
        result.tensor[i] =
            walker.tensor(wedge_corner[w], result.normal[i], {r, one_ring, rule.most_faces});
      }
    });
    observer.report("estimating curvature tensors", double(part + 1) / reports);
  }
  result.grown = grown.load();
  for (const BallWalker& walker : walkers) result.shrunk += walker.shrunk();
  return result;
}

}  // namespace strake
