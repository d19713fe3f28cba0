#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "common/geometry/cell_error/cell_error.h"
#include "strake/report/result_edges.h"

namespace strake::report {

/// How values spread over bins that are the same in every report, so that runs can be compared.
struct Histogram {
  std::string name;            ///< "valence", "angles", "edge_lengths", "alignment", "distance"
  std::vector<double> bounds;  ///< [bins + 1] ascending; values beyond an end count in the last bin
  std::vector<double>
      shares;  ///< [bins] of the weight of all values; all zero where there are none

  Histogram(std::string title, std::vector<double> ascending_bounds);
  void add(double value, double weight = 1);
  /// Divides by the weight of all values; once, after the last one.
  void finish();

 private:
  double weight_ = 0;
};

/// The histograms of a result:
/// - "valence": edges at inner vertices, 2 to 8
/// - "angles": corners of all faces, degrees; above 180 where a corner is reflex
/// - "edge_lengths": shares of the diagonal, bins of half an octave
/// - "alignment": angle of edges to the principal directions, degrees, by length; only with a field
/// - "distance": largest distance of each face to the surface, shares of the diagonal
/// \param diagonal  of the input
std::vector<Histogram> measure_histograms(const ResultEdges& result, const ErrorMap& errors,
                                          double diagonal);

nlohmann::ordered_json to_json(const std::vector<Histogram>& histograms);

}  // namespace strake::report
