#include "tests/unit/chain/results.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>

#include "common/geometry/face_crossings/face_crossings.h"
#include "common/geometry/poly_topology/face_shape.h"
#include "common/geometry/samples/samples.h"

namespace strake {

PolyMesh claws(int count, double apart, double width, double height, std::int64_t faces) {
  SampleOptions options;
  options.faces = faces;
  PolyMesh mesh = make_sample(SampleKind::sphere, options);
  for (Vec3& p : mesh.positions) {
    const Vec3 direction = p.normalized();
    double radius = 1;
    for (int i = 0; i < count; ++i) {
      const double turn = 2 * M_PI * i / count;
      const Vec3 tip(std::sin(apart) * std::cos(turn), std::sin(apart) * std::sin(turn),
                     std::cos(apart));
      const double angle = std::acos(std::clamp(direction.dot(tip), -1.0, 1.0)) / width;
      radius += height * std::exp(-angle * angle);
    }
    p = radius * direction;
  }
  return mesh;
}

std::size_t crossings(const PolyMesh& mesh) {
  return find_crossing_faces(mesh.positions, triangulate_faces(mesh)).size();
}

double largest_distance(const RemeshResult& result) {
  for (const auto& [stage, report] : result.reports) {
    for (const auto& [name, value] : report.entries()) {
      if (name == "distance.max") return std::get<double>(value);
    }
  }
  return std::nan("");
}

double measure_of(const RemeshResult& result, const std::string& key) {
  for (const auto& [stage, report] : result.reports) {
    for (const auto& [name, value] : report.entries()) {
      if (name != key) continue;
      const auto* number = std::get_if<double>(&value);
      return number != nullptr ? *number : static_cast<double>(std::get<std::int64_t>(value));
    }
  }
  ADD_FAILURE() << "no " << key;
  return 0;
}

}  // namespace strake
