#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>

namespace strake::bench {

/// What a yardstick throws: a file it cannot read or write, or a surface it does not take.
struct DecimationError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Reads a mesh file with OpenMesh and does nothing else; returns the number of its vertices.
std::size_t read_only(const std::string& input);

/// Decimates by OpenMesh's quadrics (its decimater with ModQuadric alone) to a number of vertices,
/// from file to file; returns the number reached. Vertices that no face uses do not count.
std::size_t decimate_by_quadrics(const std::string& input, const std::string& output,
                                 std::size_t vertices);

/// The same by CGAL's edge collapse with the cost and placement of Lindstrom and Turk.
std::size_t decimate_by_lindstrom_turk(const std::string& input, const std::string& output,
                                       std::size_t vertices);

}  // namespace strake::bench
