#pragma once

#include <OpenMesh/Core/System/omstream.hh>

namespace strake {

/// While it lives OpenMesh does not write to the error stream of the process what faces it refuses:
/// whoever adds them looks whether they are valid.
class OpenMeshSilence {
 public:
  OpenMeshSilence() : was_enabled_(omerr().is_enabled()) { omerr().disable(); }
  OpenMeshSilence(const OpenMeshSilence&) = delete;
  OpenMeshSilence& operator=(const OpenMeshSilence&) = delete;
  ~OpenMeshSilence() {
    if (was_enabled_) omerr().enable();
  }

 private:
  bool was_enabled_;
};

}  // namespace strake
