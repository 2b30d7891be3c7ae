#pragma once

#include <filesystem>
#include <memory>
#include <stdexcept>

namespace traverse::files {

class Unfinished;

/// Another process works there.
class FolderInUse : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A folder for what is not finished yet, of a fixed name, held by one process. The system holds
/// the lock (flock on a file within) and lets go of it however the process ends, so that a folder
/// whose lock is free is what a killed process left: the next one takes it and clears it.
///
/// It is removed with this object, and by a signal that ends the program.
class WorkFolder {
 public:
  enum class Others { kRefuse, kWaitFor };

  /// Makes the folder, if it is not there, and takes the lock; what is in it stays.
  /// \param path in a folder that exists, under a name that is used for nothing else
  /// \param result what is made there, for messages: "DIR"
  /// \throws FolderInUse saying who works there since when; OutputError
  WorkFolder(std::filesystem::path path, std::filesystem::path result,
             Others others = Others::kRefuse);
  ~WorkFolder();
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

  /// Removes everything in it. \throws OutputError
  void clear();

  /// From now on it stays as it is, even if a signal ends the program, until the next process
  /// comes: something in it must not be lost. As long as `keep` is false again nothing has changed.
  void keep(bool keep);

 private:
  std::filesystem::path path_;
  std::filesystem::path result_;
  int lock_ = -1;
  bool keep_ = false;
  std::unique_ptr<Unfinished> unfinished_;
};

/// Removes a file or a folder with all in it, read-only folders too. \throws OutputError
void remove_tree(const std::filesystem::path& path);

}  // namespace traverse::files
