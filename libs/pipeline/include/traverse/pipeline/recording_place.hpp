#pragma once

#include <filesystem>

namespace traverse::files {
class JsonValue;
}

namespace traverse::pipeline {

struct RunFolder;

/// Where the recording of a run is: told in two ways, so that run and recording may move together
/// and either may move alone as long as the other way holds.
struct RecordingPlace {
  std::filesystem::path path;      ///< absolute
  std::filesystem::path from_run;  ///< from the run folder
};

/// \param recording as the user named it  \param run_folder where it stands or will stand
RecordingPlace recording_place(const std::filesystem::path& recording,
                               const std::filesystem::path& run_folder);

/// The recording of a run, as its run.json tells: at its absolute path, or else from the folder.
/// Where neither is there, the path that was told.
/// \param record run.json, checked
std::filesystem::path find_recording(const RunFolder& folder, const files::JsonValue& record);

/// Tells run.json that its folder, which was to stand at `from`, will stand at `to`. Nothing where
/// there is no run.json of a run. \throws files::OutputError
void retell_place(const RunFolder& folder, const std::filesystem::path& from,
                  const std::filesystem::path& to);

}  // namespace traverse::pipeline
