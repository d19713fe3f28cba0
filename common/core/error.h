#pragma once

#include <stdexcept>
#include <string>

namespace strake {

/// What a program returns to its caller; part of the public interface.
enum class ExitCode : int {
  ok = 0,
  internal = 1,
  usage = 2,
  bad_input = 3,
  precondition = 4,
  algorithm_failed = 5,
  tolerance_missed = 6,
  interrupted = 130,
};

/// Base of all errors. The message names the file or element at fault and a remedy.
class Error : public std::runtime_error {
 public:
  Error(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  [[nodiscard]] ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

/// An option is unknown, malformed or out of range.
class UsageError : public Error {
 public:
  explicit UsageError(const std::string& message) : Error(ExitCode::usage, message) {}
};

/// A file cannot be read or written, is damaged, or holds nothing usable.
class InputError : public Error {
 public:
  explicit InputError(const std::string& message) : Error(ExitCode::bad_input, message) {}
};

/// Inputs are each sound but cannot be used together, or not for this purpose.
class PreconditionError : public Error {
 public:
  explicit PreconditionError(const std::string& message) : Error(ExitCode::precondition, message) {}
};

/// A result failed its own check, so it is not handed out.
class AlgorithmError : public Error {
 public:
  explicit AlgorithmError(const std::string& message)
      : Error(ExitCode::algorithm_failed, message) {}
};

/// The user asked to stop (SIGINT, SIGTERM).
class Interrupted : public Error {
 public:
  Interrupted() : Error(ExitCode::interrupted, "interrupted") {}
};

}  // namespace strake
