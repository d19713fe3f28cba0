#include "strake/chain/remesh.h"

#include <string_view>

#include "common/core/error.h"
#include "strake/chain/chain.h"

namespace strake {
namespace {

/// Passes everything on, and remembers what was said.
class Listener : public StageObserver {
 public:
  explicit Listener(StageObserver& other) : other_(&other) {}
  void report(std::string_view phase, double fraction) override { other_->report(phase, fraction); }
  void begin(const std::string& stage) override { other_->begin(stage); }
  void say(const std::string& line) override {
    said_.push_back(line);
    other_->say(line);
  }
  std::vector<std::string> take() { return std::move(said_); }

 private:
  StageObserver* other_;
  std::vector<std::string> said_;
};

class Silence : public StageObserver {
 public:
  void report(std::string_view /*phase*/, double /*fraction*/) override {}
};

/// Gives the stages of the chain the values of `options`, whose ranges are checked by that.
void set_options(Chain& chain, const RemeshOptions& options) {
  RemeshOptions values = options;
  const OptionList declared = values.declare();
  OptionList targets = chain.declare();
  for (const Stage* stage : chain.stages()) {
    targets.insert(targets.end(), stage->options.begin(), stage->options.end());
  }
  for (const Option& target : targets) {
    for (const Option& option : declared) {
      if (option.name == target.name) target.parse_into(option.value());
    }
  }
}

void provide(Session& session, RemeshInput input) {
  if (!input.density.empty()) {
    if (input.density.size() != input.mesh.positions.size()) {
      throw InputError("there are " + std::to_string(input.density.size()) + " densities for " +
                       std::to_string(input.mesh.positions.size()) +
                       " vertices; give one for each vertex");
    }
    session.provide("density", DensityField{"", std::move(input.density)}, "density", "");
  }
  if (!input.feature_edges.edges.empty()) {
    session.provide("feature-edges", std::move(input.feature_edges), "feature edges", "");
  }
  if (!input.guides.lines.empty()) {
    session.provide("guides", std::move(input.guides), "guides", "");
  }
  session.provide("input", Polygons{std::move(input.mesh), "", {}}, "input", "");
}

}  // namespace

OptionList RemeshOptions::declare() {
  OptionList all = {};
  const auto add = [&](const OptionList& list) { all.insert(all.end(), list.begin(), list.end()); };
  add(import.declare());
  add(tensor.declare());
  add(smooth.declare());
  add(coarsen.declare());
  add(trace.declare());
  add(mesh.declare());
  add(fit.declare());
  add(size.declare());
  add(refine.declare());
  add(worst.declare());
  add(decimate.declare());
  add(evaluate.declare());
  add(Chain::declare(feedback_rounds, lines_only, working_ratio));
  return all;
}

RemeshResult remesh(RemeshInput input, const RemeshOptions& options, StageObserver& observer) {
  Chain chain;
  set_options(chain, options);
  chain.check_goals();
  Listener listener(observer);
  Session session(listener);
  provide(session, std::move(input));
  const std::string port = chain.run(session);
  if (options.measure) chain.measure(session, port);
  RemeshResult result{session.get<QuadMesh>(port),
                      session.get<TriMesh>("mesh"),
                      session.get<PrincipalField>("field"),
                      {},
                      listener.take()};
  for (const StageRecord& record : session.records()) {
    result.reports.emplace_back(record.provenance.stage, record.report);
  }
  return result;
}

RemeshResult remesh(RemeshInput input, const RemeshOptions& options) {
  Silence observer;
  return remesh(std::move(input), options, observer);
}

}  // namespace strake
