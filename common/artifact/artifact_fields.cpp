#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <numeric>

#include "common/artifact/artifact_file.h"

namespace strake {
namespace {

/// Position in TensorField::tensor (xx, xy, xz, yy, yz, zz) of each component that viewers expect
/// (xx, yy, zz, xy, yz, xz).
constexpr std::array<std::size_t, 6> kStoredComponent = {0, 3, 5, 1, 4, 2};

using Tensors = std::vector<std::array<double, 6>>;

void write_tensors(ArtifactWriter& file, const Tensors& tensor, const std::vector<Vec3>& normal) {
  Tensors stored(tensor.size());
  for (std::size_t w = 0; w < stored.size(); ++w) {
    for (std::size_t i = 0; i < 6; ++i) stored[w][i] = tensor[w][kStoredComponent[i]];
  }
  file.own("tensor", stored);
  file.own("normal", normal);
  file.show("tensor", "PointData/tensor");
  file.show("normal", "PointData/normal");
}

/// Fills what `write_tensors` wrote into `tensor` and `normal`.
void read_tensors(const ArtifactReader& file, Tensors& tensor, std::vector<Vec3>& normal) {
  const auto stored = file.own<std::array<double, 6>>("tensor");
  normal = file.own<Vec3>("normal");
  file.require_rows(normal, stored.size(), "normal");
  file.require_finite(stored, "tensor");
  file.require_finite(normal, "normal");
  tensor.resize(stored.size());
  for (std::size_t w = 0; w < stored.size(); ++w) {
    for (std::size_t i = 0; i < 6; ++i) tensor[w][kStoredComponent[i]] = stored[w][i];
  }
}

constexpr std::array<const char*, 4> kGuideDatasets = {"guide_offsets", "guide_face",
                                                       "guide_barycentric", "guide_step"};

void write_guides(ArtifactWriter& file, const LaidGuides& guides) {
  if (guides.line_count() == 0) return;
  file.own("guide_offsets", guides.offsets);
  file.own("guide_face", guides.face);
  file.own("guide_barycentric", guides.barycentric);
  file.own("guide_step", guides.step);
}

/// \param faces  of the mesh
LaidGuides read_guides(const ArtifactReader& file, std::size_t faces) {
  LaidGuides guides;
  if (std::none_of(kGuideDatasets.begin(), kGuideDatasets.end(),
                   [&](const char* name) { return file.has(name); })) {
    return guides;
  }
  guides.offsets = file.own<Index>("guide_offsets");
  guides.face = file.own<Index>("guide_face");
  guides.barycentric = file.own<Vec3>("guide_barycentric");
  guides.step = file.own<Vec3>("guide_step");
  file.require_offsets(guides.offsets, guides.face.size(), 1, "guide_offsets");
  file.require_indices(guides.face, 0, faces, "guide_face");
  file.require_rows(guides.barycentric, guides.face.size(), "guide_barycentric");
  file.require_finite(guides.barycentric, "guide_barycentric");
  file.require_rows(guides.step, guides.face.size(), "guide_step");
  file.require_finite(guides.step, "guide_step");
  return guides;
}

/// The one number of a dataset that has one row.
Index read_number(const ArtifactReader& file, const char* name) {
  const auto rows = file.own<Index>(name);
  file.require_rows(rows, 1, name);
  return rows.front();
}

}  // namespace

void write_data(const TensorField& field, const TriMesh& mesh, ArtifactWriter& file) {
  file.wedge_grid(mesh);
  write_tensors(file, field.tensor, field.normal);
}

TensorField read_tensor_field(const std::filesystem::path& path) {
  const ArtifactReader file(path, ArtifactKind::tensor);
  TensorField field;
  field.mesh_id = file.mesh_id();
  read_tensors(file, field.tensor, field.normal);
  return field;
}

void write_data(const TensorPart& part, ArtifactWriter& file) {
  std::vector<Index> points(part.wedge.size());
  std::iota(points.begin(), points.end(), 0);
  std::vector<Index> offsets(part.wedge.size() + 1);
  std::iota(offsets.begin(), offsets.end(), 0);
  file.grid(part.position, points, offsets,
            std::vector<std::uint8_t>(part.wedge.size(), kVtkVertex));
  file.adopt("Points", "position");
  file.own("part", std::vector<Index>{part.part});
  file.own("parts", std::vector<Index>{part.parts});
  file.own("wedge", part.wedge);
  file.show("wedge", "PointData/wedge");
  write_tensors(file, part.tensor, part.normal);
}

TensorPart read_tensor_part(const std::filesystem::path& path) {
  const ArtifactReader file(path, ArtifactKind::tensor_part);
  TensorPart part;
  part.mesh_id = file.mesh_id();
  part.parts = read_number(file, "parts");
  file.require(part.parts >= 1, "parts", "is not a number of parts");
  part.part = read_number(file, "part");
  file.require(part.part >= 1 && part.part <= part.parts, "part", "is not one of the parts");
  part.wedge = file.own<Index>("wedge");
  file.require(part.wedge.empty() || part.wedge.front() >= 0, "wedge", "has indices out of range");
  file.require(std::is_sorted(part.wedge.begin(), part.wedge.end(), std::less_equal<>()), "wedge",
               "is not ascending");
  part.position = file.own<Vec3>("position");
  file.require_rows(part.position, part.wedge.size(), "position");
  file.require_finite(part.position, "position");
  read_tensors(file, part.tensor, part.normal);
  file.require_rows(part.tensor, part.wedge.size(), "tensor");
  return part;
}

void write_data(const SizeField& size, const TriMesh& mesh, ArtifactWriter& file) {
  file.wedge_grid(mesh);
  file.own("along", size.along);
  file.own("across", size.across);
  for (const char* name : {"along", "across"}) file.show(name, std::string("PointData/") + name);
}

SizeField read_size_field(const std::filesystem::path& path) {
  const ArtifactReader file(path, ArtifactKind::size);
  SizeField size;
  size.mesh_id = file.mesh_id();
  size.along = file.own<double>("along");
  size.across = file.own<double>("across");
  file.require_rows(size.across, size.along.size(), "across");
  for (const auto& [name, rows] : {std::pair{"along", &size.along}, {"across", &size.across}}) {
    file.require_finite(*rows, name);
    const bool positive = std::all_of(rows->begin(), rows->end(), [](double d) { return d > 0; });
    file.require(positive, name, "has distances that are not positive");
  }
  return size;
}

void write_data(const PrincipalField& field, const TriMesh& mesh, ArtifactWriter& file) {
  file.wedge_grid(mesh);
  file.own("normal", field.normal);
  file.own("t_min", field.t_min);
  file.own("k_min", field.k_min);
  file.own("k_max", field.k_max);
  file.own("cross", field.cross);
  file.own("wedge_confidence", field.wedge_confidence);
  file.own("face_confidence", field.face_confidence);
  file.own("cross_extended", std::vector<std::uint8_t>{field.cross_extended});
  write_guides(file, field.guides);
  for (const char* name : {"normal", "t_min", "k_min", "k_max", "cross", "wedge_confidence"}) {
    file.show(name, std::string("PointData/") + name);
  }
  file.show("face_confidence", "CellData/face_confidence");
}

PrincipalField read_principal_field(const std::filesystem::path& path) {
  const ArtifactReader file(path, ArtifactKind::field);
  PrincipalField field;
  field.mesh_id = file.mesh_id();
  const auto read_per_wedge = [&](const char* name, auto& rows) {
    rows = file.own<typename std::remove_reference_t<decltype(rows)>::value_type>(name);
    file.require_rows(rows, field.normal.size(), name);
    file.require_finite(rows, name);
  };
  field.normal = file.own<Vec3>("normal");
  file.require_finite(field.normal, "normal");
  read_per_wedge("t_min", field.t_min);
  read_per_wedge("k_min", field.k_min);
  read_per_wedge("k_max", field.k_max);
  read_per_wedge("cross", field.cross);
  read_per_wedge("wedge_confidence", field.wedge_confidence);
  field.face_confidence = file.own<double>("face_confidence");
  file.require_finite(field.face_confidence, "face_confidence");
  const auto cross_extended = file.own<std::uint8_t>("cross_extended");
  file.require_rows(cross_extended, 1, "cross_extended");
  file.require_codes(cross_extended, 2, "cross_extended");
  field.cross_extended = cross_extended.front() != 0;
  field.guides = read_guides(file, field.face_confidence.size());
  return field;
}

}  // namespace strake
