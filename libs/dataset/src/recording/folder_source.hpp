#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "traverse/dataset/source.hpp"

#include "point_clouds/scan_files.hpp"

namespace traverse::dataset {

/// A record that is not a scan, already read; or why it cannot be used.
struct SideRecord {
  std::optional<sensors::Measurement> measurement;
  geometry::Stamp stamp;  ///< where it stands among the others, also when it cannot be used
  std::string fault;
  std::string place;
};

/// All of a recording that is a folder with one file a scan.
struct FolderRecording {
  RecordingInfo info;
  std::string lidar;            ///< label of the sensor that made the scans
  std::vector<ScanFile> scans;  ///< their stamps grow
  /// Reads one file into a scan. \throws files::InputError if it cannot be used.
  std::function<sensors::LidarScan(const ScanFile&)> read;
  std::vector<SideRecord> others;  ///< in the order of their stamps
  SkippedRecords skipped;          ///< while they were read
  std::optional<Reference> reference;
};

/// Reads one scan at a time and merges the other records in by their stamps.
std::unique_ptr<Source> make_folder_source(FolderRecording recording);

}  // namespace traverse::dataset
