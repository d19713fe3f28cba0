#pragma once

#include <cstdint>

#include "common/core/wanted_count.h"
#include "strake/chain/session.h"

namespace strake {

/// The port of a result for a count: of what was fitted, of that without faces that crossed, or of
/// what came of these where their worst places were brought nearer.
const char* result_port(const Session& session);

/// Vertices or faces of the quads at a port.
std::int64_t count_of(const Session& session, const char* port, Counted counted);

/// Vertices of the input that were in its file, not those that import inserted.
std::int64_t given_vertex_count(const Session& session);

/// Whether the result was decimated and has nearly all vertices of the input: more than those
/// decimation does not give.
bool is_input_spent(const Session& session);

/// Corners of feature and boundary lines of the input.
Index corner_count(const Session& session);

}  // namespace strake
