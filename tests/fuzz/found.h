#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>

/// Ends the program, so that libFuzzer keeps the input that led here.
[[noreturn]] inline void found(const std::string& what) {
  std::fprintf(stderr, "found: %s\n", what.c_str());
  std::abort();
}
