#pragma once

#include <string>
#include <vector>

namespace strake {

/// An artifact that does not belong to another file beside it.
struct BrokenRelation {
  std::string file;
  std::string other;
  std::string text;  ///< for the user, with the remedy
};

/// What artifacts say of the files they were made from, beside the files that are there: one for
/// each that belongs to another mesh than those given ("foreign"), or was made from another file
/// than the one given for it ("stale"), with the remedy. Of what is not among the files nothing is
/// said.
/// \param files  artifacts and mesh files, sound
/// \throw InputError where one cannot be read
std::vector<BrokenRelation> broken_relations(const std::vector<std::string>& files);

}  // namespace strake
