#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "common/core/observer.h"
#include "common/core/poly_mesh.h"
#include "strake/chain/remesh.h"

namespace strake {

/// A unit sphere with a ring of claws around its pole, closer together than wanted cells are wide.
/// \param apart  angle of the claws from the pole
/// \param width  angle at which a claw has 1/e of its height
PolyMesh claws(int count, double apart, double width, double height, std::int64_t faces);

/// Pairs of faces that cross.
std::size_t crossings(const PolyMesh& mesh);

/// As measured of a result; not a number where it was not.
double largest_distance(const RemeshResult& result);

/// A number of the reports of the stages; a failure of the test where there is none.
double measure_of(const RemeshResult& result, const std::string& key);

/// Keeps what is said.
class Listener : public StageObserver {
 public:
  void report(std::string_view /*phase*/, double /*fraction*/) override {}
  void say(const std::string& line) override { said += line + '\n'; }
  std::string said;
};

}  // namespace strake
