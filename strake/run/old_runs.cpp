#include "strake/run/old_runs.h"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include "common/artifact/store/folder_lock.h"
#include "common/core/error.h"
#include "strake/run/run_folder.h"

namespace strake {
namespace {

namespace fs = std::filesystem;
using FileClock = fs::file_time_type::clock;

/// A record and when something was last written down in it.
struct RunRecord {
  fs::file_time_type written;
  fs::path folder;
};

std::vector<RunRecord> records_of(const Store& store) {
  std::vector<RunRecord> records;
  std::error_code ignored;
  for (const auto& folder : fs::directory_iterator(store.side_folder("runs"), ignored)) {
    std::error_code error;
    fs::file_time_type written = fs::last_write_time(folder.path() / "outcomes", error);
    if (error) written = fs::last_write_time(folder.path(), error);  // it is being made just now
    if (!error) records.push_back({written, folder.path()});
  }
  return records;
}

/// Whether a process of this machine, or of another one that shares the locks, is at it.
bool is_locked(const fs::path& run) {
  try {
    return !FolderLock(run).is_held();
  } catch (const InputError&) {
    return true;  // it is not for us to write there
  }
}

bool may_go_on(const RunRecord& record) {
  const auto age = FileClock::now() - record.written;
  if (age <= kFreshRun || is_locked(record.folder)) return true;
  const RunFolder run(record.folder);
  return !run.is_local() && !run.has_ended() && age <= kLongestQueue;
}

}  // namespace

void remove_old_runs(const Store& store, std::optional<std::chrono::hours> from) {
  std::vector<RunRecord> records = records_of(store);
  std::sort(records.begin(), records.end(),
            [](const RunRecord& a, const RunRecord& b) { return a.written > b.written; });
  const auto now = FileClock::now();
  std::error_code ignored;
  for (std::size_t r = 0; r < records.size(); ++r) {
    const bool is_old = r >= kKeptRuns || (from && now - records[r].written >= *from);
    if (is_old && !may_go_on(records[r])) fs::remove_all(records[r].folder, ignored);
  }
}

}  // namespace strake
