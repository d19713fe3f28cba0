#include <array>
#include <cstddef>
#include <limits>
#include <memory>
#include <utility>

#include "common/artifact/artifact_file.h"

namespace strake {
namespace {

using Three = std::array<Index, 3>;
using ThreeFlags = std::array<std::uint8_t, 3>;

/// Rows of a dataset, which must not be more than indices can count half-edges of.
template <class Row>
Index count_rows(const ArtifactReader& file, const char* name,
                 hdf5::Layout layout = hdf5::Layout::table) {
  const std::int64_t count = file.row_count<Row>(name, layout);
  file.require(count <= std::numeric_limits<Index>::max() / 3, name, "claims an impossible size");
  return static_cast<Index>(count);
}

/// Reads the header and checks that all arrays fit together.
MeshBlocks::Header read_header(const ArtifactReader& file) {
  MeshBlocks::Header header;
  header.id = file.mesh_id();
  header.vertices = count_rows<Vec3>(file, "positions");
  header.faces = count_rows<Three>(file, "faces", hdf5::Layout::flat);
  header.wedges = count_rows<Index>(file, "wedge_vertex");
  const auto require_face_rows = [&](std::int64_t rows, const char* name) {
    file.require_row_count(static_cast<std::size_t>(rows), static_cast<std::size_t>(header.faces),
                           name);
  };
  require_face_rows(file.row_count<Three>("face_wedges"), "face_wedges");
  require_face_rows(file.row_count<Three>("twin", hdf5::Layout::flat), "twin");
  require_face_rows(file.row_count<ThreeFlags>("is_feature", hdf5::Layout::flat), "is_feature");
  const auto diagonal = file.own<double>("diagonal");
  file.require_rows(diagonal, 1, "diagonal");
  file.require_finite(diagonal, "diagonal");
  file.require(diagonal.front() > 0, "diagonal", "is not positive");
  header.diagonal = diagonal.front();
  return header;
}

/// Blocks of a mesh artifact; keeps the file open.
class ArtifactMeshBlocks : public MeshBlocks {
 public:
  explicit ArtifactMeshBlocks(std::unique_ptr<const ArtifactReader> file)
      : MeshBlocks(read_header(*file)), file_(std::move(file)) {}

  [[nodiscard]] std::vector<Vec3> positions(Index first, Index count) const override {
    auto rows = file_->own_rows<Vec3>("positions", first, count);
    file_->require_finite(rows, "positions");
    return rows;
  }
  [[nodiscard]] std::vector<Index> wedge_vertex(Index first, Index count) const override {
    return indices<Index>("wedge_vertex", first, count, 0, header().vertices);
  }
  [[nodiscard]] std::vector<Three> faces(Index first, Index count) const override {
    return indices<Three>("faces", first, count, 0, header().vertices, hdf5::Layout::flat);
  }
  [[nodiscard]] std::vector<Three> face_wedges(Index first, Index count) const override {
    return indices<Three>("face_wedges", first, count, 0, header().wedges);
  }
  [[nodiscard]] std::vector<Three> twin(Index first, Index count) const override {
    return indices<Three>("twin", first, count, kNone, 3 * header().faces, hdf5::Layout::flat);
  }
  [[nodiscard]] std::vector<ThreeFlags> is_feature(Index first, Index count) const override {
    auto rows = file_->own_rows<ThreeFlags>("is_feature", first, count, hdf5::Layout::flat);
    for (const ThreeFlags& flags : rows) file_->require_codes(flags, 2, "is_feature");
    return rows;
  }

 private:
  template <class Row>
  [[nodiscard]] std::vector<Row> indices(const char* name, Index first, Index count, Index low,
                                         Index high,
                                         hdf5::Layout layout = hdf5::Layout::table) const {
    auto rows = file_->own_rows<Row>(name, first, count, layout);
    file_->require_indices(rows, low, static_cast<std::size_t>(high), name);
    return rows;
  }

  std::unique_ptr<const ArtifactReader> file_;
};

}  // namespace

std::shared_ptr<const MeshBlocks> open_tri_mesh(const std::filesystem::path& path) {
  return std::make_shared<ArtifactMeshBlocks>(
      std::make_unique<const ArtifactReader>(path, ArtifactKind::mesh));
}

}  // namespace strake
