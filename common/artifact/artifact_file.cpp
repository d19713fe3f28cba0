#include "common/artifact/artifact_file.h"

#include <array>
#include <cmath>
#include <fstream>
#include <string_view>
#include <utility>

namespace strake {
namespace {

constexpr const char* kContent = "content";
constexpr const char* kProvenance = "provenance";
constexpr std::array<const char*, 7> kKindNames = {"mesh",  "tensor",      "field", "lines",
                                                   "quads", "tensor_part", "size"};

/// Kind and version of an open file. \throw InputError where either is unknown
ArtifactKind read_kind(const hdf5::Reader& file) {
  const std::int64_t version = file.integer_attribute("format_version");
  if (version > kFormatVersion) {
    file.refuse("format_version", "is " + std::to_string(version) +
                                      ", and this program reads up to " +
                                      std::to_string(kFormatVersion) +
                                      ": a newer strake wrote the file, update this one");
  }
  if (version < 1) file.refuse("format_version", "is not a version");
  const std::string kind = file.text_attribute("kind");
  for (std::size_t i = 0; i < kKindNames.size(); ++i) {
    if (kind == kKindNames[i]) return static_cast<ArtifactKind>(i);
  }
  file.refuse("kind", "is '" + kind + "', which this program does not know");
}

/// The digest that `ArtifactWriter::commit` wrote; of a file from before there was one, of its
/// bytes.
std::string content_of(const hdf5::Reader& file, const std::filesystem::path& path) {
  return file.has_attribute(kContent) ? file.text_attribute(kContent) : digest_file(path);
}

Provenance read_provenance(const hdf5::Reader& file) {
  const std::string text = file.text_attribute(kProvenance);
  try {
    return Provenance::from_json(text);
  } catch (const InputError&) {  // does not know the file
    file.refuse(kProvenance, "does not say how it was made; the file is damaged");
  }
}

}  // namespace

std::string kind_name(ArtifactKind kind) { return kKindNames[static_cast<std::size_t>(kind)]; }

ArtifactWriter::ArtifactWriter(const std::filesystem::path& path, ArtifactKind kind,
                               const std::string& mesh_id, const Provenance& provenance)
    : ArtifactWriter(kind, mesh_id) {
  target_.emplace(path);
  file_.emplace(target_->temporary(), path);
  file_->attribute("/", "kind", kind_name(kind));
  file_->attribute("/", "format_version", kFormatVersion);
  file_->attribute("/", "mesh_id", mesh_id);
  file_->attribute("/", kProvenance, provenance.to_json());
  file_->group(group_);
  file_->group("/VTKHDF");
  file_->attribute("/VTKHDF", "Version", std::vector<std::int64_t>{1, 0});
  file_->attribute("/VTKHDF", "Type", "UnstructuredGrid");
  file_->group("/VTKHDF/PointData");
  file_->group("/VTKHDF/CellData");
}

ArtifactWriter::ArtifactWriter(ArtifactKind kind, const std::string& mesh_id)
    : group_("/" + kind_name(kind)) {
  const std::string identity = kind_name(kind) + " " + mesh_id;
  content_.add(identity.c_str(), identity.size() + 1);
}

void ArtifactWriter::counts(std::size_t points, std::size_t cells, std::size_t connectivity) {
  using Count = std::vector<std::int64_t>;
  dataset("/VTKHDF/NumberOfPoints", Count{static_cast<std::int64_t>(points)});
  dataset("/VTKHDF/NumberOfCells", Count{static_cast<std::int64_t>(cells)});
  dataset("/VTKHDF/NumberOfConnectivityIds", Count{static_cast<std::int64_t>(connectivity)});
}

void ArtifactWriter::wedge_grid(const TriMesh& mesh) {
  std::vector<Vec3> points;
  points.reserve(mesh.wedge_vertex.size());
  for (const Index vertex : mesh.wedge_vertex) points.push_back(mesh.positions[vertex]);
  std::vector<Index> offsets;
  for (Index f = 0; f <= mesh.face_count(); ++f) offsets.push_back(3 * f);
  grid(points, mesh.face_wedges, offsets,
       std::vector<std::uint8_t>(mesh.faces.size(), kVtkTriangle));
}

bool ArtifactWriter::commit() {
  file_->attribute("/", kContent, content());
  file_->finish();
  return target_->commit();
}

ArtifactReader::ArtifactReader(const std::filesystem::path& path, ArtifactKind kind)
    : file_(path), group_("/" + kind_name(kind)) {
  const ArtifactKind found = read_kind(file_);
  if (found != kind) {
    file_.refuse("kind", "is '" + kind_name(found) + "' where '" + kind_name(kind) +
                             "' is needed; check the order of the files");
  }
  mesh_id_ = file_.text_attribute("mesh_id");
}

void ArtifactReader::require_offsets(const std::vector<Index>& offsets, std::size_t end,
                                     Index shortest, std::string_view name) const {
  require(!offsets.empty() && offsets.front() == 0, name, "does not begin at 0");
  for (std::size_t i = 1; i < offsets.size(); ++i) {
    require(offsets[i] >= offsets[i - 1] && offsets[i] - offsets[i - 1] >= shortest, name,
            "has a run that is too short");
  }
  require(static_cast<std::size_t>(offsets.back()) == end, name, "does not cover its data");
}

void ArtifactReader::require_finite(const double* values, std::size_t count,
                                    std::string_view name) const {
  for (std::size_t i = 0; i < count; ++i) {
    require(std::isfinite(values[i]), name, "has numbers that are not finite");
  }
}

void ArtifactReader::require_indices(const Index* values, std::size_t count, Index low,
                                     std::size_t high, std::string_view name) const {
  for (std::size_t i = 0; i < count; ++i) {
    require(values[i] >= low && (values[i] < 0 || static_cast<std::size_t>(values[i]) < high), name,
            "has indices out of range");
  }
}

ArtifactInfo read_artifact_info(const std::filesystem::path& path) {
  const hdf5::Reader file(path);
  ArtifactInfo info;
  info.kind = read_kind(file);
  info.format_version = file.integer_attribute("format_version");
  info.mesh_id = file.text_attribute("mesh_id");
  info.content = content_of(file, path);
  info.says_content = file.has_attribute(kContent);
  info.provenance = read_provenance(file);
  const std::string group = "/" + kind_name(info.kind);
  constexpr std::array<const char*, 4> kTypes = {"u8", "i32", "i64", "f64"};
  for (const hdf5::DatasetInfo& dataset : file.list(group)) {
    info.datasets.push_back({group + "/" + dataset.name, dataset.shape.rows, dataset.shape.columns,
                             kTypes[static_cast<std::size_t>(dataset.scalar)]});
  }
  return info;
}

void check_picture(const std::filesystem::path& path) {
  const hdf5::Reader file(path);
  for (const char* group : {"/VTKHDF", "/VTKHDF/PointData", "/VTKHDF/CellData"}) {
    file.read_all(group);
  }
}

std::string content_digest(const std::filesystem::path& path) {
  return is_artifact(path) ? content_of(hdf5::Reader(path), path) : digest_file(path);
}

bool is_artifact(const std::filesystem::path& path) {
  constexpr std::string_view kSignature("\x89HDF\r\n\x1a\n", 8);
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return false;  // a pipe may never begin
  std::array<char, 8> start{};
  std::ifstream stream(path, std::ios::binary);
  stream.read(start.data(), start.size());
  return stream && std::string_view(start.data(), start.size()) == kSignature;
}

}  // namespace strake
