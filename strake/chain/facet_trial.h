#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "common/core/options.h"
#include "common/stage/stage.h"
#include "strake/chain/counted.h"
#include "strake/chain/session.h"

namespace strake {

/// How a chain comes to a result.
struct WayToResult {
  std::vector<const Stage*> stages;                 ///< whose options it changes
  std::function<void(Session&)> import_mesh;        ///< from "input"
  std::function<std::string(Session&)> reach_goal;  ///< \return the port of the result
};

/// Makes a result for a count; where it is poor, once more with edges between the facets of the
/// mesh as features, and takes what is better: nearer by half, or with fewer odd faces, and in
/// nothing else much worse. What is kept is of the result taken.
/// \param facet_height  the option of import;
/// \param height  its value for that
/// \return the port of the result
std::string make_with_facets_if_better(Session& session, const WayToResult& way,
                                       const Option& facet_height, const Length& height,
                                       Counted counted, std::int64_t wanted);

}  // namespace strake
