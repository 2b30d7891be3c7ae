#pragma once

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace traverse::files {

class Temporary;

/// A file that appears whole or not at all: written under a temporary name beside its place and
/// renamed by commit(). Without commit() nothing is left behind, by a signal neither
/// (remove_unfinished), and what a killed program left goes when the next one writes in the folder.
///
/// Through a symbolic link the file that it names is replaced. A device or a pipe (/dev/stdout) is
/// written to as it is, since it cannot be replaced.
class AtomicFile {
 public:
  /// Opens the temporary file for binary writing.
  /// \throws OutputError if the folder does not exist or does not allow it.
  explicit AtomicFile(std::filesystem::path path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// The stream to write to. Failures are sticky and reported by commit().
  std::ostream& stream() { return stream_; }

  /// The temporary file, for libraries that must open it by name. Close stream() use before.
  const std::filesystem::path& temporary_path() const;

  /// Flushes, closes and checks that every byte was taken (disk full).
  /// \throws OutputError naming the path and the system's reason.
  void finish();

  /// finish(), if that has not been done, and the rename. \throws OutputError
  void commit();

 private:
  std::filesystem::path path_;
  std::unique_ptr<Temporary> temporary_;  ///< none of a device
  std::ofstream stream_;                  ///< closed before the temporary is removed
};

/// Files that belong together: none appears before all of them are whole, and then one right after
/// the other.
class AtomicFiles {
 public:
  /// Adds a file. \throws OutputError
  AtomicFile& add(const std::filesystem::path& path);
  /// Adds one with this text as the whole of it. \throws OutputError
  void write(const std::filesystem::path& path, std::string_view text);
  /// \throws OutputError; before the first rename if a file is not whole.
  void commit();

 private:
  std::vector<std::unique_ptr<AtomicFile>> files_;
};

/// A folder that appears whole or not at all: filled under a temporary name beside its place and
/// renamed by commit(). Without commit() nothing is left behind, as of an AtomicFile.
class AtomicFolder {
 public:
  /// \param earlier the names in `path` that are an earlier result, to be replaced at commit() by
  /// one step; what else may have come into the folder by then is kept and is in the new one.
  /// \throws OutputError if `path` is there already and not an empty folder, and `earlier` is
  /// empty; or if its parent does not exist or does not allow it.
  explicit AtomicFolder(std::filesystem::path path, std::vector<std::string> earlier = {});
  ~AtomicFolder();
  AtomicFolder(const AtomicFolder&) = delete;
  AtomicFolder& operator=(const AtomicFolder&) = delete;

  /// Where the files go until commit().
  const std::filesystem::path& temporary_path() const;

  /// \throws OutputError naming the path and the system's reason.
  void commit();

 private:
  void remove_earlier(const std::filesystem::path& replaced) const;

  std::filesystem::path path_;
  std::vector<std::string> earlier_;
  std::unique_ptr<Temporary> temporary_;
};

/// Writes `text` as the whole of `path`, atomically. \throws OutputError
void write_text(const std::filesystem::path& path, std::string_view text);

/// Creates `folder` with its parents if missing, and checks that files can be made in it.
/// \throws OutputError otherwise.
void make_writable_folder(const std::filesystem::path& folder);

}  // namespace traverse::files
