// Lines on a few triangles that may be needles, with ends in nearly or exactly the same places: an
// embedding in which those chords cross that must, and faces of the topology of the surface.

#include <fuzzer/FuzzedDataProvider.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "common/core/observer.h"
#include "stages/mesh/mesh.h"
#include "tests/fuzz/found.h"
#include "tests/support/mesh_support.h"
#include "tests/unit/mesh/arrangement_check.h"
#include "tests/unit/mesh/graphs.h"
#include "tests/unit/mesh/line_sets.h"

namespace {

using strake::Index;
using strake::kNone;
using strake::TriMesh;

constexpr int kMostLines = 20;

/// 1, 0.1, 0.01 ... 1e-17: from plainly different to equal.
double small(FuzzedDataProvider& data) {
  return std::pow(10.0, -data.ConsumeIntegralInRange(0, 17));
}

/// One triangle, two, or a tetrahedron, pressed together.
TriMesh make_mesh(FuzzedDataProvider& data) {
  strake::PolyMesh soup;
  soup.positions = {{0, 0, 0}, {1, 0.1, 0}, {0.3, 0.9, 0}, {1.2, 1, 0.4}};
  using Face = std::array<Index, 3>;
  const std::vector<Face> all = {Face{0, 1, 2}, Face{2, 1, 3}, Face{3, 1, 0}, Face{0, 2, 3}};
  const std::size_t count = data.PickValueInArray<std::size_t>({1, 2, 4});
  const double height = std::max(small(data), 1e-12);
  soup.positions.resize(count == 1 ? 3 : 4);
  for (strake::Vec3& p : soup.positions) p.y() *= height;
  for (std::size_t f = 0; f < count; ++f) soup.add_face(all[f]);
  return strake::support::plain_tri_mesh(soup);
}

/// A place on an edge that many others are at or near.
double place(FuzzedDataProvider& data) {
  const double base = data.ConsumeIntegralInRange(1, 15) / 16.0;
  const double noise = small(data) * data.ConsumeIntegralInRange(-8, 8) / 8.0;
  return std::clamp(base + noise, 1e-15, 1 - 1e-15);
}

/// A line through faces, each at most once, from an edge or a corner.
void add_line(FuzzedDataProvider& data, const TriMesh& mesh, strake::LineSet& lines) {
  Index in = data.ConsumeIntegralInRange<Index>(0, mesh.halfedge_count() - 1);
  std::vector<strake::LinePoint> points;
  std::vector<Index> faces;
  if (data.ConsumeBool()) {
    points.push_back({in, place(data)});
  } else {
    points.push_back({TriMesh::prev(in), 0});  // the corner across from `in`, and out over it
    points.push_back({in, place(data)});
    faces.push_back(TriMesh::face_of(in));
    in = mesh.twin[in];
  }
  do {
    if (in == kNone) break;
    const Index face = TriMesh::face_of(in);
    if (std::find(faces.begin(), faces.end(), face) != faces.end()) break;
    const Index out = data.ConsumeBool() ? TriMesh::next(in) : TriMesh::prev(in);
    points.push_back({out, place(data)});
    faces.push_back(face);
    in = mesh.twin[out];
  } while (data.ConsumeBool());
  const auto family =
      data.PickValueInArray({strake::LineFamily::minimum, strake::LineFamily::maximum});
  strake::add_line(lines, points, faces, family);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  FuzzedDataProvider data(bytes, size);
  const TriMesh mesh = make_mesh(data);
  strake::MeshOptions options;
  options.max_sides = data.ConsumeIntegralInRange(4, 9);
  options.odd_price = data.ConsumeBool() ? 1 : 0;
  options.valence_price = data.ConsumeBool() ? 1 : 0;
  const double spacing = small(data);
  strake::LineSet lines;
  while (data.remaining_bytes() > 0 && lines.line_count() < kMostLines) add_line(data, mesh, lines);
  strake::set_spacing(mesh, spacing, lines);

  const std::string fault = strake::arrangement_fault(mesh, lines, strake::overlay_of(mesh, lines));
  if (!fault.empty()) found(fault);
  try {
    strake::SilentObserver observer;
    (void)strake::mesh_lines(mesh, lines, options, observer);  // checks its result
  } catch (const std::exception& error) {
    found(error.what());
  }
  return 0;
}
