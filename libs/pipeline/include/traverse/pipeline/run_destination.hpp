#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "traverse/pipeline/run_folder.hpp"

namespace traverse::files {
class WorkFolder;
}

namespace traverse::pipeline {

/// Where a run is to stand, and how it comes there without doing harm. It is written into a work
/// folder beside its place (`.NAME.traverse-work`, locked) and gets its name by one rename once it
/// is through, in exchange for an earlier run; what in that one's folder is not of the run folder's
/// files stays there. Killed at any moment, the earlier run is whole, or the new one is.
class RunDestination {
 public:
  struct Input {
    std::string what;  ///< "the recording"
    std::filesystem::path path;
  };

  /// Where a run on its way to `folder` works: beside it, under a hidden name.
  static std::filesystem::path work_folder(const std::filesystem::path& folder);

  /// Looks and changes nothing.
  /// \param given the folder as the user names it: need not be there; may be a link to a folder
  /// \param inputs what the run reads: nothing of it may stand in the folder
  /// \throws files::OutputError if the folder is neither empty nor an earlier run, or holds an
  /// input
  RunDestination(std::filesystem::path given, const std::vector<Input>& inputs);
  ~RunDestination();
  RunDestination(const RunDestination&) = delete;
  RunDestination& operator=(const RunDestination&) = delete;

  /// Takes the lock, removes what a killed run left, and makes an empty folder to write to. Unless
  /// finish() names it, it is removed with this object.
  /// \throws files::FolderInUse if another run is on its way there; files::OutputError
  RunFolder begin();

  enum class Outcome {
    kComplete,
    kPartial  ///< interrupted or failed: it does not replace an earlier run
  };

  /// Where it will stand, as the user would name it: in place of an earlier run if it is complete
  /// or `force` says so, else beside that one as NAME.interrupted, where it replaces an earlier
  /// partial run; NAME.interrupted.2 and so on if something else is there.
  std::filesystem::path place(Outcome outcome, bool force) const;

  /// Gives the run its name. \returns where it stands: at place(), or, if an earlier run there
  /// could not be replaced, beside it \throws files::OutputError if that is not possible either;
  /// the earlier run is as it was
  RunFolder finish(Outcome outcome, bool force);

  /// Why finish() could not replace the earlier run; empty if it could or should not.
  const std::string& why_beside() const { return why_beside_; }

  /// Whether an earlier run with poses stands at the destination.
  bool has_earlier_run() const;

  /// The folder as the user named it.
  const std::filesystem::path& given() const { return given_; }

  /// `text` with the work folder's path replaced by `place`: for messages, which should name what
  /// will last.
  std::string in_words(std::string text, const std::filesystem::path& place) const;

 private:
  std::filesystem::path beside(int number) const;
  std::filesystem::path free_place_beside() const;
  void give_name(const std::filesystem::path& folder, const std::filesystem::path& shown);

  std::filesystem::path given_;
  std::filesystem::path folder_;  ///< the same, absolute and without links
  std::unique_ptr<files::WorkFolder> work_;
  RunFolder made_;
  std::string why_beside_;
};

}  // namespace traverse::pipeline
