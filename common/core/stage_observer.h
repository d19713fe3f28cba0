#pragma once

#include <string>

#include "common/core/observer.h"

namespace strake {

/// An observer of several stages that run one after the other.
class StageObserver : public Observer {
 public:
  /// The next phases belong to this stage.
  virtual void begin(const std::string& /*stage*/) {}
  /// A line for the user: a warning, or how near a goal is.
  virtual void say(const std::string& /*line*/) {}
};

}  // namespace strake
