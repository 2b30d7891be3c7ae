#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "traverse/dataset/open_recording.hpp"

namespace traverse::dataset {

/// A kind of recording that open_recording() opens: a row of the table in
/// src/recording/recording_formats.cpp, which is all that has to be told of a new one. Error texts
/// and `traverse info --formats` come from it; README.md and docs/recordings.md have its rows too,
/// which a test holds against it.
struct RecordingFormat {
  std::string_view name;           ///< "KITTI odometry", as RecordingInfo::format has it
  bool is_folder = false;          ///< else a file
  std::string_view recognised_by;  ///< "a folder with velodyne/*.bin"
  std::string_view description;    ///< what it holds, in one line

  /// Whether `path`, a folder or a file as `is_folder` says, is of this format: by names and first
  /// bytes alone. \throws files::InputError, std::filesystem::filesystem_error if it cannot be
  /// read.
  bool (*recognises)(const std::filesystem::path& path);
  /// \param name of the format, for RecordingInfo. \throws files::InputError if the recording
  /// cannot be used at all.
  std::unique_ptr<Source> (*open)(const std::filesystem::path& path, const OpenOptions& options,
                                  std::string_view name);
};

/// Every format, in the order in which they are tried.
std::span<const RecordingFormat> recording_formats();

/// The recordings that lie in a folder which is none itself, by name: whoever gives such a folder
/// means one of them. Of a large folder the first 200 entries are looked at.
std::vector<std::filesystem::path> recordings_in(const std::filesystem::path& folder);

}  // namespace traverse::dataset
