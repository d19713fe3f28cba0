#pragma once

#include <filesystem>

#include "tests/support/needs.h"

namespace strake::support {

/// The folder of test models: $STRAKE_MODELS, else ../shared/models beside the source tree. Empty
/// where there is none.
std::filesystem::path models_folder();

}  // namespace strake::support

/// Defines `folder` as the folder of models; a test needs it.
#define STRAKE_MODELS_OR_SKIP(folder)                                              \
  const std::filesystem::path folder = ::strake::support::models_folder();         \
  STRAKE_NEEDS(!folder.empty(), "test models: set STRAKE_MODELS to their folder"); \
  static_assert(true, "ask for a semicolon")
