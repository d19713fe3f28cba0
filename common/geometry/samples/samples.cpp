#include "common/geometry/samples/samples.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "common/core/error.h"
#include "common/core/text.h"
#include "common/geometry/samples/relax.h"
#include "common/geometry/samples/sample_designs.h"

namespace strake {
namespace {

constexpr int kRelaxRounds = 6;
constexpr int kSizeTrials = 6;
constexpr double kCountTolerance = 0.03;
constexpr double kMinFaces = 500, kMaxFaces = 1e7;

double jitter_of(SampleKind kind, const SampleOptions& options) {
  return options.jitter.value_or(kind == SampleKind::part ? 0.0 : 0.25);
}

SurfaceDraft draw(SampleKind kind, double size, const SampleOptions& options) {
  SurfaceBuilder builder(jitter_of(kind, options), static_cast<std::uint64_t>(options.seed));
  design_analytic(kind, size, builder);
  return builder.finish();
}

double area_of(const SurfaceDraft& draft) {
  double area = 0;
  for (const auto& f : draft.faces) {
    const Vec3& a = draft.positions[f[0]];
    area += (draft.positions[f[1]] - a).cross(draft.positions[f[2]] - a).norm() / 2;
  }
  return area;
}

/// Draws with the edge length that gives the wanted number of faces.
SurfaceDraft draw_with_count(SampleKind kind, const SampleOptions& options) {
  const double wanted = static_cast<double>(options.faces);
  // A coarse draft tells the area; then N equilateral triangles of that area.
  const SurfaceDraft coarse = draw(kind, kind == SampleKind::part ? 3.0 : 0.15, options);
  double size = std::sqrt(area_of(coarse) / wanted * 4 / std::sqrt(3.0));
  SurfaceDraft best = draw(kind, size, options);
  for (int trial = 1; trial < kSizeTrials; ++trial) {
    const double count = static_cast<double>(best.faces.size());
    if (std::abs(count - wanted) <= kCountTolerance * wanted) break;
    size *= std::clamp(std::sqrt(count / wanted), 0.5, 2.0);
    best = draw(kind, size, options);
  }
  return best;
}

}  // namespace

OptionList SampleOptions::declare() {
  return {
      {"faces", &faces, "", "wanted number of triangles", kMinFaces, kMaxFaces},
      {"jitter", &jitter, "", "irregularity of the triangles", 0, 1},
      {"seed", &seed, "", "of the irregularity", 0},
  };
}

LabelledSample make_labelled_sample(SampleKind kind, const SampleOptions& options) {
  if (!(static_cast<double>(options.faces) >= kMinFaces &&
        static_cast<double>(options.faces) <= kMaxFaces)) {
    throw UsageError("sample: faces must lie between 500 and 10000000, not " +
                     std::to_string(options.faces));
  }
  const double jitter = jitter_of(kind, options);
  if (!(jitter >= 0 && jitter <= 1)) {
    throw UsageError("sample: jitter must lie between 0 and 1, not " + std::to_string(jitter));
  }
  SurfaceDraft draft = draw_with_count(kind, options);
  relax(draft, kRelaxRounds);
  UniformRandom random(static_cast<std::uint64_t>(options.seed) + 1);
  scatter(draft, jitter, random);

  LabelledSample sample;
  sample.mesh.positions = std::move(draft.positions);
  for (const auto& face : draft.faces) sample.mesh.add_face(face);
  sample.face_region = std::move(draft.face_region);
  return sample;
}

PolyMesh make_sample(SampleKind kind, const SampleOptions& options) {
  return make_labelled_sample(kind, options).mesh;
}

const std::vector<std::string>& sample_names() {
  static const std::vector<std::string> names = {"plane",         "sphere", "cylinder",
                                                 "open_cylinder", "torus",  "ellipsoid",
                                                 "hyperboloid",   "saddle", "part"};
  return names;
}

SampleKind sample_kind(std::string_view name) {
  const auto& names = sample_names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    throw UsageError("no sample is called '" + std::string(name) + "'; there are " +
                     join_words(names));
  }
  return static_cast<SampleKind>(found - names.begin());
}

}  // namespace strake
