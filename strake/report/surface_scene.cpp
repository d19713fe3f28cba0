#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "strake/report/proxy.h"
#include "strake/report/quantise.h"
#include "strake/report/scene.h"

namespace strake::report {
namespace {

using Json = nlohmann::ordered_json;

/// The absolute value that a share of 95 % of the values do not exceed: the end of a colour scale.
double usual_size(const std::vector<double>& values) {
  std::vector<double> sizes;
  sizes.reserve(values.size());
  for (const double v : values) sizes.push_back(std::abs(v));
  if (sizes.empty()) return 0;
  const auto rank = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() - 1) * 95 / 100;
  std::nth_element(sizes.begin(), rank, sizes.end());
  return *rank;
}

void add_field(const TriMesh& mesh, const PrincipalField& field, const Proxy& proxy, Blocks& blocks,
               Json& scene) {
  std::vector<std::array<std::int16_t, 2>> curvature;
  std::vector<std::array<std::int8_t, 4>> directions;
  for (const Index w : proxy.wedge) {
    curvature.push_back({quantise_signed(field.k_min[w] * mesh.diagonal),
                         quantise_signed(field.k_max[w] * mesh.diagonal)});
    const auto t_min = quantise_direction(field.t_min[w]);
    const auto cross = quantise_direction(field.cross[w]);
    directions.push_back({t_min[0], t_min[1], cross[0], cross[1]});
  }
  scene["curvature"] = blocks.vertices(curvature);
  scene["directions"] = blocks.vertices(directions);
  scene["usual_k_min"] = usual_size(field.k_min) * mesh.diagonal;
  scene["usual_k_max"] = usual_size(field.k_max) * mesh.diagonal;
}

/// Pieces of guide lines, each by its two ends.
void add_guides(const TriMesh& mesh, const LaidGuides& guides, const Grid& grid, Blocks& blocks,
                Json& scene) {
  std::vector<GridPoint> ends;
  for (Index p = 0; p < guides.piece_count(); ++p) {
    Vec3 middle = Vec3::Zero();
    for (int i = 0; i < 3; ++i) {
      middle += guides.barycentric[p][i] * mesh.positions[mesh.faces[guides.face[p]][i]];
    }
    ends.push_back(grid.quantise(middle - 0.5 * guides.step[p]));
    ends.push_back(grid.quantise(middle + 0.5 * guides.step[p]));
  }
  scene["guides"] = {{"lines", guides.line_count()}, {"ends", blocks.vertices(ends)}};
}

}  // namespace

Json surface_scene(const TriMesh& mesh, const PrincipalField* field, std::size_t most_faces,
                   Blocks& blocks) {
  const Proxy proxy = make_proxy(mesh, most_faces);
  const Grid grid(mesh.positions);
  std::vector<GridPoint> points;
  points.reserve(proxy.wedge.size());
  for (const Index w : proxy.wedge) {
    const double confidence = field != nullptr ? field->wedge_confidence[w] : 1;
    points.push_back(
        grid.quantise(mesh.positions[mesh.wedge_vertex[w]], quantise_share(confidence)));
  }
  Json scene = {
      {"vertices", mesh.vertex_count()},
      {"faces", mesh.face_count()},
      {"shown_faces", proxy.triangles.size() / 3},
      {"shown_deviation_share", proxy.deviation / mesh.diagonal},
      {"is_closed", std::find(mesh.twin.begin(), mesh.twin.end(), kNone) == mesh.twin.end()},
      {"diagonal", mesh.diagonal},
      {"origin", {mesh.origin.x(), mesh.origin.y(), mesh.origin.z()}},
      {"low", {grid.low().x(), grid.low().y(), grid.low().z()}},
      {"step", grid.step()},
      {"positions", blocks.vertices(points)},
      {"triangles", blocks.triangles(proxy.triangles)},
  };
  if (!mesh.attributes.colour.empty()) {
    std::vector<Colour> colours;
    for (const Index w : proxy.wedge)
      colours.push_back(mesh.attributes.colour[mesh.wedge_vertex[w]]);
    scene["colours"] = blocks.vertices(quantise_colours(colours));
  }
  if (field != nullptr) {
    add_field(mesh, *field, proxy, blocks, scene);
    if (field->guides.piece_count() > 0) add_guides(mesh, field->guides, grid, blocks, scene);
  }
  return scene;
}

}  // namespace strake::report
