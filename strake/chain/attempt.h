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

/// See `part_faces`.
using Again = std::function<Attempt(Session, const std::vector<Vec3>& places)>;

/// Whether no more attempts are worth it, going by the best one so far.
using GiveUp = std::function<bool(const Attempt& best)>;
inline bool never_give_up(const Attempt& /*best*/) { return false; }

/// Where lines lie across a tip or a fold, its cells come to cross. Makes the result again with
/// closer lines at such faces, as long as that helps: not after two attempts in a row that leave no
/// fewer of them.
/// \param first     does not miss its goal
/// \param faces     of its result: the more, the fewer attempts
/// \param patience  attempts that may leave more than half of the faces that cross
/// \param again     makes and keeps a result like a session's, with closer lines around places
/// \param give_up   asked once, after two attempts that leave more than half of the faces that cross
/// \param keep      keeps one again
/// \return the attempt that meets its goal with the fewest faces that cross; it is the one kept
Attempt part_faces(const Attempt& first, Index faces, int patience, const Again& again,
                   const GiveUp& give_up, const std::function<void(Attempt&)>& keep);

}  // namespace strake
