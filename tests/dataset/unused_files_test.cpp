#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/dataset/open_recording.hpp"
#include "traverse/files/atomic_file.hpp"

#include "dataset/made_recordings.hpp"
#include "temporary_folder.hpp"

namespace traverse {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::make_kitti_folder;
using testing::open;
using testing::opening_error;
using testing::TemporaryFolder;

constexpr std::size_t kScans = 4;

/// "what: how" of each file that is told to be there and not used.
std::vector<std::string> unused_in(const dataset::Source& source) {
  std::vector<std::string> told;
  for (const dataset::Fact& fact : source.info().facts) {
    if (fact.name == dataset::kNotUsed) told.push_back(fact.value + "; " + fact.reason);
  }
  return told;
}

void write_kitti_poses(const fs::path& file, std::size_t poses) {
  std::string text;
  for (std::size_t i = 0; i < poses; ++i) text += fmt::format("1 0 0 {} 0 1 0 0 0 0 1 0\n", i);
  files::write_text(file, text);
}

void write_tum_poses(const fs::path& file) {
  files::write_text(file, "0 0 0 0 0 0 0 1\n0.1 1 0 0 0 0 0 1\n");
}

class UnusedFiles : public ::testing::Test {
 protected:
  UnusedFiles() { make_kitti_folder(drive_, kScans); }

  TemporaryFolder folder_;
  fs::path drive_ = folder_ / "drive";
};

TEST_F(UnusedFiles, NothingIsToldWhereThereIsNothing) {
  files::write_text(drive_ / "notes.txt", "1 2 3 4 5 6 7 8\n");
  files::write_text(drive_ / "poses_of_the_crew.txt", "standing, sitting\n");
  write_kitti_poses(drive_ / "poses_imu.txt", kScans);  // in a frame that no option names
  EXPECT_THAT(unused_in(*open(drive_)), IsEmpty());
}

TEST_F(UnusedFiles, AReferenceIsNamedWithItsOption) {
  write_kitti_poses(drive_ / "poses_velo.txt", kScans);
  write_tum_poses(drive_ / "ground_truth_camera.txt");
  const auto told = unused_in(*open(drive_));
  ASSERT_EQ(told.size(), 2U);
  EXPECT_THAT(told[0],
              AllOf(HasSubstr("ground_truth_camera.txt: 2 poses with stamps"),
                    HasSubstr("--reference " + (drive_ / "ground_truth_camera.txt").string() +
                              " --reference-frame camera")));
  EXPECT_THAT(told[1], AllOf(HasSubstr("poses_velo.txt: 4 poses, one for each scan"),
                             HasSubstr("--reference " + (drive_ / "poses_velo.txt").string() +
                                       " --reference-frame lidar")));
  // The option does what it is said to do.
  const auto source = open(drive_, {"reference.file=poses_velo.txt", "reference.frame=lidar"});
  ASSERT_TRUE(source->reference());
  EXPECT_THAT(unused_in(*source), IsEmpty()) << "there is one now";
}

TEST_F(UnusedFiles, PosesThatCannotBeMatchedAreNone) {
  write_kitti_poses(drive_ / "poses_velo.txt", kScans + 1);
  EXPECT_THAT(unused_in(*open(drive_)), IsEmpty());
}

TEST_F(UnusedFiles, StatementsFitWhenTheFilesThatTheyNameAreThere) {
  write_kitti_poses(drive_ / "poses_velo.txt", kScans);
  files::write_text(drive_ / "calib.txt", "Tr: 0 -1 0 0 0 0 -1 0 1 0 0 0\n");
  const auto told = unused_in(*open(drive_));
  ASSERT_FALSE(told.empty());
  EXPECT_THAT(told[0], AllOf(HasSubstr("kitti_raw_drive.yaml"), HasSubstr("poses_velo.txt"),
                             HasSubstr("--recording-config"), HasSubstr("kitti_raw_drive.yaml")));
  dataset::OpenOptions options = testing::options_with();
  options.statements_file = options.share_folder / "recordings/kitti_raw_drive.yaml";
  const auto source = dataset::open_recording(drive_, options);
  EXPECT_FALSE(source->info().motion_compensated);
  ASSERT_TRUE(source->reference());
  EXPECT_THAT(unused_in(*source), IsEmpty());
}

TEST_F(UnusedFiles, CsvFilesWithoutStatementsNameThoseThatFit) {
  const fs::path folder = folder_ / "csv";
  fs::create_directory(folder);
  for (const char* name :
       {"imu_gyro_uncalibrated.csv", "imu_accelerometer.csv", "gnss_live_gnss_ublox.csv",
        "wheel_speed.csv", "reference_pose_ecef.csv"}) {
    files::write_text(folder / name, "t,x\n");
  }
  EXPECT_THAT(opening_error(folder),
              AllOf(HasSubstr("comma2k19.yaml fits"), HasSubstr("--recording-config"),
                    HasSubstr("recordings/comma2k19.yaml")));
  fs::remove(folder / "wheel_speed.csv");
  EXPECT_THAT(opening_error(folder), HasSubstr("see share/recordings"));
}

TEST_F(UnusedFiles, BesideALogOnlyWhatIsNamedAfterIt) {
  for (const char* name : {"drive.txt", "other.txt"}) {
    files::write_text(folder_ / name, "IMU 0 0 0 0 0 0 9.8\nIMU 0.1 0 0 0 0 0 9.8\n");
  }
  for (const char* name : {"drive_gt.tum", "other_gt.tum", "estimate.tum"}) {
    write_tum_poses(folder_ / name);
  }
  EXPECT_THAT(unused_in(*open(folder_ / "drive.txt")),
              ElementsAre(HasSubstr("drive_gt.tum: 2 poses with stamps")));
  write_tum_poses(folder_ / "groundtruth.txt");
  EXPECT_THAT(unused_in(*open(folder_ / "other.txt")),
              ElementsAre(HasSubstr("groundtruth.txt"), HasSubstr("other_gt.tum")));
}

TEST_F(UnusedFiles, ResultsAreNoRecordings) {
  const fs::path run = folder_ / "run";
  fs::create_directory(run);
  files::write_text(run / "map.ply", "ply\n");
  files::write_text(run / "run.json", "{}");
  files::write_text(run / "trajectory.tum", "");
  EXPECT_THAT(opening_error(run),
              AllOf(HasSubstr("the folder of a run"), HasSubstr("traverse info")));
  const fs::path map = folder_ / "map";
  fs::create_directory(map);
  for (const char* name : {"map.ply", "map.json", "map.simplemap"}) {
    files::write_text(map / name, "");
  }
  EXPECT_THAT(opening_error(map), HasSubstr("a map that `traverse map` made"));
}

TEST_F(UnusedFiles, StatementsLastFromAnyFolder) {
  files::write_text(folder_ / "stated.yaml",
                    "motion_compensated: false\nreference: {file: gt.tum}\nlidar: {rings: 12}\n"
                    "sensor: own.yaml\n");
  write_tum_poses(folder_ / "gt.tum");
  write_tum_poses(drive_ / "near.tum");
  files::write_text(folder_ / "own.yaml", "name: own\n");
  dataset::OpenOptions options = testing::options_with({"name=its own", "lidar.rings=16"});
  options.statements_file = folder_ / "stated.yaml";
  EXPECT_THAT(dataset::lasting_statements(drive_, options),
              ::testing::UnorderedElementsAre(
                  "motion_compensated=false", "reference.file=" + (folder_ / "gt.tum").string(),
                  "lidar.rings=16", "sensor=" + (folder_ / "own.yaml").string(), "name=its own"));
  EXPECT_THAT(
      dataset::lasting_statements(drive_, testing::options_with({"reference.file=near.tum"})),
      ElementsAre("reference.file=near.tum"))
      << "it moves along with the recording";
  const fs::path here = fs::current_path();
  fs::current_path(folder_.path());
  EXPECT_THAT(dataset::lasting_statements(drive_, testing::options_with({"reference.file=gt.tum"})),
              ElementsAre("reference.file=" + (folder_ / "gt.tum").string()));
  fs::current_path(here);
}

}  // namespace
}  // namespace traverse
