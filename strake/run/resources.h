#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace strake {

/// What running a stage takes, as a line over the faces of the input and the vertices of the
/// result.
struct Resources {
  double bytes = 0;  ///< of memory
  double bytes_per_face = 0;
  double seconds = 0;
  double seconds_per_face = 0;
  std::int64_t threads = 0;     ///< 0: as many as there are, shared among what runs at once
  double bytes_per_vertex = 0;  ///< of the result
  double seconds_per_vertex = 0;

  [[nodiscard]] std::int64_t memory(double faces, double vertices) const;  ///< bytes
  [[nodiscard]] double time(double faces, double vertices) const;          ///< seconds
};

/// Measured needs of a stage's program, with a margin; of an unknown one a generous guess.
Resources default_resources(std::string_view program);

/// Vertices that a result within a tolerance has, roughly. \param share  of the diagonal
double vertices_within(double share);

/// "512MB", "2 GiB", "300B", "0". Nothing where the text is none of these: a number without a unit
/// may mean anything.
std::optional<double> parse_bytes(std::string_view text);
/// "90s", "10min", "2h", "15us", "0", likewise.
std::optional<double> parse_seconds(std::string_view text);
std::string bytes_text(double bytes);      ///< "1.5 GB"
std::string seconds_text(double seconds);  ///< "75 ms", "1.5 s", "12 min"

/// A rough count of the faces of a mesh file, never far too low, from its size alone.
double estimated_faces(std::int64_t file_bytes, std::string_view file_extension);

}  // namespace strake
