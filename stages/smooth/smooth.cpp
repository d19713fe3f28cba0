#include "stages/smooth/smooth.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <complex>

#include "common/core/error.h"
#include "common/geometry/frames.h"
#include "common/geometry/mesh_measures.h"
#include "stages/smooth/cross_field.h"
#include "stages/smooth/guide_layout.h"

namespace strake {
namespace {

using Complex = std::complex<double>;

/// A symmetric tensor of the tangent plane of a wedge, in its `tangent_frame`. In a frame turned by
/// an angle the mean stays, and the deviation turns by twice the angle.
struct TangentTensor {
  double mean = 0;    ///< (xx + yy) / 2
  Complex deviation;  ///< (xx - yy) / 2 and xy
};

/// The part of the tensor in the tangent plane: the realignment of [MK04] section 2, as a
/// projection.
TangentTensor project(const std::array<double, 6>& tensor, const Vec3& normal) {
  const TangentFrame frame = tangent_frame(normal);
  Mat3 t;
  t << tensor[0], tensor[1], tensor[2], tensor[1], tensor[3], tensor[4], tensor[2], tensor[4],
      tensor[5];
  const Vec3 tx = t * frame.x;
  const Vec3 ty = t * frame.y;
  const double xx = frame.x.dot(tx);
  const double yy = frame.y.dot(ty);
  return {(xx + yy) / 2, {(xx - yy) / 2, frame.x.dot(ty)}};
}

std::vector<TangentTensor> project(const TensorField& field) {
  std::vector<TangentTensor> tensors(field.tensor.size());
  tbb::parallel_for(Index{0}, static_cast<Index>(tensors.size()),
                    [&](Index w) { tensors[w] = project(field.tensor[w], field.normal[w]); });
  return tensors;
}

/// Principal frames of tensors. The larger eigenvalue belongs to the minimum direction (normal
/// cycles swap the two).
void set_frames(const std::vector<TangentTensor>& tensors, PrincipalField& field) {
  tbb::parallel_for(Index{0}, static_cast<Index>(tensors.size()), [&](Index w) {
    const auto& [mean, deviation] = tensors[w];
    const Eigen2 eigen =
        eigen_symmetric2(mean + deviation.real(), deviation.imag(), mean - deviation.real());
    const TangentFrame frame = tangent_frame(field.normal[w]);
    field.t_min[w] = frame.world_from_tangent(eigen.direction_of_larger).normalized();
    field.k_max[w] = eigen.larger;
    field.k_min[w] = eigen.smaller;
  });
}

/// Confidence of faces ([MK04] equation 1) and wedges (mean over their faces).
void set_confidence(const TriMesh& mesh, PrincipalField& field) {
  const FaceNormals normals(mesh);
  field.face_confidence.assign(mesh.face_count(), 0);
  tbb::parallel_for(Index{0}, mesh.face_count(), [&](Index f) {
    std::array<Vec3, 3> d;
    for (int i = 0; i < 3; ++i) {
      const Index w = mesh.face_wedges[f][i];
      d[i] = rotate_between(field.normal[w], normals[f], field.t_min[w]);
    }
    const double least =
        std::min({std::abs(d[0].dot(d[1])), std::abs(d[1].dot(d[2])), std::abs(d[2].dot(d[0]))});
    field.face_confidence[f] = std::clamp(least, 0.0, 1.0);
  });
  std::vector<double> sum(mesh.wedge_count(), 0);
  std::vector<Index> count(mesh.wedge_count(), 0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    sum[mesh.wedge_of(h)] += field.face_confidence[TriMesh::face_of(h)];
    ++count[mesh.wedge_of(h)];
  }
  for (Index w = 0; w < mesh.wedge_count(); ++w) sum[w] /= std::max(count[w], Index{1});
  field.wedge_confidence = std::move(sum);
}

/// One step of the operator of [MK04] section 4.1. Differs: neighbours' tensors are turned into
/// the tangent plane of the wedge first, so that bending does not leak into the normal direction.
void smoothing_step(const WedgeGraph& graph, const PrincipalField& field,
                    const std::vector<TangentTensor>& tensors, std::vector<TangentTensor>& next) {
  tbb::parallel_for(Index{0}, static_cast<Index>(tensors.size()), [&](Index w) {
    const TangentFrame frame = tangent_frame(field.normal[w]);
    TangentTensor sum;
    double weights = 0;
    for (Index at = graph.offsets[w]; at < graph.offsets[w + 1]; ++at) {
      const Index j = graph.neighbours[at];
      const double confidence = field.wedge_confidence[j];
      const Vec3 axis = tangent_frame(field.normal[j]).x;
      const Vec2 here =
          frame.tangent_from_world(rotate_between(field.normal[j], field.normal[w], axis));
      const Complex turn(here.x(), here.y());
      sum.mean += confidence * tensors[j].mean;
      sum.deviation += confidence * (turn * turn * tensors[j].deviation);
      weights += confidence;
    }
    next[w] = tensors[w];
    if (!(weights > 0)) return;
    const double keep = field.wedge_confidence[w] / 2;
    const double share = (1 - keep) / weights;
    next[w].mean = keep * tensors[w].mean + share * sum.mean;
    next[w].deviation = keep * tensors[w].deviation + share * sum.deviation;
  });
}

/// Lays guides onto the mesh, into the field. \return what they do to it; nothing without any
GuidePull take_guides(const TriMesh& mesh, const WedgeGraph& graph, const GuideLines* guides,
                      double reach, SmoothResult& result) {
  if (guides == nullptr) return {};
  result.field.guides = lay_guides(mesh, *guides);
  double length = 0;
  for (const Vec3& step : result.field.guides.step) length += step.norm();
  result.report.set("smooth.guides", static_cast<std::int64_t>(result.field.guides.line_count()));
  result.report.set("smooth.guide_length", length);
  return guide_pull(mesh, graph, result.field, reach);
}

/// Makes `cross` the arm nearest to t_min.
void name_arms(PrincipalField& field) {
  tbb::parallel_for(Index{0}, static_cast<Index>(field.cross.size()), [&](Index w) {
    const TangentFrame frame = tangent_frame(field.normal[w]);
    const Vec2 arm = cross_arm(cross_power(frame.tangent_from_world(field.cross[w])),
                               frame.tangent_from_world(field.t_min[w]));
    field.cross[w] = frame.world_from_tangent(arm).normalized();
  });
}

}  // namespace

SmoothResult smooth_tensors(const TriMesh& mesh, TensorField tensor, const SmoothOptions& options,
                            Observer& observer, const GuideLines* guides) {
  if (guides != nullptr && options.extension != "cross") {
    throw UsageError("guide lines turn the cross field, which --extension " + options.extension +
                     " does without; leave one of them out");
  }
  SmoothResult result;
  PrincipalField& field = result.field;
  const auto count = static_cast<std::size_t>(mesh.wedge_count());
  field.mesh_id = mesh.id;
  std::vector<TangentTensor> tensors = project(tensor);
  tensor.tensor = std::vector<std::array<double, 6>>();  // "= {}" would keep the memory
  field.normal = std::move(tensor.normal);
  field.t_min.resize(count);
  field.k_min.resize(count);
  field.k_max.resize(count);

  set_frames(tensors, field);
  set_confidence(mesh, field);
  double before = 0;
  for (const double c : field.face_confidence) before += c;
  field.face_confidence = std::vector<double>();  // until the end; "= {}" would keep the memory

  const WedgeGraph graph = wedge_graph(mesh);
  if (options.extension == "cross") {
    // From the tensors as estimated: the solve evens out what is doubtful, and only that.
    observer.report("extending the cross field", 0);
    const GuidePull pull =
        take_guides(mesh, graph, guides, options.guide_reach.resolve(mesh.diagonal), result);
    const Index iterations = extend_cross_field(mesh, graph, options.field_stiffness, pull, field);
    result.report.set("smooth.solver_iterations", static_cast<std::int64_t>(iterations));
  }
  std::vector<TangentTensor> next(tensors.size());
  for (std::int64_t step = 0; step < options.iterations; ++step) {
    smoothing_step(graph, field, tensors, next);
    tensors.swap(next);
    observer.report("smoothing curvature tensors",
                    double(step + 1) / static_cast<double>(options.iterations + 1));
  }
  set_frames(tensors, field);
  set_confidence(mesh, field);
  double after = 0;
  for (const double c : field.face_confidence) after += c;

  const double faces = std::max<double>(1, mesh.face_count());
  result.report.set("smooth.iterations", options.iterations);
  result.report.set("smooth.mean_confidence_before", before / faces);
  result.report.set("smooth.mean_confidence_after", after / faces);
  if (options.extension == "cross") {
    name_arms(field);
  } else {
    field.cross = field.t_min;
  }
  return result;
}

}  // namespace strake
