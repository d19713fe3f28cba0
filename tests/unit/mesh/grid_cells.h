#pragma once

#include <functional>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "common/core/tri_mesh.h"
#include "stages/mesh/polygon_graph.h"

namespace strake {

struct Grid {
  std::vector<double> x;
  std::vector<double> y;
};

/// 0, 1, ... n - 1
std::vector<double> steps(int n);

/// A triangulated grid in the plane, with its four corners.
TriMesh grid_mesh(const Grid& grid);

using KeepEdge = std::function<bool(const Vec3& from, const Vec3& to)>;

inline bool none(const Vec3& /*from*/, const Vec3& /*to*/) { return false; }
inline bool is_diagonal(const Vec3& a, const Vec3& b) { return a.x() != b.x() && a.y() != b.y(); }

/// The cells between those edges of a grid that `keep` or `is_feature` accepts. The mesh must
/// outlive them.
PolygonGraph cells_of(const TriMesh& mesh, const KeepEdge& keep, const KeepEdge& is_feature = none);

/// Number of cells by their number of sides.
std::map<std::size_t, int> sides(const PolygonGraph& graph);

std::set<std::pair<double, double>> places(const PolygonGraph& graph, const TriMesh& mesh);

inline double unit_length(Index /*dart*/) { return 1; }

}  // namespace strake
