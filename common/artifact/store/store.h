#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/artifact/provenance.h"
#include "common/artifact/store/file_stamp.h"

namespace strake {

/// The key of a result: the digest of how it was made (stage, stage version, resolved options,
/// digests of the inputs) and of the kind of file. Equal keys mean equal bytes.
std::string key_of(const Provenance& provenance, const std::string& file_extension);

/// Where a result lies in a store: "rocker-arm/trace-0123456789abcdef".
struct EntryName {
  std::string model;
  std::string stage;
  std::string key;

  [[nodiscard]] std::filesystem::path folder() const;
};

/// A result in a store, and how it came about.
struct Entry {
  std::string key;
  Provenance provenance;
  std::filesystem::path file;  ///< the artifact
  std::string digest;          ///< of the artifact
  std::string content;  ///< `content_digest` of the artifact: what depends on it goes by that
  FileStamp stamp;      ///< of the artifact, when its digest was last checked
  double seconds = 0;   ///< that making it took
  std::int64_t peak_bytes = 0;        ///< of memory
  std::vector<std::string> warnings;  ///< that its maker had for the user
};

/// A folder of results that people and machines share. Each entry is a folder of its own with the
/// artifact and, written last, a manifest: without a sound manifest there is no entry. Nothing is
/// ever changed in place, so readers need no locks.
class Store {
 public:
  enum class Check {
    stamp,    ///< read the artifact only where its stamp is not the recorded one
    content,  ///< read it always
  };

  enum class Access {
    full,
    look_only,  ///< note nothing, not even what is found out about files
  };

  explicit Store(std::filesystem::path root, Access access = Access::full)
      : root_(std::move(root)), access_(access) {}

  [[nodiscard]] Access access() const { return access_; }

  [[nodiscard]] const std::filesystem::path& root() const { return root_; }
  [[nodiscard]] std::filesystem::path folder(const EntryName& name) const {
    return root_ / name.folder();
  }
  /// For small things that belong to the store but to no entry: "runs", "digests".
  [[nodiscard]] std::filesystem::path side_folder(const std::string& name) const;

  /// \throw InputError where it is no folder, or a newer strake uses it, or nobody knows
  void check_format() const;
  /// \throw InputError where the folder is there, but holds no store: nothing may go from it
  void require_own() const;
  /// Makes the folder, and the file that says that it is a store, where they are missing.
  /// \throw InputError where that fails
  void prepare() const;

  /// The entry, if it is there and whole.
  /// \param damage  is told what is wrong where there is one that is not; may be nullptr
  [[nodiscard]] std::optional<Entry> find(const EntryName& name, Check check,
                                          std::string* damage = nullptr) const;
  /// Records an artifact that lies complete in the entry's folder; from now on it is there.
  void add(const EntryName& name, Entry& entry) const;
  /// Declares that an entry is not there where it is damaged, unless somebody is making it anew.
  void withdraw_if_damaged(const EntryName& name) const;

  /// What is in the store, for looking through it and cleaning up.
  struct Listed {
    std::filesystem::path folder;  ///< relative to the root
    std::optional<Entry> entry;    ///< nothing where its manifest is missing or unsound
    std::int64_t bytes = 0;        ///< of all files
    std::int64_t used_ns = 0;      ///< when it was last made or used
  };
  /// \param model  only its entries; "": all
  [[nodiscard]] std::vector<Listed> list(const std::string& model = "") const;
  /// Notes that the entry was of use, for `list`. Does nothing in a read-only store.
  void touch(const EntryName& name) const;
  /// Removes an entry, unless somebody is writing it. \return whether it is gone
  [[nodiscard]] bool remove(const std::filesystem::path& folder) const;
  /// Removes what an interrupted `remove` left behind.
  void empty_trash() const;

 private:
  std::filesystem::path root_;
  Access access_;
};

}  // namespace strake
