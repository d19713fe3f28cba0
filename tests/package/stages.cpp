// Single stages, without the chain.
#include <cmath>

#include "stages/import/import.h"
#include "stages/tensor/tensor.h"

int main() {
  strake::PolyMesh flat;
  flat.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  flat.offsets = {0, 4};
  flat.corners = {0, 1, 2, 3};
  strake::SilentObserver observer;
  strake::ImportOptions undivided;
  undivided.longest_edge = strake::percent(100);
  const strake::TriMesh mesh = strake::import_mesh(flat, undivided, observer).mesh;
  const strake::TensorField field = strake::estimate_tensors(mesh, {}, observer).field;
  for (const auto& tensor : field.tensor) {
    for (const double value : tensor) {
      if (std::abs(value) > 1e-12) return 1;  // a plane does not bend
    }
  }
  return mesh.face_count() == 2 && field.tensor.size() == 4 ? 0 : 1;
}
