#include <array>
#include <cstddef>
#include <limits>

#include "common/artifact/artifact_file.h"

namespace strake {
namespace {

constexpr int kFamilies = 4;  ///< values of LineFamily
constexpr int kEnds = 7;      ///< values of LineEnd

/// The lines as polylines in space, closed ones with their first point again at the end.
void write_view(ArtifactWriter& file, const LineSet& lines, const TriMesh& mesh) {
  std::vector<Vec3> points;
  points.reserve(lines.points.size());
  for (const LinePoint& point : lines.points) {
    const Vec3& a = mesh.positions[mesh.from(point.halfedge)];
    const Vec3& b = mesh.positions[mesh.to(point.halfedge)];
    points.push_back(a + point.lambda * (b - a));
  }
  std::vector<Index> connectivity;
  std::vector<Index> offsets = {0};
  std::vector<std::uint8_t> types;
  for (Index line = 0; line < lines.line_count(); ++line) {
    for (Index i = lines.offsets[line]; i < lines.offsets[line + 1]; ++i) connectivity.push_back(i);
    if (lines.is_closed(line)) connectivity.push_back(lines.offsets[line]);
    offsets.push_back(static_cast<Index>(connectivity.size()));
    types.push_back(offsets[line + 1] - offsets[line] > 1 ? kVtkPolyLine : kVtkVertex);
  }
  file.grid(points, connectivity, offsets, types);
}

void require_sound(const LineSet& lines, const ArtifactReader& file) {
  const std::size_t points = lines.points.size();
  const auto line_count = static_cast<std::size_t>(lines.line_count());
  file.require_offsets(lines.offsets, points, 1, "offsets");
  file.require_rows(lines.chord_face, points, "chord_face");
  file.require_rows(lines.chord_family, points, "chord_family");
  file.require_rows(lines.family, line_count, "family");
  file.require_rows(lines.start_reason, line_count, "start_reason");
  file.require_rows(lines.end_reason, line_count, "end_reason");
  file.require_rows(lines.seed_point, line_count, "seed_point");
  file.require_rows(lines.spacing_along_max, lines.spacing_along_min.size(), "spacing_along_max");
  file.require_codes(lines.chord_family, kFamilies, "chord_family");
  file.require_codes(lines.family, kFamilies, "family");
  file.require_codes(lines.start_reason, kEnds, "start_reason");
  file.require_codes(lines.end_reason, kEnds, "end_reason");
  file.require_finite(lines.spacing_along_min, "spacing_along_min");
  file.require_finite(lines.spacing_along_max, "spacing_along_max");
  file.require_indices(lines.chord_face, kNone, std::numeric_limits<Index>::max(), "chord_face");
  file.require_indices(lines.seed_point, 0, points, "seed_point");
  for (const LinePoint& point : lines.points) {
    file.require(point.halfedge >= 0, "halfedge", "has indices out of range");
    file.require(point.lambda >= 0 && point.lambda < 1, "lambda", "has numbers outside [0, 1)");
  }
}

}  // namespace

void write_data(const LineSet& lines, const TriMesh& mesh, ArtifactWriter& file) {
  write_view(file, lines, mesh);
  std::vector<Index> halfedge;
  std::vector<double> lambda;
  for (const LinePoint& point : lines.points) {
    halfedge.push_back(point.halfedge);
    lambda.push_back(point.lambda);
  }
  file.own("offsets", lines.offsets);
  file.own("halfedge", halfedge);
  file.own("lambda", lambda);
  file.own("chord_face", lines.chord_face);
  file.own("chord_family", lines.chord_family);
  file.own("family", lines.family);
  file.own("start_reason", lines.start_reason);
  file.own("end_reason", lines.end_reason);
  file.own("seed_point", lines.seed_point);
  file.own("spacing_along_min", lines.spacing_along_min);
  file.own("spacing_along_max", lines.spacing_along_max);
  file.show("chord_family", "PointData/chord_family");
  for (const char* name : {"family", "start_reason", "end_reason", "seed_point"}) {
    file.show(name, std::string("CellData/") + name);
  }
}

LineSet read_line_set(const std::filesystem::path& path) {
  const ArtifactReader file(path, ArtifactKind::lines);
  LineSet lines;
  lines.mesh_id = file.mesh_id();
  lines.offsets = file.own<Index>("offsets");
  const auto halfedge = file.own<Index>("halfedge");
  const auto lambda = file.own<double>("lambda");
  file.require_rows(lambda, halfedge.size(), "lambda");
  for (std::size_t i = 0; i < halfedge.size(); ++i)
    lines.points.push_back({halfedge[i], lambda[i]});
  lines.chord_face = file.own<Index>("chord_face");
  lines.chord_family = file.own<LineFamily>("chord_family");
  lines.family = file.own<LineFamily>("family");
  lines.start_reason = file.own<LineEnd>("start_reason");
  lines.end_reason = file.own<LineEnd>("end_reason");
  lines.seed_point = file.own<Index>("seed_point");
  lines.spacing_along_min = file.own<double>("spacing_along_min");
  lines.spacing_along_max = file.own<double>("spacing_along_max");
  require_sound(lines, file);
  return lines;
}

}  // namespace strake
