#pragma once

#include <cstdint>

#include "common/core/tri_mesh.h"
#include "common/geometry/samples/samples.h"
#include "tests/support/import_support.h"

namespace strake {

inline TriMesh sample(SampleKind kind, std::int64_t faces) {
  SampleOptions options;
  options.faces = faces;
  return support::import_tri_mesh(make_sample(kind, options));
}

}  // namespace strake
