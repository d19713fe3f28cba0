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
#include "common/artifact/store/folder_lock.h"
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

/// Names of files and warnings may be no UTF-8: what is not is replaced.
std::string text_of(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

/// Digest of all that a manifest says, so that a damaged one is known from a sound one.
std::string seal_of(Json manifest) {
  manifest.erase("seal");
  return digest_text(text_of(manifest, -1));
}

std::string manifest_text(const Entry& entry) {
  Json json = {
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
  if (!entry.warnings.empty()) json["warnings"] = entry.warnings;
  json["seal"] = seal_of(json);
  return text_of(json, 1) + "\n";
}

/// \throw nlohmann::json::exception, InputError where the text is no manifest
Entry parse_manifest(const fs::path& folder, std::istream& stream) {
  const Json json = Json::parse(stream);
  if (json.at("seal") != seal_of(json)) throw InputError("its seal is broken");
  Entry entry;
  entry.key = json.at("key");
  entry.file = folder / fs::path(json.at("file").get<std::string>()).filename();
  entry.digest = json.at("digest");
  entry.content = json.at("content");
  entry.stamp = {json.at("size"), json.at("modified_ns"), json.at("changed_ns")};
  entry.provenance = Provenance::from_json(json.at("provenance").dump());
  entry.seconds = json.at("seconds");
  entry.peak_bytes = json.at("peak_bytes");
  entry.warnings = json.value("warnings", std::vector<std::string>());
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
  try {
    if (digest_file(entry.file) != entry.digest) return name + " has other bytes than recorded";
  } catch (const InputError& error) {
    return error.what();
  }
  entry.stamp = *stamp;
  return "";
}

/// Whether a folder below that of a model is one that `EntryName::folder` names.
bool is_entry_folder(const std::string& name) {
  const std::size_t dash = name.rfind('-');
  return dash != std::string::npos && dash > 0 && name.size() - dash - 1 == kKeyDigitsInName &&
         name.find_first_not_of("0123456789abcdef", dash + 1) == std::string::npos;
}

}  // namespace

std::string key_of(const Provenance& provenance, const std::string& file_extension) {
  return digest_text(provenance.to_json() + "\n" + file_extension);
}

fs::path EntryName::folder() const {
  return fs::path(model) / (stage + "-" + key.substr(0, kKeyDigitsInName));
}

fs::path Store::side_folder(const std::string& name) const { return root_ / ("." + name); }

void Store::check_format() const {
  std::error_code ignored;
  if (fs::exists(root_, ignored) && !fs::is_directory(root_, ignored)) {
    throw InputError(fmt::format("store '{}' is a file; name a folder", root_.string()));
  }
  std::ifstream stream(root_ / kFormatFile);
  if (!stream) return;
  const Json json = Json::parse(stream, nullptr, false);
  const Json format = json.is_object() ? json.value("format", Json()) : Json();
  if (format.is_null()) {
    throw InputError(
        fmt::format("'{}' is damaged: it does not say the format of the store; remove "
                    "it, and 'strake run' writes it again",
                    (root_ / kFormatFile).string()));
  }
  if (format != kStoreFormat) {
    throw InputError(
        fmt::format("store '{}' has format '{}', and this program knows {}: another version of "
                    "strake made it; use that one, or another store",
                    root_.string(), format.dump(), kStoreFormat));
  }
}

void Store::require_own() const {
  std::error_code ignored;
  if (!fs::exists(root_, ignored) || fs::exists(root_ / kFormatFile, ignored)) return;
  throw InputError(
      fmt::format("'{}' is no store: it has no '{}'; name another folder, or, where that file was "
                  "lost, have 'strake run' find results there: it writes the file again",
                  root_.string(), kFormatFile));
}

void Store::prepare() const {
  std::error_code error;
  fs::create_directories(side_folder("digests"), error);
  std::error_code ignored;
  if (!fs::is_directory(root_, ignored)) {
    throw InputError(fmt::format("store '{}' cannot be made: {}; check the rights, or name another",
                                 root_.string(), error.message()));
  }
  const fs::path format_file = root_ / kFormatFile;
  if (!fs::exists(format_file, error)) {
    write_text(format_file, Json{{"format", kStoreFormat}}.dump() + "\n");
  }
}

std::optional<Entry> Store::find(const EntryName& name, Check check, std::string* damage) const {
  std::optional<Entry> entry = read_manifest(folder(name), damage);
  if (!entry) return std::nullopt;
  if (entry->key != name.key) {
    if (damage != nullptr) *damage = "its manifest is that of another entry";
    return std::nullopt;
  }
  const FileStamp recorded = entry->stamp;
  const std::string fault = fault_of(*entry, check);
  if (!fault.empty()) {
    if (damage != nullptr) *damage = fault;
    return std::nullopt;
  }
  if (entry->stamp != recorded && access_ == Access::full) {
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

void Store::withdraw_if_damaged(const EntryName& name) const {
  const FolderLock lock(folder(name));
  if (!lock.is_held() || find(name, Check::content)) return;
  std::error_code error;
  fs::remove(folder(name) / kManifest, error);
  if (error) {
    throw InputError("store: cannot remove the damaged '" + folder(name).string() +
                     "': " + error.message() + "; check the rights");
  }
}

std::vector<Store::Listed> Store::list(const std::string& model) const {
  std::vector<fs::path> models;
  std::error_code ignored;
  if (!model.empty()) {
    models.push_back(root_ / model);
  } else {
    for (const auto& folder : fs::directory_iterator(root_, ignored)) {
      const bool is_side = folder.path().filename().string().front() == '.';
      if (!is_side) models.push_back(folder.path());
    }
  }
  std::vector<Listed> all;
  for (const fs::path& path : models) {
    for (const auto& folder : fs::directory_iterator(path, ignored)) {
      if (!folder.is_directory(ignored) || !is_entry_folder(folder.path().filename().string())) {
        continue;
      }
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

void Store::touch(const EntryName& name) const {
  if (access_ == Access::look_only) return;
  ::utimensat(AT_FDCWD, (folder(name) / kManifest).c_str(), nullptr, 0);
}

bool Store::remove(const fs::path& folder) const {
  const FolderLock lock(root_ / folder);
  if (!lock.is_held()) return false;
  const fs::path trash = side_folder("trash");
  std::error_code error;
  fs::create_directories(trash, error);
  // Out of sight in one step, so that nobody sees half an entry.
  const fs::path grave = trash / fmt::format("{}-{}-{}", folder.parent_path().string(),
                                             folder.filename().string(), ::getpid());
  // One of that name may be left: of a process that had the same number, or as somebody made a lock
  // in it while it went away.
  fs::remove_all(grave, error);
  fs::rename(root_ / folder, grave, error);
  if (error) {
    throw InputError("store: cannot remove '" + folder.string() + "': " + error.message());
  }
  fs::remove_all(grave, error);
  fs::remove((root_ / folder).parent_path(), error);  // the model's folder, once it is empty
  return true;
}

void Store::empty_trash() const {
  std::error_code ignored;
  for (const auto& grave : fs::directory_iterator(side_folder("trash"), ignored)) {
    fs::remove_all(grave.path(), ignored);
  }
}

}  // namespace strake
