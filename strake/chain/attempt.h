#pragma once

#include <functional>
#include <vector>

#include "common/core/types.h"
#include "strake/chain/session.h"

namespace strake {

/// A result on the way to a goal, to return to.
struct Attempt {
  Session meshed;            ///< as it was before cells were divided
  Session done;              ///< the result
  std::vector<Vec3> places;  ///< where it should be better, relative to the mesh's origin
  bool misses_goal = false;  ///< else `places` are faces that cross
};

/// From now on, wants lines at their present distances, but closer around some places. The scale of
/// distances is for the caller to set: these have it in them, unless a count sets theirs.
/// \param factor  on the distances there, from 0 to 1
void want_closer(Session& session, const std::vector<Vec3>& places, double factor);

/// Where lines lie across a tip or a fold, its cells come to cross. Wants closer lines at such
/// faces and makes the result again, as long as that helps.
/// \param first     does not miss its goal
/// \param faces     of its result: the more, the fewer attempts
/// \param again     makes and keeps a result at the distances that the session wants
/// \param keep      keeps one again
/// \return the attempt that meets its goal with the fewest faces that cross; it is the one kept
Attempt part_faces(const Attempt& first, Index faces, const std::function<Attempt(Session)>& again,
                   const std::function<void(Attempt&)>& keep);

}  // namespace strake
