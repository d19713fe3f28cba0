#include "common/artifact/meshfile/mesh_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>

#include "common/artifact/meshfile/formats.h"
#include "common/artifact/meshfile/mapped_file.h"
#include "common/core/error.h"
#include "common/core/text.h"

namespace strake {
namespace meshfile {

void check_countable(std::size_t count, const char* what) {
  if (count > INT32_MAX) {
    throw InputError(fmt::format("more than {} {}; split the model into parts", INT32_MAX, what));
  }
}

void finish_colours(std::vector<Colour>& colours) {
  constexpr double kLeastByte = 2;
  double colour = 0;  // the largest
  double alpha = 0;
  for (const Colour& c : colours) {
    for (int i = 0; i < 4; ++i) {
      double& largest = i < 3 ? colour : alpha;
      if (std::isfinite(c[i])) largest = std::max(largest, c[i]);
    }
  }
  for (Colour& c : colours) {
    for (int i = 0; i < 4; ++i) {
      const double whole = (i < 3 ? colour : alpha) >= kLeastByte ? 255 : 1;
      c[i] = std::isfinite(c[i]) ? std::clamp(c[i] / whole, 0.0, 1.0) : 1;
    }
  }
}

}  // namespace meshfile

namespace {

enum class Format { obj, ply, off, stl, unknown };

Format format_of_content(std::string_view bytes) {
  using namespace meshfile;
  if (bytes.starts_with("ply") && bytes.size() > 3 && std::isspace(bytes[3]) != 0) {
    return Format::ply;
  }
  if (looks_like_off(bytes)) return Format::off;
  if (looks_like_stl(bytes)) return Format::stl;
  if (looks_like_obj(bytes)) return Format::obj;
  return Format::unknown;
}

Format format_of_extension(std::string_view extension) {
  const std::string lower = lower_case(extension);
  if (lower == ".obj") return Format::obj;
  if (lower == ".ply") return Format::ply;
  if (lower == ".off") return Format::off;
  if (lower == ".stl") return Format::stl;
  return Format::unknown;
}

PolyMesh read_format(Format format, std::string_view bytes, ReadReport& report) {
  switch (format) {
    case Format::obj:
      return meshfile::read_obj(bytes, report);
    case Format::ply:
      return meshfile::read_ply(bytes, report);
    case Format::off:
      return meshfile::read_off(bytes, report);
    case Format::stl:
      return meshfile::read_stl(bytes, report);
    case Format::unknown:
      break;
  }
  throw InputError("is in no known format; OBJ, PLY, OFF and STL can be read");
}

/// Moves what a face carries to the place where the face goes; places only move forward.
void move_attributes(Attributes& attributes, Index face, Index to_face, Index corner,
                     Index to_corner, Index sides) {
  for (FaceLabels& labels : attributes.labels) labels.of_face[to_face] = labels.of_face[face];
  if (attributes.texture.empty()) return;
  std::copy_n(attributes.texture.begin() + corner, sides, attributes.texture.begin() + to_corner);
}

/// Removes the faces that cannot be used, in place, and counts them.
void drop_unusable_faces(PolyMesh& mesh, ReadReport& report) {
  std::vector<std::uint8_t> finite(mesh.positions.size());
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    finite[v] = mesh.positions[v].allFinite() ? 1 : 0;
    report.non_finite_vertices += finite[v] == 0 ? 1 : 0;
  }
  const Index vertices = mesh.vertex_count();
  Index kept_faces = 0;
  Index kept_corners = 0;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const Index first = mesh.offsets[f];
    const Index last = mesh.offsets[f + 1];
    bool valid = true;
    bool all_finite = true;
    for (Index c = first; c < last; ++c) {
      const Index v = mesh.corners[c];
      valid = valid && v >= 0 && v < vertices;
      all_finite = all_finite && valid && finite[v] != 0;
    }
    if (last - first < 3 || !valid || !all_finite) {
      ++(last - first < 3 ? report.few_corner_faces
                          : (valid ? report.non_finite_faces : report.bad_index_faces));
      continue;
    }
    move_attributes(mesh.attributes, f, kept_faces, first, kept_corners, last - first);
    mesh.offsets[kept_faces++] = kept_corners;
    for (Index c = first; c < last; ++c) mesh.corners[kept_corners++] = mesh.corners[c];
  }
  mesh.offsets.resize(kept_faces + 1);
  mesh.offsets[kept_faces] = kept_corners;
  mesh.corners.resize(kept_corners);
  for (FaceLabels& labels : mesh.attributes.labels) labels.of_face.resize(kept_faces);
  if (!mesh.attributes.texture.empty()) mesh.attributes.texture.resize(kept_corners);
}

std::string describe_loss(const ReadReport& report) {
  std::string text;
  for (const std::string& warning : report.warnings()) text += "; " + warning;
  return text;
}

}  // namespace

std::vector<std::string> ReadReport::warnings() const {
  std::vector<std::string> result;
  const auto add = [&](std::int64_t count, const char* text) {
    if (count != 0) result.push_back(fmt::format("{}: {}", text, count));
  };
  if (extension_differs) {
    result.push_back(fmt::format("the file is {} by content, whatever its name says", format));
  }
  add(missing_vertices, "vertices missing that the file announces (it is cut off or damaged)");
  add(missing_faces, "faces missing that the file announces (it is cut off or damaged)");
  add(unannounced_faces, "faces read beyond the number that the file announces (which is wrong)");
  add(left_out_faces,
      "faces left out beyond the number that the file announces (it is wrong or damaged)");
  add(bad_index_faces, "faces skipped that name vertices which are not there");
  add(few_corner_faces, "faces skipped that have fewer than 3 corners");
  add(non_finite_vertices, "vertices without finite coordinates");
  add(non_finite_faces, "faces skipped that use vertices without finite coordinates");
  add(skipped_lines, "lines skipped that make no sense");
  add(untextured_corners,
      "corners of faces without texture coordinates, where others have some; they get (0, 0)");
  return result;
}

void ReadReport::add_to(Report& report) const {
  report.set("file.format", format);
  report.set("file.missing_vertices", missing_vertices);
  report.set("file.missing_faces", missing_faces);
  report.set("file.unannounced_faces", unannounced_faces);
  report.set("file.left_out_faces", left_out_faces);
  report.set("file.bad_index_faces", bad_index_faces);
  report.set("file.few_corner_faces", few_corner_faces);
  report.set("file.non_finite_vertices", non_finite_vertices);
  report.set("file.non_finite_faces", non_finite_faces);
  report.set("file.skipped_lines", skipped_lines);
  report.set("file.untextured_corners", untextured_corners);
  report.set("file.welded_vertices", welded_vertices);
  for (std::string& warning : warnings()) report.warn(std::move(warning));
}

PolyMesh parse_mesh(std::string_view bytes, std::string_view extension, ReadReport& report) {
  report = {};
  if (bytes.empty()) throw InputError("is empty");
  bytes = without_byte_order_mark(bytes);
  const Format promised = format_of_extension(extension);
  Format format = format_of_content(bytes);
  report.extension_differs =
      format != Format::unknown && promised != Format::unknown && format != promised;
  if (format == Format::unknown) format = promised;
  PolyMesh mesh = read_format(format, bytes, report);
  meshfile::finish_colours(mesh.attributes.colour);
  const bool has_faces = mesh.face_count() > 0 || report.missing_faces > 0;
  drop_unusable_faces(mesh, report);
  if (!has_faces && mesh.vertex_count() > 0) {
    throw InputError(fmt::format(
        "holds {} vertices but no faces ({}{}): it may be cut off before them, or be a point "
        "cloud, of which a surface must be made first",
        mesh.vertex_count(), report.format, describe_loss(report)));
  }
  if (mesh.face_count() == 0) {
    throw InputError(fmt::format("holds no usable face ({}, {} vertices{})", report.format,
                                 mesh.vertex_count(), describe_loss(report)));
  }
  return mesh;
}

PolyMesh read_mesh(const std::filesystem::path& path, ReadReport& report) {
  const meshfile::MappedFile file(path);
  try {
    return parse_mesh(file.bytes(), path.extension().string(), report);
  } catch (const InputError& error) {
    throw InputError(fmt::format("'{}' {}", path.string(), error.what()));
  }
}

}  // namespace strake
