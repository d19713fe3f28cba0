#pragma once

#include <string>

#include "common/stage/value.h"

namespace strake {

/// What is wrong with a value that its type promises of every value; "" if nothing. Of mesh files,
/// opened meshes and what users add to a mesh it promises nothing.
/// Cost linear, a small part of making or reading the value.
std::string broken_invariant(const Value& value);

}  // namespace strake
