#include "tests/unit/coarsen/coarse_samples.h"

#include <utility>
#include <vector>

#include "stages/coarsen/coarsen.h"
#include "stages/smooth/smooth.h"
#include "stages/tensor/tensor.h"
#include "tests/support/import_support.h"

namespace strake::coarsen_test {

TriMesh sample(SampleKind kind, std::int64_t faces) {
  SampleOptions options;
  options.faces = faces;
  return support::import_tri_mesh(make_sample(kind, options));
}

TriMesh coarsened(const TriMesh& mesh, std::int64_t vertices) {
  CoarsenOptions options;
  options.vertices = vertices;
  SilentObserver observer;
  return coarsen_mesh(mesh, options, observer).mesh;
}

PrincipalField coarse_field(const TriMesh& mesh, const TriMesh& coarse) {
  SilentObserver observer;
  TensorField tensor = estimate_tensors(mesh, {}, observer, &coarse).field;
  return smooth_tensors(coarse, std::move(tensor), {}, observer).field;
}

PolyMesh thin_shell(double thickness) {
  SampleOptions options;
  options.faces = 20000;
  PolyMesh shell = make_sample(SampleKind::sphere, options);
  const PolyMesh outside = shell;
  const Index count = outside.vertex_count();
  for (const Vec3& p : outside.positions) shell.positions.push_back((1 - thickness) * p);
  for (Index f = 0; f < outside.face_count(); ++f) {
    const auto face = outside.face(f);
    shell.add_face(std::vector<Index>{count + face[0], count + face[2], count + face[1]});
  }
  return shell;
}

}  // namespace strake::coarsen_test
