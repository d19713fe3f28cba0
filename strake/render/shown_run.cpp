#include "strake/render/shown_run.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>

#include "common/core/error.h"
#include "common/geometry/cell_error/cell_error.h"
#include "common/geometry/line_chord.h"
#include "strake/report/result_edges.h"
#include "strake/report/scene.h"

namespace strake {
namespace {

using Scale = std::vector<std::array<int, 3>>;

// Those of viewer/src/colours.js.
const Scale kDiverging = {{0x0d, 0x6f, 0x69}, {0x45, 0xa8, 0x9d}, {0xa5, 0xd3, 0xcb},
                          {0xd9, 0xdb, 0xde}, {0xea, 0xd2, 0x9b}, {0xcf, 0xa1, 0x45},
                          {0x8a, 0x5f, 0x10}};
const Scale kConfidence = {{0xc2, 0x18, 0x7a},
                           {0xe0, 0x55, 0x9b},
                           {0xeb, 0x9d, 0xc0},
                           {0xd8, 0xcc, 0xd6},
                           {0xc9, 0xce, 0xd6}};
const Scale kAlignment = {{0xd3, 0xd8, 0xdf},
                          {0xf2, 0xc9, 0xa0},
                          {0xe5, 0x8a, 0x4f},
                          {0xc2, 0x3b, 0x3b},
                          {0x7a, 0x10, 0x38}};
const Scale kDistance = {{0xe6, 0xeb, 0xf0}, {0xb6, 0xd9, 0xc9}, {0x6c, 0xbf, 0xae},
                         {0x2d, 0x8f, 0xa6}, {0x30, 0x57, 0x8f}, {0x3b, 0x25, 0x66}};
const Scale kLabels = {{0x3b, 0x7d, 0xdd}, {0xe0, 0x7a, 0x1f}, {0x2a, 0x9d, 0x63},
                       {0xb0, 0x47, 0x9f}, {0x8d, 0x6e, 0x3f}, {0x5f, 0x6b, 0x7a},
                       {0xc4, 0x3d, 0x4b}, {0x1f, 0x9b, 0xb0}};
const Vec3 kPlain = Vec3(0xc9, 0xce, 0xd6) / 255;
const Vec3 kUnjudged = Vec3(0x8f, 0x97, 0xa3) / 255;

constexpr std::size_t kGlyphs = 3500;
constexpr double kMarkWidth = 3;  // of marks, beside lines

Vec3 stop_of(const Scale& scale, std::size_t k) {
  return Vec3(scale[k][0], scale[k][1], scale[k][2]) / 255;
}

Vec3 on_scale(const Scale& scale, double share) {
  const double place = std::clamp(share, 0.0, 1.0) * static_cast<double>(scale.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(place), scale.size() - 2);
  const Vec3 low = stop_of(scale, i);
  return low + (place - static_cast<double>(i)) * (stop_of(scale, i + 1) - low);
}

/// The size that a share of the values do not exceed.
double usual(std::vector<double> sizes, double share) {
  if (sizes.empty()) return 1;
  const auto rank =
      sizes.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(sizes.size() - 1));
  std::nth_element(sizes.begin(), rank, sizes.end());
  return std::max(*rank, 1e-12);
}

const PrincipalField& field_of(const report::RunFiles& run) {
  if (!run.field) throw UsageError("run '" + run.name + "' has no field, which this view shows");
  return *run.field;
}

/// [F] colours of the input from a colour per wedge, which its triangles take the mean of.
std::vector<Vec3> by_wedge(const TriMesh& mesh, const std::function<Vec3(Index)>& colour) {
  std::vector<Vec3> colours;
  for (const auto& wedges : mesh.face_wedges) {
    colours.push_back((colour(wedges[0]) + colour(wedges[1]) + colour(wedges[2])) / 3);
  }
  return colours;
}

std::vector<Vec3> own_colours(const PolyMesh& mesh, const std::string& name) {
  if (mesh.attributes.colour.empty())
    throw UsageError("run '" + name + "' has no colours of its own");
  std::vector<Vec3> colours;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    Vec3 sum = Vec3::Zero();
    for (const Index v : mesh.face(f)) sum += Vec3(mesh.attributes.colour[v].data());
    colours.push_back(sum / static_cast<double>(mesh.face(f).size()));
  }
  return colours;
}

/// A colour for each label; they repeat where there are many.
std::vector<Vec3> by_label(const PolyMesh& mesh, const std::string& name) {
  const FaceLabels* labels = report::telling_labels(mesh.attributes.labels);
  if (labels == nullptr) throw UsageError("run '" + name + "' has no labels of its faces");
  std::vector<Vec3> colours;
  for (const Index label : labels->of_face) {
    colours.push_back(stop_of(kLabels, static_cast<std::uint32_t>(label) % kLabels.size()));
  }
  return colours;
}

std::vector<Vec3> input_colours(const report::RunFiles& run, const PolyMesh& mesh,
                                const std::string& colour) {
  if (colour == "plain") return std::vector<Vec3>(run.mesh.faces.size(), kPlain);
  if (colour == "colours") return own_colours(mesh, run.name);
  const PrincipalField& field = field_of(run);
  if (colour == "confidence") {
    return by_wedge(run.mesh,
                    [&](Index w) { return on_scale(kConfidence, field.wedge_confidence[w]); });
  }
  const std::vector<double>& curvature = colour == "k_min" ? field.k_min : field.k_max;
  std::vector<double> sizes;
  for (const double k : field.k_max) sizes.push_back(std::abs(k));
  const double end = usual(std::move(sizes), 0.95);
  constexpr double kSteepness = 6;  // small curvatures need colours too
  return by_wedge(run.mesh, [&](Index w) {
    return on_scale(kDiverging, 0.5 + 0.5 * std::asinh(kSteepness * curvature[w] / end) /
                                          std::asinh(kSteepness));
  });
}

std::vector<Vec3> result_colours(const report::RunFiles& run, const std::string& colour) {
  const PolyMesh& mesh = run.quads.mesh;
  if (colour == "sides") return {};
  if (colour == "plain") return std::vector<Vec3>(mesh.face_count(), kPlain);
  if (colour == "colours") return own_colours(mesh, run.name);
  if (colour == "labels") return by_label(mesh, run.name);
  std::vector<Vec3> colours;
  if (colour == "alignment") {
    for (const double angle :
         report::measure_edges(run.mesh, &field_of(run), run.quads).face_angles()) {
      colours.push_back(angle < 0 ? kUnjudged : on_scale(kAlignment, angle / 45));
    }
    return colours;
  }
  const ErrorMap errors = measure_cells(ComparedSurfaces(run.mesh, run.quads));
  std::vector<double> distances;
  for (const CellError& cell : errors.cells) distances.push_back(cell.largest);
  const double end = usual(distances, 0.98);
  for (const double distance : distances) colours.push_back(on_scale(kDistance, distance / end));
  return colours;
}

/// Adds lines of one group to what is drawn.
class LineWriter {
 public:
  LineWriter(Polylines& lines, std::string group, double width = 1)
      : lines_(lines), group_(std::move(group)), width_(width) {}

  void add(const std::vector<Vec3>& points) {
    Polylines::Line line{{}, group_, width_};
    for (const Vec3& p : points) {
      line.points.push_back(static_cast<Index>(lines_.positions.size()));
      lines_.positions.push_back(p);
    }
    lines_.lines.push_back(std::move(line));
  }
  /// A round mark: a short line. \param extent  of the model
  void mark(const Vec3& p, double extent) { add({p, p + Vec3::Constant(1e-4 * extent)}); }

 private:
  Polylines& lines_;
  std::string group_;
  double width_;
};

void add_traced(const report::RunFiles& run, const RunView& view, Polylines& drawn) {
  static const std::vector<std::pair<std::string, std::string>> kGroups = {
      {"minimum", "min"}, {"maximum", "max"}, {"boundary", "boundary"}, {"feature", "feature"}};
  if (!run.lines) return;
  const LineSet& lines = *run.lines;
  const auto place = [&](Index p) -> Vec3 {
    return run.mesh.origin + line_point_position(run.line_mesh(), lines.points[p]);
  };
  for (std::size_t family = 0; family < kGroups.size(); ++family) {
    if (!view.layers.contains(kGroups[family].first)) continue;
    LineWriter writer(drawn, kGroups[family].second);
    for (Index l = 0; l < lines.line_count(); ++l) {
      for (Index p = lines.offsets[l]; p < lines.offsets[l + 1]; ++p) {
        const bool is_last = p + 1 == lines.offsets[l + 1];
        if (static_cast<std::size_t>(lines.chord_family[p]) != family ||
            (is_last && !lines.is_closed(l))) {
          continue;
        }
        writer.add({place(p), place(is_last ? lines.offsets[l] : p + 1)});
      }
    }
  }
  LineWriter seeds(drawn, "guide", kMarkWidth);
  LineWriter ends(drawn, "end", kMarkWidth);
  for (Index l = 0; l < lines.line_count(); ++l) {
    if (view.layers.contains("seeds") && lines.seed_point[l] >= 0)
      seeds.mark(place(lines.seed_point[l]), run.mesh.diagonal);
    if (!view.layers.contains("ends") || lines.is_closed(l)) continue;
    ends.mark(place(lines.offsets[l]), run.mesh.diagonal);
    ends.mark(place(lines.offsets[l + 1] - 1), run.mesh.diagonal);
  }
}

void add_directions(const report::RunFiles& run, const RunView& view, Polylines& drawn) {
  for (const std::string which : {"principal", "cross"}) {
    if (!view.layers.contains(which)) continue;
    const PrincipalField& field = field_of(run);
    const TriMesh& mesh = run.mesh;
    const std::size_t step = std::max<std::size_t>(1, mesh.wedge_vertex.size() / kGlyphs);
    const double reach = 0.3 * mesh.diagonal / std::sqrt(static_cast<double>(kGlyphs));
    for (std::size_t w = 0; w < mesh.wedge_vertex.size(); w += step) {
      const Vec3 p = mesh.origin + mesh.positions[mesh.wedge_vertex[w]];
      const Vec3& along = which == "cross" ? field.cross[w] : field.t_min[w];
      const double half = reach * (which == "cross" ? 1 : 0.25 + 0.75 * field.wedge_confidence[w]);
      LineWriter(drawn, "min").add({p - half * along, p + half * along});
      const Vec3 across = field.normal[w].cross(along);
      LineWriter(drawn, "max").add({p - half * across, p + half * across});
    }
  }
}

void add_guides(const report::RunFiles& run, Polylines& drawn) {
  const TriMesh& mesh = run.mesh;
  const LaidGuides& guides = field_of(run).guides;
  LineWriter writer(drawn, "guide", 1.6);
  for (Index p = 0; p < guides.piece_count(); ++p) {
    Vec3 middle = mesh.origin;
    for (int i = 0; i < 3; ++i) {
      middle += guides.barycentric[p][i] * mesh.positions[mesh.faces[guides.face[p]][i]];
    }
    writer.add({middle - 0.5 * guides.step[p], middle + 0.5 * guides.step[p]});
  }
}

/// Edges of a mesh that is not the one drawn.
void add_edges(const PolyMesh& mesh, Polylines& drawn) {
  LineWriter writer(drawn, "feature", 0.5);
  for (const auto& [a, b] : collect_edges(mesh).vertices) {
    writer.add({mesh.positions[a], mesh.positions[b]});
  }
}

PolyMesh polygons_of(const TriMesh& mesh) {
  PolyMesh polygons;
  for (const Vec3& p : mesh.positions) polygons.positions.push_back(mesh.origin + p);
  for (const auto& face : mesh.faces) polygons.add_face(face);
  polygons.attributes = mesh.attributes;
  return polygons;
}

}  // namespace

ShownRun show_run(const report::RunFiles& run, const RunView& view) {
  check_view(view);
  ShownRun shown;
  const PolyMesh input = polygons_of(run.mesh);
  const bool is_input = view.surface == "input";
  shown.mesh = is_input ? input : run.quads.mesh;
  shown.face_colours =
      is_input ? input_colours(run, input, view.colour) : result_colours(run, view.colour);
  Eigen::AlignedBox3d box;
  for (const Vec3& p : input.positions) box.extend(p);
  shown.frame = {box.center(), run.mesh.diagonal};
  const bool edges = view.layers.contains("edges");
  const bool triangles = view.layers.contains("triangles");
  shown.has_edges = is_input ? triangles : edges;
  if (is_input && edges) add_edges(run.quads.mesh, shown.lines);
  if (!is_input && triangles) add_edges(input, shown.lines);
  add_traced(run, view, shown.lines);
  add_directions(run, view, shown.lines);
  if (view.layers.contains("guides")) add_guides(run, shown.lines);
  return shown;
}

}  // namespace strake
