// Any bytes as the files that go with a mesh: a list of edges, guides and a density.

#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "common/artifact/edge_list_file.h"
#include "common/artifact/meshfile/density_reader.h"
#include "common/artifact/meshfile/guide_reader.h"
#include "common/core/error.h"

namespace {

template <class Parse>
void parse(const Parse& parse) {
  try {
    parse();
  } catch (const strake::InputError&) {  // refused
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  parse([&] { (void)strake::parse_edge_list(bytes, "edges"); });
  parse([&] { (void)strake::parse_guides(bytes, "guides"); });
  parse([&] {
    for (const double density : strake::parse_density(bytes).value) {
      if (!(density > 0)) std::abort();
    }
  });
  return 0;
}
