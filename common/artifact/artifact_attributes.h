#pragma once

#include "common/artifact/artifact_file.h"
#include "common/core/attributes.h"

namespace strake {

/// Adds what is there of the attributes to a mesh or quads artifact.
void write_attributes(const Attributes& attributes, ArtifactWriter& file);

/// \throw InputError naming file and dataset where sizes or numbers are not what they must be
Attributes read_attributes(const ArtifactReader& file, std::size_t vertices, std::size_t corners,
                           std::size_t faces);

}  // namespace strake
