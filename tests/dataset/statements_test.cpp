#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/files/atomic_file.hpp"

#include "dataset/made_recordings.hpp"
#include "temporary_folder.hpp"

namespace traverse::dataset {
namespace {

using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using namespace traverse::testing;  // made recordings

TEST(Statements, TheLaterWinsAndEachFactSaysWhereItStands) {
  const TemporaryFolder folder;
  make_kitti_folder(folder / "drive", 1);
  files::write_text(folder / "drive/traverse.yaml",
                    "name: Drive 1\nmotion_compensated: false\nlidar:\n  rings: 32\n"
                    "  vertical_correction_deg: 0\nbody_frame: roof\n");
  files::write_text(folder / "more.yaml", "\nlidar: {rings: 40}\n");
  OpenOptions options = options_with({"motion_compensated=true"});
  options.statements_file = folder / "more.yaml";
  const auto source = open_recording(folder / "drive", options);

  EXPECT_EQ(source->info().name, "Drive 1");
  EXPECT_EQ(source->info().rig.body_frame, "roof");
  EXPECT_EQ(fact_reason(*source, "body frame"), "traverse.yaml, line 6");
  EXPECT_TRUE(source->info().motion_compensated);
  EXPECT_EQ(fact_reason(*source, "motion compensated"), "--recording motion_compensated=true");
  EXPECT_EQ(source->info().rig.sensors.at(0).lidar->rings, 40);
  EXPECT_THAT(fact_reason(*source, "rings"), EndsWith("more.yaml, line 2"));
  EXPECT_EQ(fact_value(*source, "vertical correction"), "none");
  EXPECT_EQ(fact_reason(*source, "vertical correction"), "traverse.yaml, line 5");
}

TEST(Statements, AnUnknownKeyIsAnErrorWithItsLine) {
  const TemporaryFolder folder;
  make_kitti_folder(folder.path(), 1);
  files::write_text(folder / "traverse.yaml", "motion_compensated: true\nsensr: x\n");
  EXPECT_THAT(opening_error(folder.path()),
              EndsWith("traverse.yaml, line 2: expected a known key (did you mean 'sensor'?), "
                       "found 'sensr'"));
  files::write_text(folder / "traverse.yaml", "lidar:\n  sweep: 0.1\n");
  EXPECT_THAT(opening_error(folder.path()), HasSubstr("line 2: expected a known key"));
  files::write_text(folder / "traverse.yaml", "reference: {frame: imu}\n");
  EXPECT_THAT(opening_error(folder.path()),
              HasSubstr("expected one of body, lidar, camera for 'reference.frame', found 'imu'"));
  files::write_text(folder / "traverse.yaml", "motion_compensated: maybe\n");
  EXPECT_THAT(opening_error(folder.path()), HasSubstr("line 1: expected true or false"));
}

TEST(Statements, ABadArgumentNamesItself) {
  const TemporaryFolder folder;
  make_kitti_folder(folder.path(), 1);
  EXPECT_THAT(opening_error(folder.path(), {"period_s=0"}),
              HasSubstr("--recording period_s=0: expected a number, above 0, for 'period_s'"));
  EXPECT_THAT(opening_error(folder.path(), {"period_s"}),
              HasSubstr("--recording: expected key=value, found 'period_s'"));
}

TEST(Statements, AProfileIsANameOrAFileBesideTheRecording) {
  const TemporaryFolder folder;
  make_kitti_folder(folder.path(), 1);
  files::write_text(folder / "own.yaml", "name: own\nrings: 4\n");
  files::write_text(folder / "traverse.yaml", "sensor: own.yaml\n");
  const auto source = open(folder.path());
  EXPECT_EQ(source->info().rig.sensors.at(0).lidar->name, "own");
  EXPECT_EQ(fact_reason(*source, "lidar"), "profile own.yaml, stated in traverse.yaml, line 1");
  EXPECT_THAT(opening_error(folder.path(), {"sensor=hdl65"}),
              AllOf(HasSubstr("expected a sensor profile ("), HasSubstr("hdl64e_kitti")));
  EXPECT_THAT(opening_error(folder.path(), {"sensor=other.yaml"}),
              HasSubstr("expected a file, relative to"));
}

TEST(Statements, AFileIsLookedForBesideTheRecordingThenBesideTheStatement) {
  const TemporaryFolder folder;
  make_kitti_folder(folder / "drive", 1);
  std::filesystem::create_directory(folder / "facts");
  const std::string pose = "0 0 0 0 0 0 0 1\n";
  files::write_text(folder / "facts/gt.tum", pose);
  files::write_text(folder / "facts/facts.yaml", "reference: {file: gt.tum}\n");
  OpenOptions options = options_with();
  options.statements_file = folder / "facts/facts.yaml";
  EXPECT_EQ(open_recording(folder / "drive", options)->reference()->file, folder / "facts/gt.tum");
  files::write_text(folder / "drive/gt.tum", pose);
  EXPECT_EQ(open_recording(folder / "drive", options)->reference()->file, folder / "drive/gt.tum");
}

}  // namespace
}  // namespace traverse::dataset
