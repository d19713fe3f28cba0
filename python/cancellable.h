#pragma once

#include <pybind11/pybind11.h>

#include <cstdint>
#include <functional>

#include "common/core/stage_observer.h"

namespace strake::python {

/// Runs `work` in a thread of its own while this one, without the interpreter's lock, looks after
/// signals: Ctrl-C cancels the work and becomes KeyboardInterrupt.
/// \param threads   that the work may use; 0: all processors
/// \param progress  None, or called as progress(stage, phase, fraction) some times a second; what
///                  it raises cancels the work too
void run_cancellable(std::int64_t threads, const pybind11::object& progress,
                     const std::function<void(StageObserver&)>& work);

/// For the end of the interpreter: cancels what other threads are at, and waits, but not for ever,
/// until each of them is back in Python, where it gets SystemExit. A thread that wanted the
/// interpreter's lock later would be ended by Python amid its C++, and abort the process.
void end_all();

}  // namespace strake::python
