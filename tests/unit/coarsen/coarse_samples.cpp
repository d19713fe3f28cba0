#include "tests/unit/coarsen/coarse_samples.h"

#include "stages/coarsen/coarsen.h"
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

}  // namespace strake::coarsen_test
