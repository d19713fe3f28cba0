// Yardsticks for the benches: decimates a triangle mesh with other libraries, or only reads it.

#include <cstdio>
#include <exception>
#include <string>

#include "tests/bench/decimate/decimate.h"

namespace {

int usage() {
  std::fputs(
      "usage: strake-bench-decimate read INPUT\n"
      "       strake-bench-decimate quadrics|lindstrom-turk INPUT OUTPUT VERTICES\n",
      stderr);
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string method = argc > 1 ? argv[1] : "";
  try {
    std::size_t vertices = 0;
    if (method == "read" && argc == 3) {
      vertices = strake::bench::read_only(argv[2]);
    } else if (method == "quadrics" && argc == 5) {
      vertices = strake::bench::decimate_by_quadrics(argv[2], argv[3], std::stoul(argv[4]));
    } else if (method == "lindstrom-turk" && argc == 5) {
      vertices = strake::bench::decimate_by_lindstrom_turk(argv[2], argv[3], std::stoul(argv[4]));
    } else {
      return usage();
    }
    std::printf("%zu\n", vertices);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "strake-bench-decimate: error: %s\n", error.what());
    return 1;
  }
}
