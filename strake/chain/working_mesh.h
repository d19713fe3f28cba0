#pragma once

#include <cstdint>
#include <optional>

#include "strake/chain/goal_stages.h"
#include "strake/chain/session.h"

namespace strake {

/// Estimates the field on the mesh itself. \pre the session has "mesh"
void estimate_field(Session& session, const GoalStages& stages);

/// The session with a coarser mesh in place of the input, and a field estimated at its vertices
/// over the input, where that is much finer than a result needs it; nothing where it is not, its
/// lines allow no coarser one, or there are guides.
/// \param vertices  wanted of the result, about
/// \param ratio     vertices of the coarser mesh per vertex of that; 0: never
/// \pre the session has "mesh"
std::optional<Session> on_coarser_mesh(const Session& session, const GoalStages& stages,
                                       std::int64_t vertices, double ratio);

/// Takes the ports "fitted" and "field" of a session on a coarser mesh to one on the input, and
/// fits there once more, a few rounds. What else there was on the coarser one is left behind.
void take_from_coarser_mesh(Session& session, Session coarser, const GoalStages& stages);

}  // namespace strake
