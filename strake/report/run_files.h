#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/core/fields.h"
#include "common/core/line_set.h"
#include "common/core/poly_mesh.h"
#include "common/core/tri_mesh.h"

namespace strake::report {

/// What files hold of one run.
struct RunFiles {
  std::string name;  ///< of the folder or target
  TriMesh mesh;
  QuadMesh quads;  ///< the result, made after all others
  std::optional<PrincipalField> field;
  std::optional<LineSet> lines;
  std::optional<TriMesh> coarse;               ///< on which the lines are, where not on `mesh`
  std::string field_content;                   ///< names the field; "" where there is none
  std::vector<nlohmann::ordered_json> stages;  ///< records, in the order they were run
  nlohmann::ordered_json seconds;              ///< by stage; null where nothing says
  std::vector<std::string> missing;            ///< sentences about what the report goes without

  [[nodiscard]] const TriMesh& line_mesh() const { return coarse ? *coarse : mesh; }
};

/// Reads the artifacts and stage reports of a folder, whatever their names: what `strake remesh
/// --keep` leaves, or files that a pipeline or the stages' programs wrote there.
///
/// Mesh and quads have to be there. Of several artifacts of a kind that one is taken which the
/// result was made from.
/// \throw InputError naming folder, kind and remedy where one is missing, ambiguous or damaged;
///        PreconditionError where they belong to different meshes
RunFiles read_run(const std::filesystem::path& folder);

/// The same from files wherever they are.
/// \param name     of the run, for messages too
/// \param files    artifacts and stage reports, by their ends .hdf and .json; others are left out
/// \param seconds  by stage, as `RunFiles` has them
RunFiles read_run(const std::string& name, const std::vector<std::filesystem::path>& files,
                  nlohmann::ordered_json seconds);

}  // namespace strake::report
