#pragma once

#include <vector>

#include "stages/trace/line_tracer.h"

namespace strake {

/// A feature or boundary line: edges that follow each other between corners, or a loop.
struct BarrierLine {
  std::vector<Index>
      halfedges;  ///< each starts where the one before ends; boundary ones face inwards
  bool closed = false;
  bool boundary = false;
  double measure = 0;  ///< length in units of the distance wanted between lines that cross it
};

/// Keeps spacings along rings of feature and boundary edges small enough for three lines to cross.
void bound_rings(const TriMesh& mesh, SpacingModel& model);

/// The feature and boundary lines ([MK04] section 3), cut at corners.
///
/// Leaves out what is too small to be seen at the wanted line distances: feature lines that end
/// freely after less than a line distance or two, and small groups of them without a ring.
std::vector<BarrierLine> barrier_lines(const TraceDomain& domain);

/// [3F] 1 on the half-edges that these lines run along, on both sides.
std::vector<std::uint8_t> barrier_flags(const TriMesh& mesh, const std::vector<BarrierLine>& lines);

/// The line in the representation of LineSet: along edges, from vertex to vertex.
TracedLine to_traced_line(const BarrierLine& line);

/// Seeds for lines that cross a feature or boundary line, evenly spread at the distance wanted
/// there.
void seed_along(const TraceDomain& domain, const BarrierLine& line, std::vector<Seed>& seeds);

/// Seeds at corners: a wedge of angle a gets round(a / 90 degrees) - 1 lines, so that the cells at
/// the corner come close to right angles.
/// \param barriers [3F] as from `barrier_flags`
void seed_at_corners(const TraceDomain& domain, const std::vector<std::uint8_t>& barriers,
                     std::vector<Seed>& seeds);

}  // namespace strake
