#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/poly_mesh.h"
#include "common/core/report.h"

namespace strake {

/// What was found in a mesh file, and what had to be left out.
struct ReadReport {
  std::string format;              ///< as recognised, "PLY, binary little-endian"
  bool extension_differs = false;  ///< the file name promises another format

  std::int64_t non_finite_vertices = 0;  ///< coordinates that are no finite numbers; kept as NaN
  std::int64_t bad_index_faces = 0;      ///< skipped: name a vertex that is not there
  std::int64_t few_corner_faces = 0;     ///< skipped: fewer than three corners
  std::int64_t non_finite_faces = 0;     ///< skipped: use a non-finite vertex
  std::int64_t missing_vertices = 0;     ///< announced but not in the file
  std::int64_t missing_faces = 0;        ///< announced but not in the file, or cut off
  std::int64_t unannounced_faces = 0;    ///< STL: read beyond the number that the file announces
  std::int64_t left_out_faces = 0;       ///< in the file, beyond the number that it announces
  std::int64_t skipped_lines = 0;        ///< text that is not understood
  std::int64_t untextured_corners = 0;   ///< at (0, 0), where others have texture coordinates
  std::int64_t welded_vertices = 0;  ///< STL: corners merged because their coordinates are equal

  /// One sentence for each thing that is wrong with the file; empty for a sound one.
  [[nodiscard]] std::vector<std::string> warnings() const;
  /// Adds the counts (keys "file.*") and the warnings to a stage's report.
  void add_to(Report& report) const;
};

/// Reads a polygon mesh: OBJ, PLY (ascii and binary, also triangle strips), OFF or STL.
///
/// The format is recognised by content, then by extension. Coordinates keep their full precision.
/// Vertices stay in the order of the file and are all kept; STL corners of equal coordinates become
/// one vertex. Colours, texture coordinates and labels of faces are read from OBJ (`v x y z r g b`,
/// `vt`, `o`, `g`, `usemtl`) and PLY (properties red, green, blue, alpha and s, t or u, v of
/// vertices; texcoord and integers of faces with one of the names in docs/import.md); where some
/// elements lack what others have, they are white, at (0, 0), or have the label "". Faces that
/// cannot be used are skipped and counted; a truncated file yields what is complete.
/// \throw InputError naming the file where it cannot be read, is of no known format, or holds no
///        usable face
/// Cost O(bytes); memory is bounded by the size of the file, whatever counts it announces.
PolyMesh read_mesh(const std::filesystem::path& path, ReadReport& report);

/// As read_mesh, from bytes in memory.
/// \param extension  with its dot, ".ply"; used where the content does not tell; may be empty
PolyMesh parse_mesh(std::string_view bytes, std::string_view extension, ReadReport& report);

}  // namespace strake
