#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/core/poly_mesh.h"
#include "strake/render/line_file.h"
#include "strake/render/scene.h"
#include "strake/report/run_files.h"

namespace strake {

/// What to show of a run: what a pane of its report shows, in the same words.
struct RunView {
  std::string surface = "result";  ///< "input" or "result"
  std::string colour = "sides";    ///< as in the report's address: "k_max", "distance" ...
  std::set<std::string> layers = {"edges"};  ///< "edges", "minimum", "principal" ...
  std::optional<Section> section;
  std::optional<std::pair<Vec3, Vec3>>
      camera;  ///< place and what it looks at, in the scene's frame
};

/// Reads the address of a view of a report, or what stands behind its #; of two panes the first.
/// \throw UsageError where a word in it means nothing
RunView read_view(const std::string& address);
/// \throw UsageError naming the word that means nothing
void check_view(const RunView& view);

/// A run as a mesh with a colour per face, and lines on it.
struct ShownRun {
  PolyMesh mesh;                   ///< model coordinates
  std::vector<Vec3> face_colours;  ///< [F] sRGB in [0, 1]; empty: by number of sides
  Polylines lines;                 ///< model coordinates
  SceneFrame frame;                ///< of the input
  bool has_edges = false;          ///< whether the edges of `mesh` are drawn
};

/// \throw UsageError where the run does not hold what the view shows
ShownRun show_run(const report::RunFiles& run, const RunView& view);

}  // namespace strake
