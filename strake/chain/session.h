#pragma once

#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "common/core/stage_observer.h"
#include "common/stage/report_text.h"
#include "common/stage/stage.h"

namespace strake {

/// Runs stages one after the other in this process and hands values over in memory: a stage's
/// input port takes what the output port of that name gave.
///
/// Values never change once made, so a copy is a cheap snapshot to return to.
class Session {
 public:
  explicit Session(StageObserver& observer) : observer_(&observer) {}

  /// What is kept of a stage that was run.
  struct Kept {
    const Stage& stage;
    const StageRecord& record;
    const Value* output;                           ///< nullptr where the report is the result
    const TriMesh* mesh;                           ///< the output belongs to; nullptr: none
    const std::map<std::string, double>& seconds;  ///< by stage, all its runs together
  };
  /// Writes that somewhere. \return the digest of the output as written; "" where there is none
  using Keeper = std::function<std::string(const Kept&)>;
  /// The digest of a value as it would be written; "" of one that never is.
  /// \param mesh  the mesh it belongs to; nullptr where it is none's, or that is not at hand
  using Digester = std::function<std::string(const Value&, const TriMesh* mesh)>;
  /// What `keep` calls from now on, and what names the inputs of what is kept that are no files;
  /// without, nothing is kept.
  void keep_with(Keeper keeper, Digester digester) {
    keeper_ = std::move(keeper);
    digester_ = std::move(digester);
  }

  [[nodiscard]] bool keeps() const { return keeper_ != nullptr; }

  /// Whom stages report to, and lines for the user go to.
  [[nodiscard]] StageObserver& observer() const { return *observer_; }
  /// \param observer  from now on; kept by reference
  /// From now on, of this session alone. What other sessions say counts as not said to it.
  void report_to(StageObserver& observer) {
    observer_ = &observer;
    warned_of_ = std::make_shared<std::set<std::string>>(*warned_of_);
  }

  /// Provides a value that no stage makes. \param digest  of the file it was read from, or ""
  void provide(const std::string& port, Value value, const std::string& origin,
               const std::string& digest);
  /// Makes what the port `source` holds available as `port` too, in another form.
  void provide_as(const std::string& port, Value value, const std::string& source);

  /// Makes what the port `source` holds what the port `port` holds too.
  void use_as(const std::string& port, const std::string& source) {
    values_[port] = values_.at(source);
  }

  /// Makes the ports hold what they hold in another session.
  void take_from(const Session& other, const std::vector<std::string>& ports) {
    for (const std::string& port : ports) values_[port] = other.values_.at(port);
  }

  /// Takes the last run of a stage over from another session: its output and record, and its time
  /// where it has not run in this one.
  void take_run(const Stage& stage, const Session& other);

  /// Takes back what the port was provided with.
  void withdraw(const std::string& port) { values_.erase(port); }
  [[nodiscard]] bool has(const std::string& port) const {
    const auto entry = values_.find(port);
    return entry != values_.end() && entry->second.value != nullptr;
  }

  /// Runs a stage, stores its output in place of an older one, and says its warnings.
  /// \param last_use_of  a port that holds nothing any more afterwards, so that the stage can use
  ///                     its memory for other things
  /// \return its report
  const Report& run(const Stage& stage, const std::string& last_use_of = "");
  /// From now on warnings of the stage, which is tried many times, are said by `say_held` only.
  void hold_warnings_of(const Stage& stage) { held_.insert(stage.name); }
  /// Says those of the last run of such a stage.
  void say_held(const Stage& stage);
  /// Hands the last output and record of the stage to the keeper, if there is one.
  void keep(const Stage& stage);
  /// A line for the user.
  void say(const std::string& line) { observer_->say(line); }

  [[nodiscard]] const Value& value(const std::string& port) const {
    return *values_.at(port).value;
  }
  template <class T>
  [[nodiscard]] const T& get(const std::string& port) const {
    return std::get<T>(value(port));
  }
  /// Records of the stages run, in order; the last run of each.
  [[nodiscard]] const std::vector<StageRecord>& records() const { return records_; }

 private:
  struct Entry {
    std::shared_ptr<Value> value;  ///< nullptr: it was used up
    std::string origin;
    std::string digest;  ///< of its file, or of what that would be; "" where that is not known
  };

  StageRecord& record_of(const Stage& stage);
  void say_warnings(const std::string& stage, const Report& report);
  /// The mesh that a field or line set belongs to; nullptr where no port holds it.
  [[nodiscard]] const TriMesh* mesh_of(const Value& value) const;
  /// Where stages are kept it is also that of what is no file, which costs one pass over it.
  const std::string& digest_of(Entry& entry) const;
  /// Notes the digests of the inputs.
  void note_inputs(const Stage& stage, Provenance& provenance);

  StageObserver* observer_;
  Keeper keeper_;
  Digester digester_;
  std::map<std::string, Entry> values_;
  std::vector<StageRecord> records_;
  std::map<std::string, double> seconds_;  // by stage, all its runs together
  std::set<std::string> held_;             ///< stages whose warnings are held back
  /// What was said of stages, which run many times: shared by copies, as these are one run.
  std::shared_ptr<std::set<std::string>> warned_of_ = std::make_shared<std::set<std::string>>();
};

}  // namespace strake
