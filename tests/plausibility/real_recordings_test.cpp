#include <cstdlib>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/dataset/open_recording.hpp"

#include "plausibility/made_recording.hpp"
#include "temporary_folder.hpp"
#include "test_data.hpp"

namespace traverse::plausibility {
namespace {

namespace fs = std::filesystem;
using ::testing::IsEmpty;
using namespace traverse::testing;  // made recordings

/// What is found in all of a recording, or in its first scans.
std::vector<Finding> findings_of(const fs::path& path, const fs::path& statements,
                                 std::size_t max_scans = 1000) {
  const fs::path share = TRAVERSE_SHARE_DIR;
  dataset::OpenOptions options{std::nullopt, {}, share};
  if (!statements.empty()) options.statements_file = statements;
  const auto source = dataset::open_recording(path, options);
  StreamChecks checks(source->info());
  for (std::size_t scans = 0; scans < max_scans;) {
    const auto measurement = source->next();
    if (!measurement) break;
    checks.take(*measurement);
    scans += std::holds_alternative<std::shared_ptr<const sensors::LidarScan>>(*measurement);
  }
  return checks.findings();
}

TEST(RealRecordings, AUnitOfAPhoneInACar) {
  if (!fs::exists(test_data() / "comma2k19")) GTEST_SKIP() << "comma2k19 is not there";
  const auto findings = findings_of(test_data() / "comma2k19",
                                    fs::path(TRAVERSE_SHARE_DIR) / "recordings/comma2k19.yaml");
  EXPECT_THAT(findings, IsEmpty()) << texts_of(findings);
}

TEST(RealRecordings, ARobotWithWheelsAndAnImu) {
  if (!fs::exists(test_data() / "wheel_imu")) GTEST_SKIP() << "wheel_imu is not there";
  const auto findings = findings_of(test_data() / "wheel_imu/1.txt",
                                    fs::path(TRAVERSE_SHARE_DIR) / "recordings/wheel_imu_log.yaml");
  EXPECT_THAT(findings, IsEmpty()) << texts_of(findings);
}

/// The same recording in milliseconds, with cumulative pulses and its z axis turned over.
TEST(RealRecordings, TheRobotsRawLogContradictsItself) {
  if (!fs::exists(test_data() / "wheel_imu")) GTEST_SKIP() << "wheel_imu is not there";
  const auto findings = findings_of(test_data() / "wheel_imu/12.txt",
                                    fs::path(TRAVERSE_SHARE_DIR) / "recordings/wheel_imu_log.yaml");
  EXPECT_THAT(codes_of(findings), ::testing::Contains("imu_interval")) << texts_of(findings);
}

TEST(RealRecordings, LogsOfAnIndependentSimulator) {
  const fs::path logs = test_data() / "gnss_imu_wheels/logs.tar.xz";
  if (!fs::exists(logs)) GTEST_SKIP() << "gnss_imu_wheels is not there";
  const TemporaryFolder folder;
  const std::string command =
      "tar -C '" + folder.path().string() + "' -xJf '" + logs.string() + "'";
  ASSERT_EQ(std::system(command.c_str()), 0);
  std::size_t count = 0;
  for (const auto& entry : fs::directory_iterator(folder.path())) {
    const auto findings = findings_of(entry.path() / "log.txt", entry.path() / "recording.yaml");
    EXPECT_THAT(findings, IsEmpty()) << entry.path() << "\n" << texts_of(findings);
    ++count;
  }
  EXPECT_EQ(count, 6U);
}

TEST(RealRecordings, DrivesOfKitti) {
  for (const char* name : {"2011_09_26_drive_0001", "2011_09_26_drive_0005"}) {
    if (!fs::exists(kitti_drive(name))) GTEST_SKIP() << kNoDrives;
    const auto findings = findings_of(
        kitti_drive(name), fs::path(TRAVERSE_SHARE_DIR) / "recordings/kitti_raw_drive.yaml", 20);
    EXPECT_THAT(findings, IsEmpty()) << name << "\n" << texts_of(findings);
  }
}

TEST(RealRecordings, RawlogsThatCameWithMrpt) {
  const fs::path datasets = "/usr/share/mrpt/datasets";
  if (!fs::exists(datasets)) GTEST_SKIP() << "the package mrpt-common is not installed";
  for (const auto& entry : fs::recursive_directory_iterator(datasets)) {
    if (entry.path().extension() != ".rawlog") continue;
    try {
      const auto findings = findings_of(entry.path(), {});
      EXPECT_THAT(findings, IsEmpty()) << entry.path() << "\n" << texts_of(findings);
    } catch (const std::exception&) {
      // One without a sensor that is used.
    }
  }
}

}  // namespace
}  // namespace traverse::plausibility
