#include "strake/report/page.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "common/core/error.h"

namespace strake::report_test {
namespace {

using namespace report;

constexpr char kViewer[] = "<script id=a>%STRAKE_REPORT%</script><script>%STRAKE_BLOCKS%</script>";

TEST(ReportPage, NoStringEndsTheScriptItIsIn) {
  for (const std::string text :
       {"</script><script>alert(1)</script>", "<!-- <script>", "%STRAKE_BLOCKS%", "a\\\"<b>&amp;",
        "\u00e9 \u2028 <", "<<</SCRIPT >"}) {
    const nlohmann::json json = {{"name", text}};
    const std::string safe = script_safe(json.dump());
    EXPECT_EQ(safe.find('<'), std::string::npos) << safe;
    EXPECT_EQ(nlohmann::json::parse(safe), json);
    const std::string page = fill_page(kViewer, {safe, "QUJD"});
    EXPECT_EQ(page, "<script id=a>" + safe + "</script><script>QUJD</script>");
  }
}

TEST(ReportPage, WantsEachMarkOnce) {
  EXPECT_THROW(fill_page("", {"{}", ""}), PreconditionError);
  EXPECT_THROW(fill_page("%STRAKE_REPORT%", {"{}", ""}), PreconditionError);
  EXPECT_THROW(fill_page(std::string(kViewer) + kViewer, {"{}", ""}), PreconditionError);
}

}  // namespace
}  // namespace strake::report_test
