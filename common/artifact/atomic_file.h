#pragma once

#include <cstddef>
#include <filesystem>

namespace strake {

/// Whether a file must survive a power cut, or may be empty then, which is much faster.
enum class Flush { yes, no };

/// Writes all of the bytes to an open file, in as many calls as it takes.
/// \return whether that worked; else errno says why not
bool write_all(int descriptor, const void* data, std::size_t size);

/// A file that appears under its name complete or not at all.
///
/// The caller writes to `temporary()`, closes it after checking every write, and calls `commit()`.
/// Without a commit (an exception, an interruption) the destructor removes the temporary file and
/// the target stays as it was. Two writers of one target do not disturb each other: the last wins.
class AtomicFile {
 public:
  /// Creates an empty temporary file in the folder of `target`; follows `target` if it is a link,
  /// also to what is not there yet.
  /// \throw InputError where that folder is missing or not writable, where `target` exists and is no
  ///        regular file, or where links lead in a circle
  explicit AtomicFile(const std::filesystem::path& target);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();

  /// The file as it was named, or what it is a link to.
  [[nodiscard]] const std::filesystem::path& target() const { return target_; }
  /// Where to write; the file exists and is empty, with the usual permissions.
  [[nodiscard]] const std::filesystem::path& temporary() const { return temporary_; }

  /// Flushes the temporary file to the disk and renames it to the target. Leaves the target and its
  /// time stamp alone where it holds the same bytes already.
  /// \return whether the target was replaced
  /// \throw InputError naming path and reason; the temporary file goes with this object
  bool commit(Flush flush = Flush::yes);

  /// Removes what all objects of this kind have written and not committed, and keeps them from
  /// going on: whoever tries waits for ever. For a program that ends at once, from any thread.
  static void abandon_all();

 private:
  std::filesystem::path target_;
  std::filesystem::path temporary_;
  bool pending_ = false;
};

}  // namespace strake
