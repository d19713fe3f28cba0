#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "common/stage/console.h"
#include "common/stage/report_text.h"
#include "common/stage/stage.h"

namespace strake {

/// Runs stages one after the other in this process and hands values over in memory: a stage's
/// input port takes what the output port of that name gave.
///
/// Values never change once made, so a copy is a cheap snapshot to return to.
class Session {
 public:
  explicit Session(ConsoleObserver& console) : console_(&console) {}

  /// Where to keep each output as the file "port.hdf", and reports as "stage.json".
  /// \throw InputError where the folder cannot be made
  void keep_in(const std::filesystem::path& folder);

  /// Provides a value that no stage makes. \param digest  of the file it was read from
  void provide(const std::string& port, Value value, const std::string& origin,
               const std::string& digest);
  /// Makes what the port `source` holds available as `port` too, in another form.
  void provide_as(const std::string& port, Value value, const std::string& source);

  /// Takes back what the port was provided with.
  void withdraw(const std::string& port) { values_.erase(port); }
  [[nodiscard]] bool has(const std::string& port) const { return values_.count(port) != 0; }

  /// Runs a stage, stores its output in place of an older one, and says its warnings.
  /// \return its report
  const Report& run(const Stage& stage);
  /// Writes the last output and report of the stage to the folder to keep, if there is one, and the
  /// times of all stages to its times.json: reports and artifacts hold none, for equal work to give
  /// equal bytes.
  void keep(const Stage& stage);

  template <class T>
  [[nodiscard]] const T& get(const std::string& port) const {
    return std::get<T>(*values_.at(port).value);
  }
  /// Records of the stages run, in order; the last run of each.
  [[nodiscard]] const std::vector<StageRecord>& records() const { return records_; }

 private:
  struct Entry {
    std::shared_ptr<const Value> value;
    std::string origin;
    std::string digest;  ///< of its file; "" where there is none
  };

  StageRecord& record_of(const Stage& stage);
  /// Notes the digests of those inputs that are files.
  void note_inputs(const Stage& stage, Provenance& provenance) const;

  ConsoleObserver* console_;
  std::filesystem::path folder_;
  std::map<std::string, Entry> values_;
  std::vector<StageRecord> records_;
  std::map<std::string, double> seconds_;  // by stage, all its runs together
};

}  // namespace strake
