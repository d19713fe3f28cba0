#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/core/line_set.h"
#include "common/core/tri_mesh.h"
#include "common/core/types.h"
#include "strake/chain/goal_stages.h"
#include "strake/chain/line_aim.h"
#include "strake/chain/session.h"

/// The steps of which the ways to a goal consist (goals.h). Each works on the results that the
/// session has, and changes the scale of distances that the stage trace has as an option.
namespace strake {

/// Traces anew: "lines". There are no cells then.
void trace_anew(Session& session, const GoalStages& stages);

/// Traces and makes cells anew: "lines" and "quads".
void trace_and_mesh(Session& session, const GoalStages& stages);

/// Traces and makes cells anew, and fits and keeps the result: "fitted".
void trace_mesh_and_fit(Session& session, const GoalStages& stages);

/// How much work it is to make cells of lines.
struct LineLoad {
  /// Nodes that they have at most, unless lines of one family cross each other: where they cross
  /// feature and boundary lines, and in each face the chords of one family times those of the
  /// other.
  std::int64_t nodes = 0;
  /// Chords of one family in the face that has most: lines that wind around a spike cross nothing.
  std::int64_t fullest_face = 0;
};
LineLoad load_of(const TriMesh& mesh, const LineSet& lines);

/// Makes cells of the present lines anew, with strips of quads split or taken out for the count.
void mesh_with_strips(Session& session, const GoalStages& stages, const LineAim& aim);

/// Keeps lines, cells and the fitted result as they are.
void keep_fitted(Session& session, const GoalStages& stages);

/// Fits as many rounds as show which cells are worst.
void fit_before_dividing(Session& session, const GoalStages& stages);

/// Fits the refined result once more.
void fit_refined(Session& session, const GoalStages& stages);

/// Sets the scale of all distances, within what it may be.
void scale_lines(const GoalStages& stages, double scale);
/// The factor on all distances between lines; 1 where none is given.
double line_scale(const GoalStages& stages);

/// Wants distances for even errors, and corrects the scale of all of them by the count.
/// \pre traced and meshed
void feed_back(Session& session, const GoalStages& stages, const LineAim& aim);

/// Traces again at distances for even errors, with about as many lines as there are.
/// \pre traced and meshed
/// \return how far those were off: the root mean square of the distance, in mean cell lengths
double even_out(Session& session, const GoalStages& stages);

/// Traces lines, and wants closer ones where a result of them is farther from the surface than a
/// tolerance allows.
void shrink_to_tolerance(Session& session, const GoalStages& stages, const std::string& tolerance);

/// Wants lines closer around some places, and elsewhere as they are: on the way to a tolerance.
/// \param factor  on distances there, from 0 to 1
void want_closer_only_there(Session& session, const GoalStages& stages,
                            const std::vector<Vec3>& places, double factor);

/// Likewise where a count is wanted, which scales all distances: elsewhere they keep their ratios.
void want_relatively_closer(Session& session, const std::vector<Vec3>& places, double factor);

/// Likewise where no count scales them: scales all distances so that there are about as many cells.
void want_closer_for_as_many(Session& session, const GoalStages& stages,
                             const std::vector<Vec3>& places, double factor);

}  // namespace strake
