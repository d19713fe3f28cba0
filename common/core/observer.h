#pragma once

#include <string_view>

namespace strake {

/// How an algorithm tells its caller how far it is, and learns that it should stop.
///
/// Algorithms never print. They call `report` from one thread at a time, at least once a second
/// where that is possible; an implementation throws Interrupted from it to cancel the run.
class Observer {
 public:
  virtual ~Observer() = default;
  /// \param phase     what is being done, a few words
  /// \param fraction  share of the phase that is done, in [0, 1]
  virtual void report(std::string_view phase, double fraction) = 0;
};

/// An observer that ignores everything; the default for library users.
class SilentObserver : public Observer {
 public:
  void report(std::string_view /*phase*/, double /*fraction*/) override {}
};

}  // namespace strake
