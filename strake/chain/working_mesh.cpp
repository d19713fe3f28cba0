#include "strake/chain/working_mesh.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "common/core/fields.h"
#include "common/core/number_text.h"
#include "common/core/poly_mesh.h"
#include "common/core/tri_mesh.h"
#include "strake/chain/counted.h"

namespace strake {
namespace {

/// Times as many vertices as the coarser mesh is to have, from which on it is worth making.
constexpr double kMuchFiner = 2;
/// Rounds of fitting to the input: what is left is what the coarser mesh misses.
constexpr int kLastRounds = 2;

}  // namespace

std::optional<Session> on_coarser_mesh(const Session& session, const GoalStages& stages,
                                       std::int64_t vertices, double ratio) {
  const Index own = session.get<TriMesh>("mesh").vertex_count();
  const double wanted = ratio * static_cast<double>(vertices);
  if (!(wanted > 0) || own <= kMuchFiner * wanted || session.has("guides")) return std::nullopt;
  Session coarser = session;
  const Option& coarse = stages.coarsen.option("coarse-vertices");
  coarse.parse_into(std::to_string(std::llround(std::max(wanted, coarse.min))));
  coarser.run(stages.coarsen);
  if (own < kMuchFiner * coarser.get<TriMesh>("coarse").vertex_count()) return std::nullopt;
  coarser.keep(stages.coarsen);
  Stage tensor = stages.tensor;
  tensor.output.name = "coarse-tensor";
  coarser.run(tensor);
  coarser.keep(tensor);
  coarser.use_as("mesh", "coarse");
  coarser.use_as("tensor", "coarse-tensor");
  coarser.withdraw("coarse-tensor");
  Stage smooth = stages.smooth;
  smooth.output.name = "coarse-field";
  coarser.run(smooth, "tensor");
  coarser.keep(smooth);
  coarser.withdraw("tensor");
  coarser.use_as("field", "coarse-field");
  return coarser;
}

void take_from_coarser_mesh(Session& session, Session coarser, const GoalStages& stages) {
  coarser.use_as("coarse-quads", result_port(coarser));
  coarser.take_from(session, {"mesh"});
  session = std::move(coarser);
  for (const char* port : {"lines", "size", "refined", "uncrossed"}) session.withdraw(port);
  session.run(stages.lift);
  session.keep(stages.lift);
  session.use_as("quads", "lifted");
  session.run(stages.prolong);
  session.keep(stages.prolong);
  for (const char* port : {"coarse", "coarse-field", "coarse-quads"}) session.withdraw(port);
  const Option& rounds = stages.fit.option("fit-rounds");
  const OtherValue few(rounds, number_text(std::min<double>(kLastRounds, *rounds.number())));
  session.run(stages.fit);
  session.keep(stages.fit);
}

void estimate_field(Session& session, const GoalStages& stages) {
  session.run(stages.tensor);
  session.keep(stages.tensor);
  session.run(stages.smooth, stages.tensor.output.name);
  session.keep(stages.smooth);
  session.withdraw(stages.tensor.output.name);  // as large as all that is needed afterwards
}

}  // namespace strake
