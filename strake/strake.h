#pragma once

/// \file
/// The library in one header: `remesh` for the whole chain in memory, each of its stages as a
/// function, reading and writing of mesh files, and surfaces to try things on. See docs/library.md.

#include "common/artifact/meshfile/mesh_reader.h"
#include "common/artifact/meshfile/mesh_writer.h"
#include "common/core/error.h"
#include "common/geometry/samples/samples.h"
#include "strake/chain/remesh.h"
