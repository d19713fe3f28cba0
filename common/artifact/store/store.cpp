#include "common/artifact/store/store.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <system_error>

#include "common/artifact/digest.h"
#include "common/artifact/store/entry_lock.h"
#include "common/artifact/text_file.h"
#include "common/core/error.h"

namespace strake {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int kStoreFormat = 1;
constexpr const char* kManifest = "manifest.json";
constexpr const char* kFormatFile = "strake-store.json";
constexpr std::size_t kKeyDigitsInName = 16;

std::string manifest_text(const Entry& entry) {
  const Json json = {
      {"key", entry.key},
      {"file", entry.file.filename().string()},
      {"digest", entry.digest},
      {"content", entry.content},
      {"size", entry.stamp.size},
      {"modified_ns", entry.stamp.modified_ns},
      {"changed_ns", entry.stamp.changed_ns},
      {"provenance", Json::parse(entry.provenance.to_json())},
      {"seconds", entry.seconds},
      {"peak_bytes", entry.peak_bytes},
  };
  return json.dump(1) + "\n";
}

/// \throw nlohmann::json::exception, InputError where the text is no manifest
Entry parse_manifest(const fs::path& folder, std::istream& stream) {
  const Json json = Json::parse(stream);
  Entry entry;
  entry.key = json.at("key");
  entry.file = folder / fs::path(json.at("file").get<std::string>()).filename();
  entry.digest = json.at("digest");
  entry.content = json.at("content");
  entry.stamp = {json.at("size"), json.at("modified_ns"), json.at("changed_ns")};
  entry.provenance = Provenance::from_json(json.at("provenance").dump());
  entry.seconds = json.at("seconds");
  entry.peak_bytes = json.at("peak_bytes");
  return entry;
}

/// Nothing where there is no manifest; says in `damage` where there is an unsound one.
std::optional<Entry> read_manifest(const fs::path& folder, std::string* damage) {
  std::ifstream stream(folder / kManifest);
  if (!stream) return std::nullopt;
  try {
    return parse_manifest(folder, stream);
  } catch (const std::exception& error) {
    if (damage != nullptr) *damage = fmt::format("its manifest cannot be read ({})", error.what());
    return std::nullopt;
  }
}

/// What is wrong with the artifact of an entry; "" if nothing. Brings the stamp up to date.
std::string fault_of(Entry& entry, Store::Check check) {
  const std::optional<FileStamp> stamp = stamp_of(entry.file);
  const std::string name = entry.file.filename().string();
  if (!stamp) return name + " is missing";
  if (stamp->size != entry.stamp.size) {
    return fmt::format("{} has {} bytes instead of {}", name, stamp->size, entry.stamp.size);
  }
  if (check == Store::Check::stamp && stamp == entry.stamp) return "";
  if (digest_file(entry.file) != entry.digest) return name + " has other bytes than recorded";
  entry.stamp = *stamp;
  return "";
}

}  // namespace

std::string key_of(const Provenance& provenance, const std::string& file_extension) {
  return digest_text(provenance.to_json() + "\n" + file_extension);
}

fs::path EntryName::folder() const {
  return fs::path(model) / (stage + "-" + key.substr(0, kKeyDigitsInName));
}

fs::path Store::side_folder(const std::string& name) const { return root_ / ("." + name); }

void Store::prepare() const {
  const fs::path format_file = root_ / kFormatFile;
  std::ifstream stream(format_file);
  if (stream) {
    const Json json = Json::parse(stream, nullptr, false);
    const int format = json.is_object() ? json.value("format", 0) : 0;
    if (format < 1 || format > kStoreFormat) {
      throw InputError(
          fmt::format("store '{}' has format {}, and this program knows {}: a newer "
                      "strake made it; update this one, or use another store",
                      root_.string(), format, kStoreFormat));
    }
  }
  std::error_code error;
  fs::create_directories(side_folder("digests"), error);
  if (!fs::is_directory(root_)) {
    throw InputError(fmt::format("store '{}' cannot be made: {}; check the rights, or name another",
                                 root_.string(), error.message()));
  }
  if (!stream) write_text(format_file, Json{{"format", kStoreFormat}}.dump() + "\n");
}

std::optional<Entry> Store::find(const EntryName& name, Check check, std::string* damage) const {
  std::optional<Entry> entry = read_manifest(folder(name), damage);
  if (!entry) return std::nullopt;
  if (entry->key != name.key) return std::nullopt;  // another key with the same first digits
  const FileStamp recorded = entry->stamp;
  const std::string fault = fault_of(*entry, check);
  if (!fault.empty()) {
    if (damage != nullptr) *damage = fault;
    return std::nullopt;
  }
  if (entry->stamp != recorded) {
    try {  // e.g. after the store was copied: remember that the bytes are right
      write_text(folder(name) / kManifest, manifest_text(*entry));
    } catch (const InputError&) {
      return entry;  // a read-only store is read again next time
    }
  }
  return entry;
}

void Store::add(const EntryName& name, Entry& entry) const {
  const std::optional<FileStamp> stamp = stamp_of(entry.file);
  if (!stamp) throw InputError("store: '" + entry.file.string() + "' has vanished; run again");
  entry.key = name.key;
  entry.stamp = *stamp;
  write_text(folder(name) / kManifest, manifest_text(entry));
}

void Store::withdraw(const EntryName& name) const {
  std::error_code error;
  fs::remove(folder(name) / kManifest, error);
  if (error) {
    throw InputError("store: cannot remove the damaged '" + folder(name).string() +
                     "': " + error.message() + "; check the rights");
  }
}

std::vector<Store::Listed> Store::list() const {
  std::vector<Listed> all;
  std::error_code ignored;
  for (const auto& model : fs::directory_iterator(root_, ignored)) {
    const bool is_side = model.path().filename().string().front() == '.';
    if (!model.is_directory(ignored) || is_side) continue;
    for (const auto& folder : fs::directory_iterator(model.path(), ignored)) {
      if (!folder.is_directory(ignored)) continue;
      Listed listed;
      listed.folder = folder.path().lexically_relative(root_);
      listed.entry = read_manifest(folder.path(), nullptr);
      for (const auto& file : fs::directory_iterator(folder.path(), ignored)) {
        const std::optional<FileStamp> stamp = stamp_of(file.path());
        if (!stamp) continue;
        listed.bytes += stamp->size;
        listed.used_ns = std::max(listed.used_ns, stamp->modified_ns);
      }
      all.push_back(std::move(listed));
    }
  }
  std::sort(all.begin(), all.end(),
            [](const Listed& a, const Listed& b) { return a.folder < b.folder; });
  return all;
}

void Store::touch(const Entry& entry) const {
  ::utimensat(AT_FDCWD, (entry.file.parent_path() / kManifest).c_str(), nullptr, 0);
}

bool Store::remove(const fs::path& folder) const {
  const EntryLock lock(root_ / folder);
  if (!lock.is_held()) return false;
  const fs::path trash = side_folder("trash");
  std::error_code error;
  fs::create_directories(trash, error);
  // Out of sight in one step, so that nobody sees half an entry.
  const fs::path grave = trash / fmt::format("{}-{}", folder.filename().string(), ::getpid());
  fs::rename(root_ / folder, grave, error);
  if (error) {
    throw InputError("store: cannot remove '" + folder.string() + "': " + error.message());
  }
  fs::remove_all(grave, error);
  fs::remove((root_ / folder).parent_path(), error);  // the model's folder, once it is empty
  return true;
}

}  // namespace strake
