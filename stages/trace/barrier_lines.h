#pragma once

#include <vector>

#include "stages/trace/line_tracer.h"

namespace strake {

/// A feature or boundary line: edges that follow each other between corners, or a loop.
struct BarrierLine {
  std::vector<Index> halfedges;  ///< each starts where the one before ends; boundary ones face inwards
  bool closed = false;
  bool boundary = false;
};

/// All feature and boundary lines ([MK04] section 3), cut at corners.
std::vector<BarrierLine> barrier_lines(const TriMesh& mesh);

/// The line in the representation of LineSet: along edges, from vertex to vertex.
TracedLine to_traced_line(const BarrierLine& line);

/// Seeds for lines that cross a feature or boundary line, evenly spread at the distance wanted
/// there.
void seed_along(const TraceDomain& domain, const BarrierLine& line, std::vector<Seed>& seeds);

/// Seeds at corners: a wedge of angle a gets round(a / 90 degrees) - 1 lines, so that the cells at
/// the corner come close to right angles.
void seed_at_corners(const TraceDomain& domain, std::vector<Seed>& seeds);

}  // namespace strake
