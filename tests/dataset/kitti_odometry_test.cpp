#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/dataset/recording_formats.hpp"
#include "traverse/dataset/trajectory_files.hpp"
#include "traverse/files/atomic_file.hpp"

#include "dataset/made_recordings.hpp"
#include "geometry/random_motion.hpp"
#include "temporary_folder.hpp"
#include "test_data.hpp"

namespace traverse::dataset {
namespace {

namespace fs = std::filesystem;
using geometry::Pose3;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using namespace traverse::testing;  // made recordings

constexpr const char* kTracking =
    "P0: 1 0 0 0 0 1 0 0 0 0 1 0\n"
    "R0_rect: 0.9999239 0.00983776 -0.007445048 -0.009869795 0.9999421 -0.004278459 0.007402527 "
    "0.004351614 0.9999631\n"
    "Tr_velo_to_cam: 0.007533745 -0.9999714 -0.000616602 -0.004069766 0.01480249 0.0007280733 "
    "-0.9998902 -0.07631618 0.9998621 0.00752379 0.01480755 -0.2717806\n";
constexpr const char* kOdometry =
    "P0: 1 0 0 0 0 1 0 0 0 0 1 0\nTr: 0 -1 0 0.1 0 0 -1 0.2 1 0 0 0.3\n";

TEST(KittiOdometry, YieldsTheScansAsTheyAreOnDisk) {
  const TemporaryFolder folder;
  make_kitti_folder(folder.path(), 3);
  const auto source = open(folder.path());
  EXPECT_EQ(source->info().format, "KITTI odometry");
  EXPECT_EQ(source->info().expected_scans, 3U);
  const auto scans = read_scans(*source);
  EXPECT_THAT(milliseconds_of(scans), ElementsAre(0, 100, 200));
  const sensors::LidarScan written = made_scan(4, 50, 0.1);
  EXPECT_EQ(scans.at(1)->x, written.x);
  EXPECT_EQ(scans.at(1)->y, written.y);
  EXPECT_EQ(scans.at(1)->z, written.z);
  EXPECT_EQ(scans.at(1)->intensity, written.intensity);
  EXPECT_THAT(scans.at(1)->ring, IsEmpty());
  EXPECT_THAT(scans.at(1)->time, IsEmpty());
  EXPECT_EQ(scans.at(1)->sensor, "velodyne");
  EXPECT_TRUE(source->skipped().empty());
}

TEST(KittiOdometry, SaysWhatItTakesForTrue) {
  const TemporaryFolder folder;
  make_kitti_folder(folder.path(), 1);
  const auto source = open(folder.path());
  EXPECT_TRUE(source->info().motion_compensated);
  EXPECT_EQ(fact_value(*source, "motion compensated"), "yes");
  EXPECT_THAT(fact_reason(*source, "motion compensated"), HasSubstr("are motion-compensated"));
  EXPECT_EQ(fact_reason(*source, "lidar"), "profile hdl64e_kitti, default for KITTI");
  EXPECT_THAT(fact_value(*source, "rings"), HasSubstr("storage order"));
  EXPECT_THAT(fact_value(*source, "point times"), HasSubstr("0.1033 s a revolution, clockwise"));
  EXPECT_THAT(fact_value(*source, "vertical correction"), HasSubstr("+0.205 deg"));
  EXPECT_EQ(fact_value(*source, "scan stamps"), "times.txt");
  const auto* lidar = source->info().rig.find("velodyne");
  ASSERT_NE(lidar, nullptr);
  EXPECT_EQ(lidar->lidar->rings, 64);
  EXPECT_FALSE(source->info().T_body_camera);
  EXPECT_FALSE(source->reference());
}

TEST(KittiOdometry, RewindBeginsAgainWithNothingSkipped) {
  const TemporaryFolder folder;
  make_kitti_folder(folder.path(), 3);
  write_bin(folder / bin_name(1), {});
  const auto source = open(folder.path());
  EXPECT_EQ(read_scans(*source).size(), 2U);
  EXPECT_EQ(source->skipped().total(), 1U);
  EXPECT_EQ(source->share_read(), 1.0);
  source->rewind();
  EXPECT_EQ(source->skipped().total(), 0U);
  EXPECT_EQ(source->share_read(), 0.0);
  EXPECT_THAT(milliseconds_of(read_scans(*source)), ElementsAre(0, 200));
}

TEST(KittiOdometry, CameraIsReadFromBothFormsOfCalibration) {
  const TemporaryFolder folder;
  make_kitti_folder(folder.path(), 1);
  files::write_text(folder / "calib.txt", kOdometry);
  auto source = open(folder.path());
  // The camera looks along the lidar's x axis; p_camera = Tr p_lidar.
  const Eigen::Vector3d p_camera(1, 2, 3);
  EXPECT_TRUE((*source->info().T_body_camera * p_camera)
                  .isApprox(Eigen::Vector3d(3 - 0.3, -(1 - 0.1), -(2 - 0.2)), 1e-12));

  files::write_text(folder / "calib.txt", kTracking);
  source = open(folder.path());
  Eigen::Matrix3d R0;
  R0 << 0.9999239, 0.00983776, -0.007445048, -0.009869795, 0.9999421, -0.004278459, 0.007402527,
      0.004351614, 0.9999631;
  Eigen::Matrix<double, 3, 4> Tr;
  Tr << 0.007533745, -0.9999714, -0.000616602, -0.004069766, 0.01480249, 0.0007280733, -0.9998902,
      -0.07631618, 0.9998621, 0.00752379, 0.01480755, -0.2717806;
  const Eigen::Vector3d p_lidar(10, -4, 1);
  EXPECT_LT((source->info().T_body_camera->inverse() * p_lidar - R0 * (Tr * p_lidar.homogeneous()))
                .norm(),
            1e-5);  // seven digits in the file
  EXPECT_THAT(fact_value(*source, "calibration"), HasSubstr("R0_rect Tr_velo_to_cam"));
}

TEST(KittiOdometry, ABrokenCalibrationIsNamedNotUsed) {
  const TemporaryFolder folder;
  make_kitti_folder(folder.path(), 1);
  files::write_text(folder / "calib.txt", "Tr: 1 0 0\n");
  const auto source = open(folder.path());
  EXPECT_FALSE(source->info().T_body_camera);
  EXPECT_THAT(fact_reason(*source, "calibration"),
              HasSubstr("calib.txt, key Tr: expected 12 numbers, found 3"));
  files::write_text(folder / "calib.txt", "Tr: 1 0 0 0 0 2 0 0 0 0 1 0\n");
  EXPECT_THAT(opening_error(folder.path(), {"calibration=calib.txt"}),
              HasSubstr("key Tr: expected a rotation matrix"));
  EXPECT_THAT(opening_error(folder.path(), {"calibration=none.txt"}),
              HasSubstr("expected a file, relative to"));
}

/// A path of the camera, as the benchmark gives it.
geometry::Trajectory camera_path(std::size_t poses) {
  RandomMotion random(7);
  std::vector<Pose3> path(1);
  for (std::size_t i = 1; i < poses; ++i) path.push_back(path.back() * random.pose(0.1, 1));
  return geometry::Trajectory::unstamped(path);
}

TEST(KittiOdometry, FindsTheBenchmarksPosesAndTurnsThemIntoTheLidars) {
  const TemporaryFolder folder;
  const fs::path sequence = folder / "dataset/sequences/07";
  make_kitti_folder(sequence, 5);
  files::write_text(sequence / "calib.txt", kOdometry);
  fs::create_directories(folder / "dataset/poses");
  write_kitti(folder / "dataset/poses/07.txt", camera_path(5));

  const auto source = open(sequence);
  ASSERT_TRUE(source->reference());
  const geometry::Trajectory& path = source->reference()->T_map_body;
  ASSERT_EQ(path.size(), 5U);
  EXPECT_EQ(path.stamp(3).nanoseconds, 300'000'000);
  const Eigen::Matrix4d Tr = source->info().T_body_camera->inverse().matrix();
  const Eigen::Matrix4d expected = Tr.inverse() * camera_path(5).pose(3).matrix() * Tr;
  EXPECT_LT((path.pose(3).matrix() - expected).norm(), 1e-12);
  EXPECT_THAT(fact_reason(*source, "reference"), HasSubstr("KITTI layout"));
  EXPECT_EQ(source->info().name, "07");
}

TEST(KittiOdometry, PosesThatDoNotFitAreAnErrorOnlyIfTheyWereAskedFor) {
  const TemporaryFolder folder;
  make_kitti_folder(folder.path(), 5);
  files::write_text(folder / "calib.txt", kOdometry);
  write_kitti(folder / "poses.txt", camera_path(4));
  const auto source = open(folder.path());
  EXPECT_FALSE(source->reference());
  EXPECT_THAT(fact_reason(*source, "reference"), HasSubstr("expected 5 poses"));
  EXPECT_THAT(opening_error(folder.path(), {"reference.file=poses.txt"}),
              HasSubstr("poses.txt: expected 5 poses, as many as there are stamps, found 4"));
}

TEST(KittiOdometry, PosesOfTheCameraNeedACalibration) {
  const TemporaryFolder folder;
  make_kitti_folder(folder.path(), 5);
  write_kitti(folder / "poses.txt", camera_path(5));
  EXPECT_FALSE(open(folder.path())->reference());
  EXPECT_THAT(opening_error(folder.path(), {"reference.file=poses.txt", "reference.frame=camera"}),
              HasSubstr("expected a calibration that tells where the camera is"));
  EXPECT_TRUE(
      open(folder.path(), {"reference.file=poses.txt", "reference.frame=lidar"})->reference());
}

TEST(KittiOdometry, ATruncatedScanIsSkippedAndCounted) {
  const TemporaryFolder folder;
  make_kitti_folder(folder.path(), 3);
  fs::resize_file(folder / bin_name(1), 1001);
  const auto source = open(folder.path());
  EXPECT_THAT(milliseconds_of(read_scans(*source)), ElementsAre(0, 200));
  EXPECT_THAT(skipped_in(*source),
              ElementsAre("1 x scan cannot be used: expected whole points of 16 bytes"));
  EXPECT_THAT(source->skipped().by_reason().begin()->second.first_places,
              ElementsAre("velodyne/000001.bin (found 1001 bytes)"));
}

TEST(KittiOdometry, PointsThatAreNotFiniteOrZeroStayInTheScan) {
  const TemporaryFolder folder;
  make_kitti_folder(folder.path(), 1);
  sensors::LidarScan scan = made_scan(2, 10);
  scan.y[3] = std::numeric_limits<float>::quiet_NaN();
  scan.x[4] = scan.y[4] = scan.z[4] = 0;
  write_bin(folder / bin_name(0), scan);
  const auto scans = read_scans(*open(folder.path()));
  ASSERT_EQ(scans.size(), 1U);
  EXPECT_EQ(scans[0]->size(), 20U);
  EXPECT_TRUE(std::isnan(scans[0]->y[3]));
  EXPECT_EQ(count_faults(*scans[0]).not_finite, 1U);
  EXPECT_EQ(count_faults(*scans[0]).at_origin, 1U);
}

TEST(KittiOdometry, AnEmptyScanIsSkippedAndCounted) {
  const TemporaryFolder folder;
  make_kitti_folder(folder.path(), 2);
  write_bin(folder / bin_name(0), {});
  const auto source = open(folder.path());
  EXPECT_THAT(milliseconds_of(read_scans(*source)), ElementsAre(100));
  EXPECT_THAT(skipped_in(*source), ElementsAre("1 x scan without points"));
}

TEST(KittiOdometry, ScansWithoutATimeAreSkippedSurplusTimesAreNamed) {
  const TemporaryFolder folder;
  make_kitti_folder(folder.path(), 4);
  files::write_text(folder / "times.txt", "0\n0.1\n");
  auto source = open(folder.path());
  EXPECT_THAT(milliseconds_of(read_scans(*source)), ElementsAre(0, 100));
  EXPECT_THAT(skipped_in(*source), ElementsAre("2 x no stamp for the scan"));
  EXPECT_EQ(fact_value(*source, "scan stamps do not match"), "2 stamps for 4 files");

  files::write_text(folder / "times.txt", "0\n0.1\n0.2\n0.3\n0.4\n\n\n");
  source = open(folder.path());
  EXPECT_EQ(read_scans(*source).size(), 4U);
  EXPECT_TRUE(source->skipped().empty());
  EXPECT_EQ(fact_value(*source, "scan stamps do not match"), "5 stamps for 4 files");
}

TEST(KittiOdometry, AMissingScanDoesNotShiftTheTimesOfTheOthers) {
  const TemporaryFolder folder;
  make_kitti_folder(folder.path(), 5);
  fs::remove(folder / bin_name(2));
  EXPECT_THAT(milliseconds_of(read_scans(*open(folder.path()))), ElementsAre(0, 100, 300, 400));
}

TEST(KittiOdometry, ANumberBeyondTheTimesMeansTheOrderCounts) {
  const TemporaryFolder folder;
  make_kitti_folder(folder.path(), 3);
  fs::rename(folder / bin_name(0), folder / bin_name(100));
  fs::rename(folder / bin_name(1), folder / bin_name(101));
  fs::rename(folder / bin_name(2), folder / bin_name(102));
  EXPECT_THAT(milliseconds_of(read_scans(*open(folder.path()))), ElementsAre(0, 100, 200));
}

TEST(KittiOdometry, ALineThatIsNoTimeCostsItsScanOnly) {
  const TemporaryFolder folder;
  make_kitti_folder(folder.path(), 4);
  files::write_text(folder / "times.txt", "# seconds\n0\nabc\n\n0.3\n");
  const auto source = open(folder.path());
  EXPECT_THAT(milliseconds_of(read_scans(*source)), ElementsAre(0, 300));
  EXPECT_THAT(skipped_in(*source), ElementsAre("2 x no stamp for the scan"));
}

TEST(KittiOdometry, EqualAndBackwardStampsAreSkippedAndCounted) {
  const TemporaryFolder folder;
  make_kitti_folder(folder.path(), 5);
  files::write_text(folder / "times.txt", "0.1\n0.1\n0.05\n0.2\n0.3\n");
  const auto source = open(folder.path());
  EXPECT_THAT(milliseconds_of(read_scans(*source)), ElementsAre(100, 200, 300));
  EXPECT_THAT(skipped_in(*source), ElementsAre("2 x stamp not later than the one before"));
}

TEST(KittiOdometry, AScanThatDisappearsIsSkippedAndCounted) {
  const TemporaryFolder folder;
  make_kitti_folder(folder.path(), 2);
  const auto source = open(folder.path());
  fs::remove(folder / bin_name(0));
  EXPECT_EQ(read_scans(*source).size(), 1U);
  EXPECT_THAT(skipped_in(*source),
              ElementsAre("1 x scan cannot be used: expected a readable file"));
}

TEST(KittiOdometry, WithoutTimesThePeriodIsStated) {
  const TemporaryFolder folder;
  make_kitti_folder(folder.path(), 3);
  fs::remove(folder / "times.txt");
  EXPECT_THAT(milliseconds_of(read_scans(*open(folder.path()))), ElementsAre(0, 100, 200));
  const auto source = open(folder.path(), {"period_s=0.5", "first_stamp=1317042145.123456789"});
  const auto scans = read_scans(*source);
  EXPECT_EQ(scans.at(0)->stamp.nanoseconds, 1317042145123456789);
  EXPECT_EQ(scans.at(2)->stamp.nanoseconds, 1317042146123456789);
  EXPECT_EQ(fact_reason(*source, "scan stamps"), "--recording period_s=0.5");
  EXPECT_EQ(opening_error(folder.path(), {"first_stamp=noon"}),
            "--recording first_stamp=noon: expected seconds for 'first_stamp', found 'noon'");
}

TEST(OpenRecording, SaysWhatItLookedFor) {
  const TemporaryFolder folder;
  EXPECT_THAT(opening_error(folder.path()), HasSubstr("found an empty folder"));
  files::write_text(folder / "notes.txt", "");
  EXPECT_THAT(opening_error(folder.path()), HasSubstr("velodyne/*.bin (KITTI odometry)"));
  EXPECT_THAT(opening_error(folder.path()), HasSubstr("found a folder with none of these"));
  files::write_text(folder / "b.rawlog", "anything");
  fs::create_directories(folder / "drive" / "velodyne");
  files::write_text(folder / "drive" / "velodyne" / "000000.bin", "");
  fs::create_directories(folder / "run");
  files::write_text(folder / "run" / "run.json", "{}");
  files::write_text(folder / "run" / "map.ply", "");
  EXPECT_THAT(recordings_in(folder.path()),
              ::testing::ElementsAre(folder / "b.rawlog", folder / "drive"));
  EXPECT_THAT(opening_error(folder / "none"),
              HasSubstr("none: expected a recording, found no such file or folder"));
  EXPECT_THAT(opening_error(""), HasSubstr("expected a recording"));
}

TEST(OpenRecording, ATrailingSlashNamesTheSameFolder) {
  const TemporaryFolder folder;
  make_kitti_folder(folder / "drive", 2);
  write_bin(folder / "drive/velodyne/000000.bin", {});
  const auto source = open(folder / "drive/");
  EXPECT_EQ(source->info().name, "drive");
  read_scans(*source);
  EXPECT_THAT(source->skipped().by_reason().begin()->second.first_places,
              ElementsAre("velodyne/000000.bin"));
}

TEST(RealKittiDrive, OpensWithTheStatementsThatComeWithTheProgram) {
  const TemporaryFolder folder;
  if (!copy_real_drive("2011_09_26_drive_0001", 2, folder.path())) {
    GTEST_SKIP() << testing::kNoDrives;
  }
  OpenOptions options = options_with();
  options.statements_file = fs::path(TRAVERSE_SHARE_DIR) / "recordings/kitti_raw_drive.yaml";
  const auto source = open_recording(folder.path(), options);
  EXPECT_FALSE(source->info().motion_compensated);
  const auto scans = read_scans(*source);
  ASSERT_EQ(scans.size(), 2U);
  EXPECT_EQ(scans[0]->size(), 121015U);
  ASSERT_TRUE(source->reference());
  EXPECT_EQ(source->reference()->T_map_body.size(), 108U);
  EXPECT_NEAR(source->reference()->T_map_body.path_length(), 106.92, 0.01);

  // The drive has the same path for the camera: brought to the lidar they agree.
  const auto from_camera = open_recording(folder.path(), [&] {
    OpenOptions other = options;
    other.statements = {"reference.file=poses_cam0_rect.txt", "reference.frame=camera"};
    return other;
  }());
  double largest = 0;
  for (std::size_t i = 0; i < 108; ++i) {
    largest = std::max(largest, (source->reference()->T_map_body.pose(i).matrix() -
                                 from_camera->reference()->T_map_body.pose(i).matrix())
                                    .norm());
  }
  EXPECT_LT(largest, 1e-4);  // the calibration file has seven digits
}

}  // namespace
}  // namespace traverse::dataset
