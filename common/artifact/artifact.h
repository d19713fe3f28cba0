#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "common/artifact/provenance.h"
#include "common/core/fields.h"
#include "common/core/line_set.h"
#include "common/core/mesh_blocks.h"
#include "common/core/poly_mesh.h"
#include "common/core/tensor_part.h"
#include "common/core/tri_mesh.h"

/// The files that stages hand to each other; FORMAT.md specifies them.
namespace strake {

enum class ArtifactKind { mesh, tensor, field, lines, quads, tensor_part, size };

/// "mesh", "tensor", ... as in the file.
std::string kind_name(ArtifactKind kind);

/// Newest format this program writes and reads; older ones stay readable.
inline constexpr std::int64_t kFormatVersion = 3;

/// Writes an artifact atomically; equal values give equal bytes, and an equal file is not touched.
///
/// `mesh` is the mesh a field or line set belongs to: it gives the picture that viewers show.
/// \return whether the file was replaced
/// \throw InputError naming the file where it cannot be written; the old file is intact then
bool write_artifact(const std::filesystem::path& path, const TriMesh& mesh,
                    const Provenance& provenance);
bool write_artifact(const std::filesystem::path& path, const TensorField& field,
                    const TriMesh& mesh, const Provenance& provenance);
bool write_artifact(const std::filesystem::path& path, const PrincipalField& field,
                    const TriMesh& mesh, const Provenance& provenance);
bool write_artifact(const std::filesystem::path& path, const LineSet& lines, const TriMesh& mesh,
                    const Provenance& provenance);
bool write_artifact(const std::filesystem::path& path, const QuadMesh& quads,
                    const Provenance& provenance);
bool write_artifact(const std::filesystem::path& path, const TensorPart& part,
                    const Provenance& provenance);
bool write_artifact(const std::filesystem::path& path, const SizeField& size, const TriMesh& mesh,
                    const Provenance& provenance);

/// `content_digest` of the file that `write_artifact` would make, without making it.
std::string content_of(const TriMesh& mesh);
std::string content_of(const TensorField& field, const TriMesh& mesh);
std::string content_of(const PrincipalField& field, const TriMesh& mesh);
std::string content_of(const LineSet& lines, const TriMesh& mesh);
std::string content_of(const QuadMesh& quads);
std::string content_of(const TensorPart& part);
std::string content_of(const SizeField& size, const TriMesh& mesh);

/// Reads an artifact back exactly as it was written.
/// \throw InputError naming file and dataset where the file is missing, damaged, of another kind or
///        newer than this program, or where sizes, indices or numbers are not what they must be
TriMesh read_tri_mesh(const std::filesystem::path& path);
TensorField read_tensor_field(const std::filesystem::path& path);
PrincipalField read_principal_field(const std::filesystem::path& path);
LineSet read_line_set(const std::filesystem::path& path);
QuadMesh read_quad_mesh(const std::filesystem::path& path);
TensorPart read_tensor_part(const std::filesystem::path& path);
SizeField read_size_field(const std::filesystem::path& path);

/// Opens a mesh artifact to be read in blocks. Shapes are checked at once, numbers and indices when
/// they are read; whether twins and wedges agree with the faces is left to the caller.
/// \throw InputError, now and while reading, as `read_tri_mesh`
std::shared_ptr<const MeshBlocks> open_tri_mesh(const std::filesystem::path& path);

/// What an artifact says about itself without reading its data.
struct ArtifactInfo {
  struct Dataset {
    std::string name;  ///< full path in the file
    std::int64_t rows = 0;
    std::int64_t columns = 1;
    std::string type;  ///< "u8", "i32", "i64", "f64"
  };
  ArtifactKind kind = ArtifactKind::mesh;
  std::int64_t format_version = kFormatVersion;
  std::string mesh_id;
  std::string content;        ///< `content_digest`
  bool says_content = false;  ///< in a file from before there was that, it is `digest_file`
  Provenance provenance;
  std::vector<Dataset> datasets;  ///< of the artifact's own group
};

/// \throw InputError where the file is no artifact, damaged, or newer than this program
ArtifactInfo read_artifact_info(const std::filesystem::path& path);

/// Reads what only viewers read of an artifact, for its checksums.
/// \throw InputError naming file and dataset where it is damaged
void check_picture(const std::filesystem::path& path);

/// Names what a file says: of an artifact the digest of its data, however it was made; of another
/// file `digest_file`. Stages note it of their inputs, so that what comes out the same in another
/// way changes nothing further on.
/// \throw InputError where the file cannot be read
std::string content_digest(const std::filesystem::path& path);

/// Whether the file begins as an HDF5 file does; false where it cannot be read.
bool is_artifact(const std::filesystem::path& path);

}  // namespace strake
