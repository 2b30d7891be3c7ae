#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "traverse/dataset/recording_writer.hpp"
#include "traverse/files/atomic_file.hpp"

namespace traverse::dataset {

/// The files of a recording that is being written, which appear together: X.rawlog,
/// X.traverse.yaml, X.reference.tum and so on, or the same names without X in a folder of their
/// own.
///
/// Files beside others are replaced only if this program wrote them together: X.traverse.yaml lists
/// them, and whose files are not in the list is refused, at once and again at the end.
class RecordingFiles {
 public:
  /// \param data "X.rawlog"
  /// \throws files::OutputError if a file that may be written is there and is somebody else's.
  static RecordingFiles beside(const std::filesystem::path& data, const FilesThere& there);
  /// \param folder a new one, empty
  static RecordingFiles within(const std::filesystem::path& folder);

  /// The name of a file with all of it: "X.reference.tum".
  std::string full_name(const std::string& name) const { return prefix_ + name; }
  files::AtomicFile& add(const std::string& name);
  void write(const std::string& name, std::string_view text);
  /// The data file itself, of files beside it.
  files::AtomicFile& add_data();

  /// Writes traverse.yaml with `statements` and puts all in place. Files of an earlier writing that
  /// are not written any more are removed. \throws files::OutputError
  void commit(const std::string& statements);

 private:
  RecordingFiles(std::filesystem::path folder, std::string prefix, FilesThere there);
  void require_own(const std::string& full_name) const;
  std::string heading() const;

  std::filesystem::path folder_;
  std::string prefix_;  ///< "X."
  std::string data_;    ///< "X.rawlog"
  FilesThere there_;
  std::set<std::string> earlier_;  ///< what this program wrote at an earlier time
  std::vector<std::string> names_;
  files::AtomicFiles files_;
};

}  // namespace traverse::dataset
