#pragma once

#include <string>
#include <vector>

namespace strake {

/// What artifacts say of the files they were made from, beside the files that are there: a line for
/// each that belongs to another mesh than those given ("foreign"), or was made from another file
/// than the one given for it ("stale"), with the remedy. Of what is not among the files nothing is
/// said.
/// \param files  artifacts and mesh files, sound
/// \throw InputError where one cannot be read
std::vector<std::string> broken_relations(const std::vector<std::string>& files);

}  // namespace strake
