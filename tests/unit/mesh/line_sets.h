#pragma once

#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include "common/core/line_set.h"
#include "common/core/tri_mesh.h"

namespace strake {

/// Appends a line through faces.
/// \param faces of the chords: one fewer than points, or as many where the line is closed
void add_line(LineSet& lines, const std::vector<LinePoint>& points, const std::vector<Index>& faces,
              LineFamily family = LineFamily::minimum);

/// Appends the lines where a function of space, linear on each face, is zero: closed ones and ones
/// that end at the boundary.
/// \pre no vertex where it is zero
void add_level_lines(const TriMesh& mesh, const std::function<double(const Vec3&)>& function,
                     LineFamily family, LineSet& lines);

/// Appends a closed curve that wanders at random and may cross itself.
/// \pre closed and connected
void add_random_loop(const TriMesh& mesh, int steps, std::mt19937_64& random, LineSet& lines);

/// Gives all wedges the same wanted distance of lines.
void set_spacing(const TriMesh& mesh, double spacing, LineSet& lines);

/// The lines whose number `keep` accepts.
LineSet subset(const LineSet& lines, const std::function<bool(Index)>& keep);

}  // namespace strake
