#include "common/stage/build_facts.h"

namespace strake {

std::string version_text(const std::string& program) {
  return program + " " STRAKE_VERSION "\nbuilt by " STRAKE_COMPILER ", " STRAKE_BUILD_TYPE
                   "\nwith " STRAKE_LIBRARIES;
}

}  // namespace strake
