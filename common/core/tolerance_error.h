#pragma once

#include <string>
#include <utility>
#include <vector>

#include "common/core/error.h"
#include "common/core/types.h"

namespace strake {

/// A result is farther from its surface than was asked for, so it is not handed out.
class ToleranceError : public Error {
 public:
  ToleranceError(const std::string& message, std::vector<Vec3> places)
      : Error(ExitCode::tolerance_missed, message), places_(std::move(places)) {}
  /// Where, relative to the mesh's origin, model units.
  [[nodiscard]] const std::vector<Vec3>& places() const { return places_; }

 private:
  std::vector<Vec3> places_;
};

}  // namespace strake
