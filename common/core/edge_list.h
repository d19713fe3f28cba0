#pragma once

#include <string>
#include <vector>

#include "common/core/types.h"

namespace strake {

/// Edges of a mesh file, as pairs of its vertices.
struct EdgeList {
  struct Edge {
    Index from = kNone;  ///< number of a vertex in the mesh file, from 0
    Index to = kNone;
    int line = 0;  ///< of the list, from 1, for messages
  };
  std::vector<Edge> edges;
  std::string name;  ///< of the file, for messages
};

}  // namespace strake
