#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "traverse/dataset/open_recording.hpp"
#include "traverse/sensors/lidar_scan.hpp"

/// Recordings that tests make themselves, and where the real ones are.
namespace traverse::testing {

using dataset::OpenOptions;
using dataset::Source;
using ScanPtr = std::shared_ptr<const sensors::LidarScan>;

/// A scan as KITTI stores it: ring after ring from straight ahead counterclockwise, the top ring
/// first. `seed` makes scans differ.
sensors::LidarScan made_scan(std::size_t rings, std::size_t points_a_ring, double seed = 0);

/// Writes the points as a KITTI .bin file.
void write_bin(const std::filesystem::path& file, const sensors::LidarScan& scan);

/// "velodyne/000007.bin"
std::string bin_name(std::size_t number);

/// A folder in the KITTI odometry layout with `scans` small scans at 0.1 s, from 0 s.
void make_kitti_folder(const std::filesystem::path& folder, std::size_t scans);

/// The program's own share folder, and what else to state.
OpenOptions options_with(std::vector<std::string> statements = {});

std::unique_ptr<Source> open(const std::filesystem::path& path,
                             std::vector<std::string> statements = {});

/// Everything that is left, and only the scans of it.
std::vector<sensors::Measurement> read_all(Source& source);
std::vector<ScanPtr> read_scans(Source& source);
std::vector<ScanPtr> scans_in(const std::vector<sensors::Measurement>& measurements);

/// Stamps in whole milliseconds.
std::vector<std::int64_t> milliseconds_of(const std::vector<ScanPtr>& scans);

/// The value and the reason of a fact; empty if there is none of that name.
std::string fact_value(const Source& source, const std::string& name);
std::string fact_reason(const Source& source, const std::string& name);

/// What was skipped, as "count x reason" in order.
std::vector<std::string> skipped_in(const Source& source);

/// What opening `path` says is wrong with it; "no error" if nothing.
std::string opening_error(const std::filesystem::path& path,
                          std::vector<std::string> statements = {});

/// Copies the first scans of a real KITTI drive (test_data.hpp) into `folder`, with its times,
/// calibration and poses; false if the drive is not there.
bool copy_real_drive(const std::string& name, std::size_t scans,
                     const std::filesystem::path& folder);

}  // namespace traverse::testing
