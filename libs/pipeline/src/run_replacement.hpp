#pragma once

#include <filesystem>
#include <string>

namespace traverse::pipeline {

/// What is in the place of a run.
struct FoundInPlace {
  enum class Kind {
    kNothing,  ///< no folder, or nothing in it
    kNoPoses,  ///< a run that ended before it had a pose
    kRun,
    kForeign  ///< anything else
  };
  Kind kind = Kind::kNothing;
  std::string text;          ///< what it is if it is foreign: "it holds notes.txt and no run.json"
  bool is_complete = false;  ///< a run with status ok
};
FoundInPlace look_at_place(const std::filesystem::path& folder);

/// Links what is not the run's own (files of the run folder's names, its pictures) from one run's
/// folder into another's, sub-folders with all in them; what cannot be linked is copied. What is
/// there already stays. \throws files::OutputError
void carry_over_foreign(const std::filesystem::path& from, const std::filesystem::path& to);

enum class Exchange { kAtOnce, kByTwoRenames };

/// Gives the complete folder `made` the name `place`, where nothing is or an earlier run; what is
/// not that run's own is carried over. Killed at any moment, either folder stands there whole; but
/// on file systems that cannot exchange two names (`exchange` is tried first) there may be nothing
/// until recover_replacement().
/// \param aside a name of no folder, on the same file system
/// \throws files::OutputError; then `place` is as it was
void replace_run(const std::filesystem::path& made, const std::filesystem::path& place,
                 const std::filesystem::path& aside, Exchange exchange = Exchange::kAtOnce);

/// Completes what replace_run() was killed in.
void recover_replacement(const std::filesystem::path& made, const std::filesystem::path& place,
                         const std::filesystem::path& aside);

}  // namespace traverse::pipeline
