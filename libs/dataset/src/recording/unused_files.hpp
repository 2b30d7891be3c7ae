#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

#include "traverse/dataset/open_recording.hpp"

namespace traverse::dataset {

/// Files of statements in SHARE/recordings that fit what lies in the folder: every file that they
/// name is there, and they name one at least.
std::vector<std::filesystem::path> fitting_statements(const std::filesystem::path& folder,
                                                      const std::filesystem::path& share_folder);

/// Notes in the facts (kNotUsed) what lies beside a recording and looks as if it were meant to be
/// used with it: a reference, unless there is one, a calibration, statements that are installed
/// with the program; each with the option that takes it.
/// \param reference that the recording was opened with
/// \param scans of its lidar, for poses without stamps; 0: not known
void note_unused_files(RecordingInfo& info, const OpenOptions& options,
                       const std::optional<Reference>& reference, std::size_t scans);

}  // namespace traverse::dataset
