#include "strake/summary.h"

#include <fmt/format.h>

#include <string>
#include <utility>

namespace strake {

std::string summary_text(const std::string& output, const PolyMesh& mesh, const Report* measures) {
  Index quads = 0;
  for (Index f = 0; f < mesh.face_count(); ++f) quads += mesh.face(f).size() == 4 ? 1 : 0;
  std::string text = fmt::format("{}: {} vertices, {} faces, {:.1f} % of them quads\n", output,
                                 mesh.vertex_count(), mesh.face_count(),
                                 100.0 * quads / std::max<Index>(mesh.face_count(), 1));
  if (measures == nullptr) return text;
  const auto line = [&](const char* label, const char* key, double factor, const char* unit) {
    if (const auto value = measures->number(key)) {
      text += fmt::format("  {:<28} {:.3g} {}\n", label, *value * factor, unit);
    }
  };
  const auto count = [&](const char* label, const char* key) {
    if (const auto value = measures->number(key)) {
      text += fmt::format("  {:<28} {:.0f}\n", label, *value);
    }
  };
  if (const auto sound = measures->number("topology.candidate.oriented_manifold")) {
    const auto equal = measures->number("topology.equal");
    text += fmt::format("  {:<28} {}{}\n", "topology",
                        *sound != 0 ? "oriented manifold" : "NOT an oriented manifold",
                        !equal        ? ""
                        : *equal != 0 ? ", that of the input after repairs"
                                      : ", differs from the input");
  }
  for (const auto& [label, key] :
       {std::pair{"distance to input, rms", "distance.to_reference.rms_share"},
        std::pair{"distance to input, largest", "distance.to_reference.max_share"},
        std::pair{"distance from input, largest", "distance.from_reference.max_share"}}) {
    line(label, key, 100, "% of the diagonal");
  }
  line("within 10 deg of own field", "alignment.within_10_deg_share", 100, "% of the edge length");
  line("smallest angle", "angles.min_deg", 1, "deg");
  count("concave faces", "faces.concave");
  count("quads flat at a corner", "faces.flat_quads");
  if (measures->number("faces.degenerate").value_or(0) > 0) {
    count("faces without area", "faces.degenerate");
  }
  if (const auto pairs = measures->number("shape.self_intersecting_pairs")) {
    const double touching = measures->number("shape.touching_pairs").value_or(0);
    text +=
        fmt::format("  {:<28} {:.0f}{}\n", "crossing pairs of faces", *pairs,
                    touching == 0        ? ""
                    : touching == *pairs ? ", which only touch"
                                         : fmt::format(", {:.0f} of which only touch", touching));
  }
  return text;
}

}  // namespace strake
