#include "common/artifact/store/known_digests.h"

#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>

#include "common/artifact/digest.h"
#include "common/artifact/store/file_stamp.h"
#include "common/artifact/text_file.h"
#include "common/core/error.h"

namespace strake {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// A file written this shortly before it was read may be written again with the same time stamp:
/// clocks of file systems are coarse. Its digest is not remembered.
constexpr std::int64_t kTooFreshNs = 2'000'000'000;

Json to_json(const FileStamp& stamp) {
  return Json::array({stamp.size, stamp.modified_ns, stamp.changed_ns});
}

}  // namespace

std::optional<std::string> KnownDigests::find(const fs::path& file) {
  return stamp_of(file) ? std::optional(digest(file)) : std::nullopt;
}

std::string KnownDigests::digest(const fs::path& file) {
  const std::string name = fs::absolute(file).lexically_normal().string();
  const fs::path record = folder_ / (digest_text(name) + ".json");
  const std::optional<FileStamp> stamp = stamp_of(file);
  if (stamp) {
    std::ifstream stream(record);
    const Json known = Json::parse(stream, nullptr, false);
    if (known.is_object() && known.value("file", Json()) == name &&
        known.value("stamp", Json()) == to_json(*stamp) &&
        known.value("digest", Json()).is_string()) {
      return known["digest"];
    }
  }
  std::string digest = digest_file(file);
  const auto now = std::chrono::duration_cast<std::chrono::nanoseconds>(
                       std::chrono::system_clock::now().time_since_epoch())
                       .count();
  if (access_ == Store::Access::full && stamp && stamp_of(file) == stamp &&
      stamp->changed_ns < now - kTooFreshNs) {
    const Json known = {{"file", name}, {"stamp", to_json(*stamp)}, {"digest", digest}};
    try {
      write_text(record, known.dump(-1, ' ', false, Json::error_handler_t::replace), Flush::no);
    } catch (const InputError&) {
      return digest;  // remembering is a convenience: a store may be read-only
    }
  }
  return digest;
}

}  // namespace strake
