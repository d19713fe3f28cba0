#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/artifact/artifact.h"
#include "common/artifact/atomic_file.h"
#include "common/artifact/digest.h"
#include "common/artifact/hdf5_file.h"

/// What all kinds of artifacts share: root attributes, the group that viewers read, checks.
namespace strake {

/// An artifact being written; appears under its name at `commit`. Without a path there is no file,
/// only the digest of what it would hold.
class ArtifactWriter {
 public:
  ArtifactWriter(const std::filesystem::path& path, ArtifactKind kind, const std::string& mesh_id,
                 const Provenance& provenance);
  ArtifactWriter(ArtifactKind kind, const std::string& mesh_id);

  /// Writes a dataset of the artifact's own group.
  template <class Row>
  void own(const std::string& name, const std::vector<Row>& rows,
           hdf5::Layout layout = hdf5::Layout::table) {
    dataset(group_ + "/" + name, rows, layout);
  }
  /// Makes an own dataset visible to viewers under `shown`, e.g. "PointData/normal".
  void show(const std::string& name, const std::string& shown) {
    if (file_) file_->link(group_ + "/" + name, "/VTKHDF/" + shown);
  }
  /// Gives a dataset of the viewers' group a name in the own group.
  void adopt(const std::string& shown, const std::string& name) {
    if (file_) file_->link("/VTKHDF/" + shown, group_ + "/" + name);
  }
  /// Writes a dataset that only viewers need.
  template <class Row>
  void view(const std::string& shown, const std::vector<Row>& rows) {
    dataset("/VTKHDF/" + shown, rows);
  }
  /// Writes the cells that viewers show.
  /// \param connectivity  points of all cells, one after the other
  /// \param offsets       [cells + 1] into `connectivity`
  /// \param types         [cells] VTK cell types
  template <class Row>
  void grid(const std::vector<Vec3>& points, const std::vector<Row>& connectivity,
            const std::vector<Index>& offsets, const std::vector<std::uint8_t>& types) {
    dataset("/VTKHDF/Points", points);
    dataset("/VTKHDF/Connectivity", connectivity, hdf5::Layout::flat);
    dataset("/VTKHDF/Offsets", offsets);
    dataset("/VTKHDF/Types", types);
    counts(points.size(), types.size(), static_cast<std::size_t>(offsets.back()));
  }
  /// Writes the surface with one point per wedge, so that fields show their jumps at creases.
  void wedge_grid(const TriMesh& mesh);

  /// \pre there is a file
  bool commit();
  /// Of all that was written, as `content_digest` gives it.
  [[nodiscard]] std::string content() const { return content_.text(); }

 private:
  template <class Row>
  void dataset(const std::string& name, const std::vector<Row>& rows,
               hdf5::Layout layout = hdf5::Layout::table) {
    const std::uint64_t bytes = rows.size() * sizeof(Row);
    content_.add(name.c_str(), name.size() + 1);
    content_.add(&bytes, sizeof bytes);
    content_.add(rows.data(), bytes);
    if (file_) file_->dataset(name, rows, layout);
  }
  void counts(std::size_t points, std::size_t cells, std::size_t connectivity);

  std::optional<AtomicFile> target_;
  std::optional<hdf5::Writer> file_;
  std::string group_;
  Digest content_;  ///< of all but the provenance
};

/// Writes all that an artifact holds, of each kind.
/// \param mesh  the mesh a field or line set belongs to
void write_data(const TriMesh& mesh, ArtifactWriter& file);
void write_data(const TensorField& field, const TriMesh& mesh, ArtifactWriter& file);
void write_data(const PrincipalField& field, const TriMesh& mesh, ArtifactWriter& file);
void write_data(const LineSet& lines, const TriMesh& mesh, ArtifactWriter& file);
void write_data(const QuadMesh& quads, ArtifactWriter& file);
void write_data(const TensorPart& part, ArtifactWriter& file);
void write_data(const SizeField& size, const TriMesh& mesh, ArtifactWriter& file);

/// An artifact being read: kind and version are checked, datasets are checked as they are read.
class ArtifactReader {
 public:
  ArtifactReader(const std::filesystem::path& path, ArtifactKind kind);

  [[nodiscard]] const std::string& mesh_id() const { return mesh_id_; }
  template <class Row>
  [[nodiscard]] std::vector<Row> own(const std::string& name,
                                     hdf5::Layout layout = hdf5::Layout::table) const {
    return file_.dataset<Row>(group_ + "/" + name, layout);
  }
  /// Whether there is an own dataset of this name; most have to be there.
  [[nodiscard]] bool has(const std::string& name) const { return file_.has(group_ + "/" + name); }
  /// Rows of a dataset, for reading it in blocks.
  template <class Row>
  [[nodiscard]] std::int64_t row_count(const std::string& name,
                                       hdf5::Layout layout = hdf5::Layout::table) const {
    return file_.row_count<Row>(group_ + "/" + name, layout);
  }
  template <class Row>
  [[nodiscard]] std::vector<Row> own_rows(const std::string& name, Index first, Index count,
                                          hdf5::Layout layout = hdf5::Layout::table) const {
    return file_.rows<Row>(group_ + "/" + name, first, count, layout);
  }
  /// Refuses the dataset where `sound` is false.
  void require(bool sound, std::string_view name, std::string_view what) const {
    if (!sound) file_.refuse(group_ + "/" + std::string(name), std::string(what));
  }
  template <class Row>
  void require_rows(const std::vector<Row>& rows, std::size_t count, std::string_view name) const {
    require_row_count(rows.size(), count, name);
  }
  void require_row_count(std::size_t found, std::size_t wanted, std::string_view name) const {
    require(found == wanted, name,
            "has " + std::to_string(found) + " rows where " + std::to_string(wanted) + " belong");
  }
  /// Every number finite, of doubles, vectors or arrays of doubles.
  template <class Row>
  void require_finite(const std::vector<Row>& rows, std::string_view name) const {
    require_finite(reinterpret_cast<const double*>(rows.data()),
                   rows.size() * sizeof(Row) / sizeof(double), name);
  }
  /// Every index, or index of each row, in [low, high).
  template <class Row>
  void require_indices(const std::vector<Row>& rows, Index low, std::size_t high,
                       std::string_view name) const {
    require_indices(reinterpret_cast<const Index*>(rows.data()),
                    rows.size() * sizeof(Row) / sizeof(Index), low, high, name);
  }
  /// Offsets of runs: from 0 to `end`, each run at least `shortest` long.
  void require_offsets(const std::vector<Index>& offsets, std::size_t end, Index shortest,
                       std::string_view name) const;
  /// Codes of an enumeration or a flag below `end`.
  template <class Codes>
  void require_codes(const Codes& codes, int end, std::string_view name) const {
    for (const auto code : codes) require(static_cast<int>(code) < end, name, "has unknown codes");
  }

 private:
  void require_finite(const double* values, std::size_t count, std::string_view name) const;
  void require_indices(const Index* values, std::size_t count, Index low, std::size_t high,
                       std::string_view name) const;

  hdf5::Reader file_;
  std::string group_;
  std::string mesh_id_;
};

/// VTK's numbers for cell types.
inline constexpr std::uint8_t kVtkVertex = 1;
inline constexpr std::uint8_t kVtkPolyLine = 4;
inline constexpr std::uint8_t kVtkTriangle = 5;
inline constexpr std::uint8_t kVtkPolygon = 7;
inline constexpr std::uint8_t kVtkQuad = 9;

}  // namespace strake
