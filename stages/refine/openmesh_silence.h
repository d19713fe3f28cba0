#pragma once

#include <OpenMesh/Core/System/omstream.hh>
#include <mutex>

namespace strake {

/// While one lives, in any thread, OpenMesh does not write to the error stream of the process what
/// faces it refuses: whoever adds them looks whether they are valid.
class OpenMeshSilence {
 public:
  OpenMeshSilence() {
    const std::lock_guard lock(mutex);
    if (living++ > 0) return;
    was_enabled = omerr().is_enabled();
    omerr().disable();
  }
  OpenMeshSilence(const OpenMeshSilence&) = delete;
  OpenMeshSilence& operator=(const OpenMeshSilence&) = delete;
  ~OpenMeshSilence() {
    const std::lock_guard lock(mutex);
    if (--living == 0 && was_enabled) omerr().enable();
  }

 private:
  static inline std::mutex mutex;
  static inline int living = 0;
  static inline bool was_enabled = false;  ///< before the first of those that live
};

}  // namespace strake
