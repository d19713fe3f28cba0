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
  /// Share of bent edges, by length, that repeat those on two opposite sides of them, as facets of
  /// threads and twisted profiles do.
  double repeated = 0;

  /// Whether it is so large that directions of curvature, and lines along them, mean little.
  [[nodiscard]] bool is_much() const;
};

/// Where bends are no noise in any case, what repeats is not looked for.
/// Cost O(n).
Noise measure_noise(const TriMesh& mesh);

/// How far vertices were moved along their normals, model units.
struct Moves {
  double rms = 0;
  double largest = 0;
};

/// Takes noise off the positions of a mesh, and leaves its volume and what is several edges large
/// about as it is.
///
/// Each round moves vertices so that what they are off the middle of their neighbours comes nearer
/// to what these are off theirs: by 0.3 of the second difference, where Taubin's steps to and back
/// (A Signal Processing Approach to Fair Surface Design, 1995) come to 0.27. Differs, since long
/// triangles slid and coarse creases collapsed (tests `TakeNoiseOff.Leaves*`):
/// - neighbours count by the inverse of their distance, and differences of vertices with edges of
///   different length are compared at the shorter one's scale;
/// - vertices on feature edges, if flagged, have those along the line as neighbours, and corners
///   and ends stay; vertices at the boundary have those along it, and move along their normals
///   alone: pinholes and teeth of a ragged scan would close up. Others are compared among
///   themselves, so that a vertex between creases stays.
///
/// Where creases are not flagged they become round within some edges.
/// \pre `build_topology` has run
/// Cost O(n) a round. Deterministic for any thread count.
Moves take_noise_off(TriMesh& mesh, std::int64_t rounds);

}  // namespace strake::import
