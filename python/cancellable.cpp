#include "python/cancellable.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <tuple>

#include "common/core/error.h"

namespace strake::python {
namespace {

namespace py = pybind11;

constexpr std::chrono::milliseconds kPause{50};

/// Holds what was reported last until the other thread asks for it.
class WatchedObserver : public StageObserver {
 public:
  using State = std::tuple<std::string, std::string, double>;  ///< stage, phase, fraction

  void begin(const std::string& stage) override {
    const std::lock_guard lock(mutex_);
    std::get<0>(state_) = stage;
  }
  void report(std::string_view phase, double fraction) override {
    if (cancelled_) throw Interrupted();
    const std::lock_guard lock(mutex_);
    std::get<1>(state_) = phase;
    std::get<2>(state_) = fraction;
  }
  void cancel() { cancelled_ = true; }
  State state() {
    const std::lock_guard lock(mutex_);
    return state_;
  }

 private:
  std::atomic<bool> cancelled_ = false;
  std::mutex mutex_;
  State state_;
};

/// Whether something has ended, and waiting for that.
class Finish {
 public:
  void announce() {
    const std::lock_guard lock(mutex_);
    done_ = true;
    changed_.notify_all();
  }
  bool wait_for(std::chrono::milliseconds time) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, time, [&] { return done_; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool done_ = false;
};

/// What is under way in all threads. Touched under the interpreter's lock only.
struct Runs {
  std::map<WatchedObserver*, pid_t> observers;  ///< and the process, as a fork copies this
  std::optional<std::thread::id> ending;  ///< the thread that ends the interpreter, once it does
};

Runs& runs() {
  static Runs all;
  return all;
}

/// Lists a run while it is under way. \pre made and destroyed under the interpreter's lock
class Listed {
 public:
  explicit Listed(WatchedObserver& observer) : observer_(&observer) {
    runs().observers.emplace(observer_, ::getpid());
  }
  Listed(const Listed&) = delete;
  Listed& operator=(const Listed&) = delete;
  ~Listed() { runs().observers.erase(observer_); }

 private:
  WatchedObserver* observer_;
};

/// Ends this thread, silently, where another one is about to end the interpreter.
void leave_if_ending() {
  if (!runs().ending || *runs().ending == std::this_thread::get_id()) return;
  PyErr_SetNone(PyExc_SystemExit);
  throw py::error_already_set();
}

/// Lets Python handle its signals and tells it the progress. \throw what either raises
void look_after(const py::object& progress, WatchedObserver& observer) {
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  if (progress.is_none()) return;
  const auto [stage, phase, fraction] = observer.state();
  if (!phase.empty()) progress(stage, phase, fraction);
}

}  // namespace

void run_cancellable(std::int64_t threads, const py::object& progress,
                     const std::function<void(StageObserver&)>& work) {
  leave_if_ending();
  WatchedObserver observer;
  const Listed listed(observer);
  Finish finish;
  std::exception_ptr failure;
  std::exception_ptr raised;
  std::thread worker([&] {
    try {
      const auto limit = threads > 0 ? static_cast<std::size_t>(threads)
                                     : static_cast<std::size_t>(tbb::info::default_concurrency());
      const tbb::global_control control(tbb::global_control::max_allowed_parallelism, limit);
      work(observer);
    } catch (...) {
      failure = std::current_exception();
    }
    finish.announce();
  });
  {
    const py::gil_scoped_release unlocked;
    while (!finish.wait_for(kPause)) {
      const py::gil_scoped_acquire locked;
      if (raised) continue;
      try {
        look_after(progress, observer);
      } catch (...) {
        raised = std::current_exception();
        observer.cancel();
      }
    }
    worker.join();
  }
  if (raised) std::rethrow_exception(raised);
  leave_if_ending();
  if (failure) std::rethrow_exception(failure);
}

void end_all() {
  runs().ending = std::this_thread::get_id();
  std::erase_if(runs().observers, [](const auto& run) { return run.second != ::getpid(); });
  // Work ends within a second, but a progress function may wait for what is no more.
  const auto last = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  while (!runs().observers.empty() && std::chrono::steady_clock::now() < last) {
    for (const auto& [observer, process] : runs().observers) observer->cancel();
    const py::gil_scoped_release unlocked;
    std::this_thread::sleep_for(kPause);
  }
}

}  // namespace strake::python
