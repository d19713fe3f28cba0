#pragma once

#include <gtest/gtest.h>

#include <filesystem>

namespace strake::support {

/// The folder of test models: $STRAKE_MODELS, else ../shared/models beside the source tree. Empty
/// where there is none.
std::filesystem::path models_folder();

/// Whether environment variable CI is set: then missing models are a failure.
bool runs_in_ci();

}  // namespace strake::support

/// Defines `folder` as the folder of models; where it is missing, fails in CI and skips elsewhere.
#define STRAKE_MODELS_OR_SKIP(folder)                                                   \
  const std::filesystem::path folder = ::strake::support::models_folder();              \
  if (folder.empty() && ::strake::support::runs_in_ci()) {                              \
    FAIL() << "there are no test models: set STRAKE_MODELS to their folder";            \
  }                                                                                     \
  if (folder.empty()) {                                                                 \
    GTEST_SKIP() << "there are no test models here: set STRAKE_MODELS to their folder"; \
  }                                                                                     \
  static_assert(true, "ask for a semicolon")
