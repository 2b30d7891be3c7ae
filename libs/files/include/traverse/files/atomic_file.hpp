#pragma once

#include <filesystem>
#include <fstream>
#include <memory>
#include <string_view>

namespace traverse::files {

class Temporary;

/// A file that appears whole or not at all: written under a temporary name beside its place and
/// renamed by commit(). Without commit() nothing is left behind, by a signal neither
/// (remove_unfinished), and what a killed program left goes when the next one writes in the folder.
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

  /// Flushes, checks that every byte was taken (disk full), and renames.
  /// \throws OutputError naming the path and the system's reason.
  void commit();

 private:
  std::filesystem::path path_;
  std::unique_ptr<Temporary> temporary_;
  std::ofstream stream_;  ///< closed before the temporary is removed
};

/// A folder that appears whole or not at all: filled under a temporary name beside its place and
/// renamed by commit(). Without commit() nothing is left behind, as of an AtomicFile.
class AtomicFolder {
 public:
  /// \throws OutputError if `path` is there already and not an empty folder, or if its parent does
  /// not exist or does not allow it.
  explicit AtomicFolder(std::filesystem::path path);
  ~AtomicFolder();
  AtomicFolder(const AtomicFolder&) = delete;
  AtomicFolder& operator=(const AtomicFolder&) = delete;

  /// Where the files go until commit().
  const std::filesystem::path& temporary_path() const;

  /// \throws OutputError naming the path and the system's reason.
  void commit();

 private:
  std::filesystem::path path_;
  std::unique_ptr<Temporary> temporary_;
};

/// Writes `text` as the whole of `path`, atomically. \throws OutputError
void write_text(const std::filesystem::path& path, std::string_view text);

/// Creates `folder` with its parents if missing, and checks that files can be made in it.
/// \throws OutputError otherwise.
void make_writable_folder(const std::filesystem::path& folder);

}  // namespace traverse::files
