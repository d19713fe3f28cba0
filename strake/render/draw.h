#pragma once

#include <optional>
#include <string>
#include <vector>

#include "strake/render/camera.h"
#include "strake/render/image.h"
#include "strake/render/scene.h"

namespace strake {

struct DrawOptions {
  int width = 1200;
  int height = 900;
  int samples = 3;                      ///< per pixel and axis
  bool edges = false;                   ///< draw the edges of the polygons
  double edge_width = 1.1;              ///< pixels
  std::vector<Vec3> face_colours = {};  ///< [F] sRGB in [0, 1]; empty: by number of sides
  std::optional<Section> section = {};  ///< with the cut of a closed surface filled
};

/// Draws a scene: soft light from the viewer and the sky, faces that are no quads tinted by their
/// number of sides (unless the mesh is all triangles), back faces violet, on white.
/// \param line_groups  group name of each line of the scene: "min" blue, "max" red, "boundary"
/// green, "guide" orange, "end" amber,
///                     others dark
/// Deterministic for any thread count.
Image draw(const Scene& scene, const Camera& camera, const std::vector<std::string>& line_groups,
           const DrawOptions& options);

}  // namespace strake
