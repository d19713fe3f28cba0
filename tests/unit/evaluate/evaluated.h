#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <variant>

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
  for (const auto& [name, value] : report.entries()) {
    if (name != key) continue;
    if (const auto* real = std::get_if<double>(&value)) return *real;
    if (const auto* integer = std::get_if<std::int64_t>(&value)) {
      return static_cast<double>(*integer);
    }
    return std::get<bool>(value) ? 1 : 0;
  }
  ADD_FAILURE() << "no entry " << key;
  return std::nan("");
}

inline bool has(const Report& report, const std::string& key) {
  return std::any_of(report.entries().begin(), report.entries().end(),
                     [&](const auto& entry) { return entry.first == key; });
}

}  // namespace strake
