#include "strake/report/histograms.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <utility>

#include "common/geometry/poly_topology/face_shape.h"

namespace strake::report {
namespace {

std::vector<double> even_bounds(double low, double step, int bins) {
  std::vector<double> bounds;
  for (int i = 0; i <= bins; ++i) bounds.push_back(low + i * step);
  return bounds;
}

/// Bounds whose logarithms to `base` are even, and end at 1.
std::vector<double> even_ratios(double base, int per_base, int bins) {
  std::vector<double> bounds;
  for (int i = bins; i >= 0; --i)
    bounds.push_back(std::pow(base, -static_cast<double>(i) / per_base));
  return bounds;
}

Histogram valences(const PolyMesh& mesh, const PolyEdges& edges) {
  Histogram histogram("valence", even_bounds(1.5, 1, 7));
  std::vector<int> valence(mesh.positions.size(), 0);
  std::vector<std::uint8_t> is_inner(mesh.positions.size(), 1);
  for (Index e = 0; e < edges.edge_count(); ++e) {
    for (const Index v : edges.vertices[e]) {
      ++valence[v];
      if (edges.sides_of(e).size() != 2) is_inner[v] = 0;
    }
  }
  for (std::size_t v = 0; v < valence.size(); ++v) {
    if (is_inner[v] != 0 && valence[v] > 0) histogram.add(valence[v]);
  }
  return histogram;
}

Histogram angles(const PolyMesh& mesh) {
  Histogram histogram("angles", even_bounds(0, 5, 48));
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(f);
    const Vec3 normal = newell_normal(mesh.positions, face);
    for (std::size_t i = 0; i < face.size(); ++i) {
      const Vec3& p = mesh.positions[face[i]];
      const Vec3 out = mesh.positions[face[(i + 1) % face.size()]] - p;
      const Vec3 back = mesh.positions[face[(i + face.size() - 1) % face.size()]] - p;
      const Vec3 turn = out.cross(back);
      const double angle = std::atan2(turn.norm(), out.dot(back)) * 180 / std::numbers::pi;
      histogram.add(turn.dot(normal) < 0 ? 360 - angle : angle);
    }
  }
  return histogram;
}

Histogram edge_lengths(const PolyMesh& mesh, const PolyEdges& edges, double diagonal) {
  Histogram histogram("edge_lengths", even_ratios(2, 2, 32));
  for (const auto& [a, b] : edges.vertices) {
    histogram.add((mesh.positions[b] - mesh.positions[a]).norm() / diagonal);
  }
  return histogram;
}

Histogram alignment(const std::vector<evaluation::EdgeAngles>& angles) {
  Histogram histogram("alignment", even_bounds(0, 2.5, 18));
  for (const auto& edge : angles) {
    if (edge.principal_deg >= 0) histogram.add(edge.principal_deg, edge.length);
  }
  return histogram;
}

Histogram distances(const ErrorMap& errors, double diagonal) {
  Histogram histogram("distance", even_ratios(10, 4, 28));
  for (const CellError& cell : errors.cells) histogram.add(cell.largest / diagonal);
  return histogram;
}

}  // namespace

Histogram::Histogram(std::string title, std::vector<double> ascending_bounds)
    : name(std::move(title)), bounds(std::move(ascending_bounds)), shares(bounds.size() - 1, 0.0) {}

void Histogram::add(double value, double weight) {
  const auto above = std::upper_bound(bounds.begin() + 1, bounds.end() - 1, value);
  shares[above - bounds.begin() - 1] += weight;
  weight_ += weight;
}

void Histogram::finish() {
  if (!(weight_ > 0)) return;
  for (double& share : shares) share /= weight_;
}

std::vector<Histogram> measure_histograms(const ResultEdges& result, const ErrorMap& errors,
                                          double diagonal) {
  std::vector<Histogram> histograms = {valences(result.mesh, result.edges), angles(result.mesh),
                                       edge_lengths(result.mesh, result.edges, diagonal)};
  if (!result.angles.empty()) histograms.push_back(alignment(result.angles));
  histograms.push_back(distances(errors, diagonal));
  for (Histogram& histogram : histograms) histogram.finish();
  return histograms;
}

nlohmann::ordered_json to_json(const std::vector<Histogram>& histograms) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const Histogram& histogram : histograms) {
    json[histogram.name] = {{"bounds", histogram.bounds}, {"shares", histogram.shares}};
  }
  return json;
}

}  // namespace strake::report
