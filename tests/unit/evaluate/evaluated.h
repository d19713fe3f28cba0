#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "stages/evaluate/evaluate.h"
#include "tests/support/mesh_support.h"

namespace strake {

inline Report evaluated(const TriMesh& reference, const PolyMesh& candidate,
                        const PrincipalField* field = nullptr, std::int64_t samples = 20000) {
  EvaluateOptions options;
  options.samples = samples;
  SilentObserver observer;
  return evaluate_mesh(reference, field, candidate, options, observer).report;
}

/// An entry of a report, which it must have.
inline double number(const Report& report, const std::string& key) {
  if (const auto value = report.number(key)) return *value;
  ADD_FAILURE() << "no entry " << key;
  return std::nan("");
}

inline bool has(const Report& report, const std::string& key) {
  return std::any_of(report.entries().begin(), report.entries().end(),
                     [&](const auto& entry) { return entry.first == key; });
}

}  // namespace strake
