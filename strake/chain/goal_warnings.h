#pragma once

#include "strake/chain/line_aim.h"
#include "strake/chain/session.h"

namespace strake {

/// Tells a user that a wanted count is missed, and what helps.
void warn_of_count(Session& session, const LineAim& aim);

/// Tells a user that a result within a tolerance has far more vertices than the input: a mesh
/// coarser than the tolerance is taken for the polyhedron it is, edge by edge.
void warn_of_excess(Session& session);

/// Tells a user how far the mesh that a tolerance is proven for is from the file, where repairs or
/// smoothing moved more than a hundredth of the tolerance, or removed faces.
/// \param tolerance  model units
void say_what_is_proven(Session& session, double tolerance);

/// Says where a tolerance that was not proven is missed.
/// \param measures  of evaluate
/// \param tolerance  model units
void warn_of_distance(Session& session, const Report& measures, double tolerance);

/// Says where feature lines are lost although their edges were listed. \param measures  of evaluate
void warn_of_listed_edges(Session& session, const Report& measures);

}  // namespace strake
