#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace traverse::testing {

/// The folder of recorded data that the tests may use: the environment variable TRAVERSE_TEST_DATA,
/// else shared/data beside the source tree. It need not exist.
inline std::filesystem::path test_data() {
  if (const char* folder = std::getenv("TRAVERSE_TEST_DATA")) return folder;
  return std::filesystem::path(TRAVERSE_SOURCE_DIR).parent_path() / "shared/data";
}

/// The KITTI drive `name` in the layout of KITTI odometry (velodyne/*.bin), unpacked below the
/// folder that the environment variable TRAVERSE_TEST_DRIVES names, else build/data of the source
/// tree. It need not exist.
inline std::filesystem::path kitti_drive(const std::string& name) {
  const char* folder = std::getenv("TRAVERSE_TEST_DRIVES");
  return (folder != nullptr ? std::filesystem::path(folder)
                            : std::filesystem::path(TRAVERSE_SOURCE_DIR) / "build/data") /
         name;
}

/// Why a test on a drive is skipped.
inline constexpr const char* kNoDrives =
    "the KITTI drives are not there: scripts/test unpacks them from the folder that "
    "TRAVERSE_TEST_DATA names";

}  // namespace traverse::testing
