#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "common/artifact/meshfile/density_reader.h"
#include "common/artifact/meshfile/mesh_reader.h"
#include "common/artifact/provenance.h"
#include "common/core/edge_list.h"
#include "common/core/fields.h"
#include "common/core/guides.h"
#include "common/core/line_set.h"
#include "common/core/mesh_blocks.h"
#include "common/core/poly_mesh.h"
#include "common/core/tensor_part.h"
#include "common/core/tri_mesh.h"

/// What travels between stages, in memory and as files.
namespace strake {

/// A polygon mesh from a mesh file or from a quads artifact.
struct Polygons {
  PolyMesh mesh;
  std::string mesh_id;  ///< of the mesh it approximates; "" where the file does not say
  ReadReport read;      ///< what was wrong with the mesh file
};

/// A mesh artifact that is open and read as it is needed.
using OpenedMesh = std::shared_ptr<const MeshBlocks>;

using Value = std::variant<Polygons, TriMesh, TensorField, PrincipalField, LineSet, QuadMesh,
                           OpenedMesh, TensorPart, EdgeList, SizeField, DensityField, GuideLines>;

/// Kinds of values a stage takes or gives; `report` is none but the report itself, `opened_mesh` a
/// mesh artifact for a stage that needs less memory than all of it, `edge_list` a text file,
/// `density` a PLY file whose vertices have that property, `guides` polylines in an OBJ or PLY
/// file; the last three are only read.
enum class PortKind {
  polygons,
  mesh,
  tensor,
  field,
  lines,
  quads,
  opened_mesh,
  tensor_part,
  edge_list,
  size,
  density,
  guides,
  report
};

/// Reads a value from a file of the right kind, and checks what it promises.
/// \throw InputError where the file is missing, damaged or of another kind
Value load_value(PortKind kind, const std::filesystem::path& path);

/// Writes a value: artifacts, and quads also as .obj, .ply or .off as the extension says.
/// \param mesh  the mesh a field or line set belongs to; unused for others
/// \pre it is no OpenedMesh, EdgeList, DensityField or GuideLines, which stages only take
void save_value(const std::filesystem::path& path, const Value& value, const TriMesh* mesh,
                const Provenance& provenance);

/// `content_digest` of the artifact that `save_value` would write; "" of values that are none.
std::string content_of(const Value& value, const TriMesh* mesh);

/// What names of files for a value of this kind may end in; first what it is written as where
/// nobody says.
const std::vector<std::string>& output_extensions(PortKind kind);

/// \return what is wrong with how a file name ends, and the remedy; nothing: it is right
std::string check_extension(PortKind kind, const std::filesystem::path& path);

/// Refuses a file name that `save_value` could not write to, before any work is done. What is there
/// stays as it is.
/// \throw UsageError, InputError naming the file and a remedy
void check_output_path(PortKind kind, const std::filesystem::path& path);
/// Likewise, a file of any kind. \param role  what it is to the user: "output"
void check_place(const std::string& role, const std::filesystem::path& path);

/// The mesh a value belongs to; "" where it does not say. Of a TriMesh its own id.
std::string mesh_id_of(const Value& value);

/// The bounding-box diagonal of a mesh, of which lengths are shares; 0 of other values.
double diagonal_of(const Value& value);

/// Checks that a value was made for this mesh and fits it, so that its indices may be trusted.
/// \param mesh_name, name  files or ports for the message
/// \throw PreconditionError where it belongs to another mesh, InputError where it does not fit
void check_belongs(const TriMesh& mesh, const std::string& mesh_name, const Value& value,
                   const std::string& name);

/// Checks that a coarser mesh was made from the mesh that a value is, or belongs to, likewise.
void check_parent(const TriMesh& coarse, const std::string& coarse_name, const Value& value,
                  const std::string& name);

}  // namespace strake
