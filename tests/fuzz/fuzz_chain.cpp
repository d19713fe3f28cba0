// Small surfaces with every defect, through the whole chain in memory: an oriented manifold, or a
// refusal; in time.

#include <fuzzer/FuzzedDataProvider.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/error.h"
#include "common/core/options.h"
#include "common/core/tolerance_error.h"
#include "common/geometry/poly_topology/poly_topology.h"
#include "strake/chain/remesh.h"
#include "tests/fuzz/found.h"

namespace {

using strake::Index;
using strake::PolyMesh;
using strake::Vec3;

/// Of one processor, slowed down up to eightyfold by sanitizers and counters: seconds as a rule.
/// Lines in faces that are hundreds of their distances long have taken 280, and 4 without both.
constexpr double kMostSeconds = 400;

/// Whoever takes too long has hung.
class Watchdog : public strake::StageObserver {
 public:
  void report(std::string_view phase, double /*fraction*/) override {
    if (static_cast<double>(std::clock() - begin_) > kMostSeconds * CLOCKS_PER_SEC) {
      found("takes too long: " + std::string(phase));
    }
  }

 private:
  std::clock_t begin_ = std::clock();
};

/// A sheet, tube, ring or twisted band, as a grid of quads.
PolyMesh make_grid(FuzzedDataProvider& data) {
  const Index columns = data.ConsumeIntegralInRange(1, 8);
  const Index rows = data.ConsumeIntegralInRange(1, 8);
  const bool around = data.ConsumeBool();
  const bool along = data.ConsumeBool();
  const bool twist = data.ConsumeBool();
  const double bend = data.ConsumeIntegralInRange(0, 6) / 6.0;
  const double height = std::pow(10.0, data.ConsumeIntegralInRange(-6, 2));
  PolyMesh mesh;
  for (Index r = 0; r <= rows; ++r) {
    for (Index c = 0; c <= columns; ++c) {
      const double u = 2 * M_PI * bend * c / columns;
      const double v = 2 * M_PI * bend * r / rows;
      mesh.positions.emplace_back((2 + std::cos(v)) * std::cos(u) + c * (1 - bend),
                                  (2 + std::cos(v)) * std::sin(u) + r * (1 - bend),
                                  height * std::sin(v));
    }
  }
  const auto vertex = [&](Index c, Index r) {
    if (around && c == columns) {
      c = 0;
      if (twist) r = rows - r;
    }
    if (along && r == rows) r = 0;
    return r * (columns + 1) + c;
  };
  for (Index r = 0; r < rows; ++r) {
    for (Index c = 0; c < columns; ++c) {
      mesh.add_face(std::array<Index, 4>{vertex(c, r), vertex(c + 1, r), vertex(c + 1, r + 1),
                                         vertex(c, r + 1)});
    }
  }
  return mesh;
}

/// Points of a small lattice, so that many are equal, in line or in a plane.
PolyMesh make_points(FuzzedDataProvider& data) {
  PolyMesh mesh;
  const auto coordinate = [&] { return data.ConsumeIntegralInRange(0, 3) / 3.0; };
  for (Index n = data.ConsumeIntegralInRange(3, 24); n > 0; --n) {
    const double x = coordinate();
    const double y = coordinate();
    mesh.positions.emplace_back(x, y, coordinate());
  }
  return mesh;
}

void add_random_faces(FuzzedDataProvider& data, PolyMesh& mesh) {
  for (int n = data.ConsumeIntegralInRange(0, 16); n > 0; --n) {
    std::vector<Index> corners(data.PickValueInArray<std::size_t>({3, 3, 3, 4, 5, 9}));
    for (Index& v : corners) v = data.ConsumeIntegralInRange<Index>(0, mesh.vertex_count() - 1);
    mesh.add_face(corners);
  }
}

/// Noise of all sizes on some points, pressed flat or far away as a whole.
void disturb(FuzzedDataProvider& data, PolyMesh& mesh) {
  for (int n = data.ConsumeIntegralInRange(0, 30); n > 0; --n) {
    Vec3& p =
        mesh.positions[data.ConsumeIntegralInRange<std::size_t>(0, mesh.positions.size() - 1)];
    const double size = std::pow(10.0, data.ConsumeIntegralInRange(-16, 1));
    p[data.ConsumeIntegralInRange(0, 2)] += size * data.ConsumeIntegralInRange(-4, 4);
  }
  const double scale = std::pow(10.0, data.ConsumeIntegralInRange(-9, 9));
  const double shift = data.ConsumeBool() ? std::pow(10.0, data.ConsumeIntegralInRange(-3, 12)) : 0;
  const int pressed = data.ConsumeIntegralInRange(0, 5);
  for (Vec3& p : mesh.positions) {
    if (pressed < 3) p[pressed] *= 1e-7;
    p = scale * (p + Vec3::Constant(shift));
  }
}

strake::RemeshOptions make_options(FuzzedDataProvider& data) {
  strake::RemeshOptions options;
  switch (data.ConsumeIntegralInRange(0, 3)) {
    case 0:
      options.trace.vertices = data.ConsumeIntegralInRange(10, 120);
      break;
    case 1:
      options.trace.tolerance = strake::Length{0.01, true};
      break;
    default:  // so that most time goes into other shapes instead of finer meshes
      options.trace.tolerance = std::nullopt;
      options.trace.max_spacing = strake::Length{0.2, true};
  }
  options.import.feature_angle_deg = data.PickValueInArray({10.0, 40.0, 180.0});
  options.evaluate.samples = 1000;
  options.mesh.pure_quads = data.ConsumeIntegralInRange(0, 7) == 0;
  return options;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  static const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  FuzzedDataProvider data(bytes, size);
  const strake::RemeshOptions options = make_options(data);
  strake::RemeshInput input;
  input.mesh = data.ConsumeIntegralInRange(0, 2) == 0 ? make_points(data) : make_grid(data);
  add_random_faces(data, input.mesh);
  disturb(data, input.mesh);
  Watchdog watchdog;
  try {
    const strake::RemeshResult result = strake::remesh(std::move(input), options, watchdog);
    const strake::PolyTopology topology = strake::analyse(result.quads.mesh);
    if (!topology.is_oriented_manifold()) found(topology.defects());
    for (const Vec3& p : result.quads.mesh.positions) {
      if (!p.allFinite()) found("a vertex that is nowhere");
    }
  } catch (const strake::InputError&) {      // no usable surface
  } catch (const strake::ToleranceError&) {  // proven not to be reached
  } catch (const std::exception& error) {
    found(error.what());
  }
  return 0;
}
