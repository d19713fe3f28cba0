#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

/// Figures of a list of values; 0 for an empty one. Sums run in order, so they repeat exactly.
namespace strake::evaluation {

inline double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

inline double rms(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v * v;
  return values.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(values.size()));
}

inline double largest(const std::vector<double>& values) {
  return values.empty() ? 0.0 : *std::max_element(values.begin(), values.end());
}

inline double smallest(const std::vector<double>& values) {
  return values.empty() ? 0.0 : *std::min_element(values.begin(), values.end());
}

/// The value that a share `q` of the values do not exceed (nearest rank).
inline double quantile(std::vector<double> values, double q) {
  if (values.empty()) return 0;
  const double last = static_cast<double>(values.size() - 1);
  const auto rank = values.begin() + static_cast<std::ptrdiff_t>(std::lround(q * last));
  std::nth_element(values.begin(), rank, values.end());
  return *rank;
}

/// `part / whole`, 0 where there is no whole.
inline double share(double part, double whole) { return whole > 0 ? part / whole : 0.0; }

}  // namespace strake::evaluation
