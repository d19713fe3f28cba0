#pragma once

#include "strake/chain/line_aim.h"
#include "strake/chain/session.h"

namespace strake {

/// Tells a user that a wanted count is missed, and what helps.
void warn_of_count(Session& session, const LineAim& aim);

/// Tells a user that a result within a tolerance has far more vertices than the input: a mesh
/// coarser than the tolerance is taken for the polyhedron it is, edge by edge.
void warn_of_excess(Session& session);

}  // namespace strake
