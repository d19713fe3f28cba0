#pragma once

#include <cstdint>

#include "common/core/tri_mesh.h"

namespace strake::import {

/// How a surface bends from face to face, by which measurement noise shows.
struct Noise {
  double median_bend_deg = 0;  ///< of edges, weighted by their length
  /// 0 where bends around a vertex and its neighbours are all to the same side, 1 where they
  /// cancel.
  double to_and_fro = 0;

  /// Whether it is so large that directions of curvature, and lines along them, mean little.
  [[nodiscard]] bool is_much() const;
};

/// Cost O(n).
Noise measure_noise(const TriMesh& mesh);

/// Takes noise off the positions of a mesh, and leaves its volume and what is several edges large
/// about as it is: each round moves vertices towards the middle of their neighbours, and back by a
/// little more (Taubin, A Signal Processing Approach to Fair Surface Design, 1995). Vertices at the
/// boundary have those along it as neighbours, and move along their normals alone: pinholes and
/// teeth of a ragged scan would close up. Creases become round within some edges.
/// \return root mean square of the moves, model units. Cost O(n) a round
double take_noise_off(TriMesh& mesh, std::int64_t rounds);

}  // namespace strake::import
