#pragma once

#include <string_view>

namespace strake::report {

/// The viewer's page, which `fill_page` fills; empty where this program was built without it.
std::string_view viewer_page();

}  // namespace strake::report
