#include "strake/run/memory_gate.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>
#include <vector>

#include "common/artifact/store/file_lock.h"
#include "common/core/error.h"

namespace strake {
namespace {

constexpr std::int64_t kUnit = 16 << 20;  ///< bytes of memory per locked byte of the file
constexpr std::int64_t kMostUnits = 1 << 20;
constexpr off_t kGate = 0;  ///< the byte that whoever is next in line holds
constexpr std::chrono::milliseconds kPause{50};

std::int64_t units(std::int64_t bytes) { return (bytes + kUnit - 1) / kUnit; }

}  // namespace

MemoryShare::MemoryShare(const std::filesystem::path& file)
    : descriptor_(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666)) {
  if (descriptor_ < 0) {
    throw InputError(fmt::format("cannot use '{}': {}", file.string(), std::strerror(errno)));
  }
}

// The constructor above has made the object, so what `idle` throws closes the file and its locks.
MemoryShare::MemoryShare(const std::filesystem::path& file, std::int64_t total, std::int64_t share,
                         const std::function<void()>& idle)
    : MemoryShare(file) {
  const std::int64_t available = std::clamp<std::int64_t>(units(total), 1, kMostUnits);
  std::int64_t missing = std::clamp<std::int64_t>(units(share), 1, available);
  const auto pause = [&] {
    idle();
    std::this_thread::sleep_for(kPause);
  };
  for (LockOutcome gate; (gate = try_lock(descriptor_, kGate, 1)) != LockOutcome::taken; pause()) {
    if (gate == LockOutcome::unsupported) return;
  }
  // Units that are free are kept while waiting for the rest; nobody else takes any meanwhile.
  std::vector<bool> mine(static_cast<std::size_t>(available), false);
  for (;;) {
    for (std::int64_t i = 0; i < available && missing > 0; ++i) {
      if (mine[static_cast<std::size_t>(i)] ||
          try_lock(descriptor_, kGate + 1 + i, 1) != LockOutcome::taken) {
        continue;
      }
      mine[static_cast<std::size_t>(i)] = true;
      --missing;
    }
    if (missing == 0) break;
    pause();
  }
  unlock(descriptor_, kGate, 1);
}

MemoryShare::~MemoryShare() { ::close(descriptor_); }

}  // namespace strake
