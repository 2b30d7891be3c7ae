#include "traverse/dataset/recording_writer.hpp"

#include <cmath>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/dataset/trajectory_files.hpp"
#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/files/text_file.hpp"
#include "traverse/sensors/rings.hpp"
#include "traverse/sensors/sweep_timing.hpp"

#include "dataset/made_recordings.hpp"
#include "file_size_limit.hpp"
#include "geometry/random_motion.hpp"
#include "temporary_folder.hpp"
#include "test_data.hpp"

namespace traverse::dataset {
namespace {

namespace fs = std::filesystem;
using sensors::LidarScan;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;
using ::testing::SizeIs;
using namespace traverse::testing;  // made recordings

void copy_all(Source& source, RecordingWriter& writer) {
  source.rewind();
  while (const auto measurement = source.next()) writer.add(*measurement);
  writer.commit();
}

void to_rawlog(Source& source, const fs::path& file, int gzip_level = 1) {
  copy_all(source, *write_rawlog(file, source.info(), source.reference(), {gzip_level}));
}

void to_folder(Source& source, const fs::path& folder, ScanFolderFormat format) {
  const std::string lidar = source.info().rig.first(sensors::SensorKind::kLidar)->label;
  copy_all(source, *write_scan_folder(folder, source.info(), source.reference(), lidar, format));
}

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

/// The copy has the original's points bit by bit, and the rings and times that the original's
/// profile derives, these to a tick of 100 ns.
void expect_same_scans(Source& original, Source& copy) {
  original.rewind();
  copy.rewind();
  const auto expected = read_scans(original);
  const auto actual = read_scans(copy);
  const auto profile = [](Source& source) {
    return *source.info().rig.first(sensors::SensorKind::kLidar)->lidar;
  };
  ASSERT_EQ(expected.size(), actual.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_LE(std::abs(seconds_between(expected[i]->stamp, actual[i]->stamp)), 50e-9);
    EXPECT_TRUE(same_bits(expected[i]->x, actual[i]->x));
    EXPECT_TRUE(same_bits(expected[i]->y, actual[i]->y));
    EXPECT_TRUE(same_bits(expected[i]->z, actual[i]->z));
    EXPECT_EQ(assign_rings(*expected[i], profile(original)).ring,
              assign_rings(*actual[i], profile(copy)).ring);
    const auto expected_times = point_times(*expected[i], profile(original));
    const auto actual_times = point_times(*actual[i], profile(copy));
    ASSERT_EQ(expected_times.size(), actual_times.size());
    double largest = 0;
    for (std::size_t k = 0; k < expected_times.size(); ++k) {
      largest = std::max(largest, std::abs(double{expected_times[k]} - double{actual_times[k]}));
    }
    EXPECT_LE(largest, 55e-9);  // half a tick and what a float loses
  }
}

/// A made KITTI drive with a camera, a reference, and points of every kind of trouble.
std::unique_ptr<Source> made_drive(const fs::path& folder) {
  make_kitti_folder(folder, 4);
  LidarScan scan = made_scan(4, 50);
  scan.x[7] = std::nanf("");
  scan.x[8] = scan.y[8] = scan.z[8] = 0;
  scan.z[9] = -0.0F;
  write_bin(folder / bin_name(2), scan);
  files::write_text(folder / "times.txt",
                    "1317042145.1234567\n1317042145.2\n1317042145.3\n"
                    "1317042145.4\n");
  files::write_text(folder / "calib.txt", "Tr: 0 -1 0 0.1 0 0 -1 0.2 1 0 0 0.3\n");
  RandomMotion random(3);
  std::vector<geometry::Pose3> poses(1);
  for (int i = 0; i < 3; ++i) poses.push_back(poses.back() * random.pose(0.2, 2));
  write_kitti(folder / "gt.txt", geometry::Trajectory::unstamped(poses));
  return open(folder, {"reference.file=gt.txt", "reference.frame=lidar", "reference.north_deg=60",
                       "motion_compensated=false", "lidar.rings=4", "name='Made: drive #1'"});
}

TEST(RecordingWriter, KittiToRawlogToPcdAndPlyKeepsPointsRingsAndTimes) {
  const TemporaryFolder folder;
  const auto drive = made_drive(folder / "drive");
  to_rawlog(*drive, folder / "a.rawlog");
  const auto rawlog = open(folder / "a.rawlog");
  expect_same_scans(*drive, *rawlog);
  to_folder(*rawlog, folder / "pcd", ScanFolderFormat::kPcd);
  expect_same_scans(*drive, *open(folder / "pcd"));
  to_folder(*rawlog, folder / "ply", ScanFolderFormat::kPly);
  expect_same_scans(*drive, *open(folder / "ply"));
  EXPECT_THAT(scans_in(read_all(*open(folder / "ply"))).at(0)->ring, SizeIs(200));
}

TEST(RecordingWriter, BackToKittiIsTheSameRecording) {
  const TemporaryFolder folder;
  const auto drive = made_drive(folder / "drive");
  to_folder(*drive, folder / "kitti", ScanFolderFormat::kKitti);
  const auto copy = open(folder / "kitti");
  EXPECT_EQ(copy->info().format, "KITTI odometry");
  expect_same_scans(*drive, *copy);
  EXPECT_EQ(files::read_text(folder / "kitti" / bin_name(1)),
            files::read_text(folder / "drive" / bin_name(1)));
}

TEST(RecordingWriter, FactsReferenceAndCameraGoWithTheCopy) {
  const TemporaryFolder folder;
  const auto drive = made_drive(folder / "drive");
  to_rawlog(*drive, folder / "a.rawlog");
  to_folder(*drive, folder / "pcd", ScanFolderFormat::kPcd);
  to_folder(*drive, folder / "kitti", ScanFolderFormat::kKitti);
  for (const char* copy_name : {"a.rawlog", "pcd", "kitti"}) {
    const auto copy = open(folder / copy_name);
    EXPECT_EQ(copy->info().name, "Made: drive #1");
    EXPECT_FALSE(copy->info().motion_compensated) << copy_name;
    EXPECT_EQ(copy->info().rig.body_frame, "lidar");
    const auto& profile = *copy->info().rig.first(sensors::SensorKind::kLidar)->lidar;
    EXPECT_EQ(profile.vertical_correction_deg, 0.205);
    EXPECT_EQ(profile.rings, 4);
    const bool stores = std::string(copy_name) != "kitti";
    EXPECT_EQ(profile.ring_source,
              stores ? sensors::RingSource::kData : sensors::RingSource::kStorageOrder);
    EXPECT_EQ(profile.time_source,
              stores ? sensors::TimeSource::kData : sensors::TimeSource::kAzimuth);
    ASSERT_TRUE(copy->reference()) << copy_name;
    ASSERT_EQ(copy->reference()->T_map_body.size(), 4U);
    EXPECT_EQ(copy->reference()->T_map_body.stamps(), drive->reference()->T_map_body.stamps());
    EXPECT_LT((copy->reference()->T_map_body.pose(3).matrix() -
               drive->reference()->T_map_body.pose(3).matrix())
                  .norm(),
              1e-14);
    ASSERT_TRUE(copy->reference()->north_map) << copy_name;
    EXPECT_LT((*copy->reference()->north_map - Eigen::Vector3d(0.5, std::sqrt(0.75), 0)).norm(),
              1e-12);
    ASSERT_TRUE(copy->info().T_body_camera) << copy_name;
    EXPECT_LT((copy->info().T_body_camera->matrix() - drive->info().T_body_camera->matrix()).norm(),
              1e-14);
  }
}

TEST(RecordingWriter, IntensityIsScaledToTheBrightestReturn) {
  const TemporaryFolder folder;
  fs::create_directories(folder / "drive/velodyne");
  LidarScan scan = made_scan(1, 5);
  scan.intensity = {0, 0.5F, 1, 7, std::nanf("")};
  write_bin(folder / "drive" / bin_name(0), scan);
  to_rawlog(*open(folder / "drive"), folder / "a.rawlog");
  const auto rawlog = open(folder / "a.rawlog");
  EXPECT_THAT(read_scans(*rawlog).at(0)->intensity, ElementsAre(0, 128, 255, 255, 0));
  EXPECT_EQ(rawlog->info().rig.sensors.at(0).lidar->intensity_full_scale, 255);
}

/// One measurement of every kind, from a rig with mounted sensors.
struct EveryKind {
  EveryKind() {
    RandomMotion random(5);
    info.name = "every kind";
    info.rig.body_frame = "vehicle";
    for (const auto& [label, kind] :
         {std::pair("imu", sensors::SensorKind::kImu), std::pair("gps", sensors::SensorKind::kGnss),
          std::pair("laser", sensors::SensorKind::kPlanarLaser)}) {
      info.rig.sensors.push_back({label, kind, random.pose(1, 2), std::nullopt});
    }
    info.rig.sensors.push_back(
        {"odo", sensors::SensorKind::kWheels, geometry::Pose3::identity(), std::nullopt});
    laser.stamp = {1'000'000'000};
    laser.sensor = "laser";
    laser.first_azimuth = -0.5;  // not symmetric about the sensor's axis
    laser.azimuth_step = 0.25;
    laser.max_range_m = 30;
    laser.ranges_m = {1, std::nanf(""), 3, 4, 5, 6, 7};
    imu.stamp = {1'100'000'000};
    imu.sensor = "imu";
    imu.angular_rate = {0.1, 0.2, 0.3};
    imu.specific_force = {1, 2, 9.81};
    gnss.stamp = {1'200'000'000};
    gnss.sensor = "gps";
    gnss.latitude_deg = 36.84;
    gnss.longitude_deg = -2.41;
    gnss.altitude_m = 12.5;
    flat_gnss = gnss;
    flat_gnss.stamp = {1'300'000'000};
    flat_gnss.altitude_m = std::nan("");
    wheels.stamp = {1'400'000'000};
    wheels.sensor = "odo";
    wheels.T_odom_body = geometry::exp_se3((geometry::Twist() << 0, 0, 0.7, 1, 2, 0).finished());
    wheels.ticks = {123456, -654321};
    wheels.velocity = {1.5, -0.1, 0.2};
  }

  RecordingInfo info;
  sensors::PlanarScan laser;
  sensors::ImuSample imu;
  sensors::GnssFix gnss;
  sensors::GnssFix flat_gnss;
  sensors::WheelOdometry wheels;
};

TEST(RecordingWriter, ARawlogTakesEverySensor) {
  const TemporaryFolder folder;
  const EveryKind every;
  const auto writer = write_rawlog(folder / "a.rawlog", every.info, std::nullopt, {});
  writer->add(std::make_shared<const sensors::PlanarScan>(every.laser));
  writer->add(every.imu);
  writer->add(every.gnss);
  writer->add(every.flat_gnss);
  writer->add(every.wheels);
  writer->commit();
  EXPECT_THAT(writer->left_out(), IsEmpty());

  const auto source = open(folder / "a.rawlog");
  const auto all = read_all(*source);
  ASSERT_THAT(all, SizeIs(5));
  const auto& laser = *std::get<std::shared_ptr<const sensors::PlanarScan>>(all[0]);
  EXPECT_EQ(laser.stamp, every.laser.stamp);
  EXPECT_NEAR(laser.azimuth_step, 0.25, 1e-7);
  EXPECT_EQ(laser.ranges_m[6], 7);
  EXPECT_TRUE(std::isnan(laser.ranges_m[1]));
  // The last beam points the same way from the body: the middle went into the sensor's pose.
  const auto beam = [](const sensors::Rig& rig, const sensors::PlanarScan& scan) {
    const double azimuth = scan.first_azimuth + 6 * scan.azimuth_step;
    return Eigen::Vector3d(rig.find("laser")->T_body_sensor *
                           Eigen::Vector3d(std::cos(azimuth), std::sin(azimuth), 0));
  };
  EXPECT_LT((beam(source->info().rig, laser) - beam(every.info.rig, every.laser)).norm(), 1e-6);

  const auto& imu = std::get<sensors::ImuSample>(all[1]);
  EXPECT_EQ(imu.angular_rate, every.imu.angular_rate);
  EXPECT_EQ(imu.specific_force, every.imu.specific_force);
  EXPECT_LT((source->info().rig.find("imu")->T_body_sensor.matrix() -
             every.info.rig.find("imu")->T_body_sensor.matrix())
                .norm(),
            1e-12);
  const auto& gnss = std::get<sensors::GnssFix>(all[2]);
  EXPECT_EQ(gnss.latitude_deg, 36.84);
  EXPECT_EQ(gnss.altitude_m, 12.5);
  EXPECT_TRUE(std::isnan(std::get<sensors::GnssFix>(all[3]).altitude_m));
  const auto& wheels = std::get<sensors::WheelOdometry>(all[4]);
  EXPECT_LT((wheels.T_odom_body->matrix() - every.wheels.T_odom_body->matrix()).norm(), 1e-14);
  EXPECT_EQ(wheels.ticks->left, 123456);
  EXPECT_EQ(wheels.ticks->right, -654321);
  EXPECT_EQ(wheels.velocity->forward_mps, 1.5);
  EXPECT_EQ(wheels.velocity->left_mps, -0.1);
  EXPECT_EQ(wheels.velocity->yaw_rate, 0.2);
}

TEST(RecordingWriter, AFolderNamesWhatItHasNoPlaceFor) {
  const TemporaryFolder folder;
  EveryKind every;
  sensors::LidarProfile profile;
  every.info.rig.sensors.push_back(
      {"top", sensors::SensorKind::kLidar, geometry::Pose3::identity(), profile});
  const auto writer =
      write_scan_folder(folder / "out", every.info, std::nullopt, "top", ScanFolderFormat::kKitti);
  writer->add(every.wheels);
  writer->add(every.flat_gnss);
  LidarScan scan = made_scan(2, 3);
  scan.sensor = "top";
  scan.ring.assign(6, 1);
  scan.time.assign(6, 0.01F);
  writer->add(std::make_shared<const LidarScan>(scan));
  scan.sensor = "another lidar";
  writer->add(std::make_shared<const LidarScan>(scan));
  writer->commit();
  EXPECT_THAT(
      writer->left_out(),
      ElementsAre(Pair("fixes without an altitude", 1), Pair("measurements of another lidar", 1),
                  Pair("point times, by scan", 1), Pair("poses of wheel odometry", 1),
                  Pair("pulses of wheels", 1), Pair("ring numbers, by scan", 1),
                  Pair("sideward and turning speeds of wheel odometry", 1)));
  EXPECT_THROW(
      write_scan_folder(folder / "x", every.info, std::nullopt, "imu", ScanFolderFormat::kPcd),
      std::invalid_argument);
}

TEST(RecordingWriter, AFolderHasTheOtherSensorsInTables) {
  const TemporaryFolder folder;
  EveryKind every;
  const geometry::Pose3 T_body_lidar = RandomMotion(8).pose(1, 2);
  every.info.rig.sensors.push_back(
      {"top", sensors::SensorKind::kLidar, T_body_lidar, sensors::LidarProfile()});
  const auto writer =
      write_scan_folder(folder / "out", every.info, std::nullopt, "top", ScanFolderFormat::kPcd);
  constexpr std::int64_t kEpoch_ns = 1'700'000'000'123'456'789;  // more digits than a double has
  LidarScan scan = made_scan(2, 3);
  scan.sensor = "top";
  scan.stamp = {kEpoch_ns};
  writer->add(std::make_shared<const LidarScan>(scan));
  every.imu.stamp = {kEpoch_ns + 1};
  every.imu.angular_rate = {1.0 / 3, -0.2, 1e-17};
  writer->add(every.imu);
  every.gnss.stamp = {kEpoch_ns + 2};
  writer->add(every.gnss);
  every.gnss.stamp = {kEpoch_ns + 1'000'000'003};
  every.gnss.heading_deg = 1000.0 / 3;
  every.gnss.covariance_enu = Eigen::Vector3d(0.25, 4, 9).asDiagonal();
  writer->add(every.gnss);
  every.wheels.stamp = {kEpoch_ns + 4};
  every.wheels.velocity = {1.0 / 7, 0, 0};
  writer->add(every.wheels);
  writer->commit();

  const auto copy = open(folder / "out");
  const auto all = read_all(*copy);
  EXPECT_THAT(skipped_in(*copy), IsEmpty());
  ASSERT_THAT(all, SizeIs(5));
  const auto& imu = std::get<sensors::ImuSample>(all[1]);
  EXPECT_EQ(imu.stamp.nanoseconds, kEpoch_ns + 1);
  EXPECT_EQ(imu.angular_rate, every.imu.angular_rate);
  EXPECT_EQ(imu.specific_force, every.imu.specific_force);
  const auto& plain = std::get<sensors::GnssFix>(all[2]);
  EXPECT_EQ(plain.stamp.nanoseconds, kEpoch_ns + 2);
  EXPECT_FALSE(plain.heading_deg);
  EXPECT_FALSE(plain.covariance_enu);
  EXPECT_EQ(std::get<sensors::WheelOdometry>(all[3]).velocity->forward_mps, 1.0 / 7);
  const auto& fix = std::get<sensors::GnssFix>(all[4]);
  EXPECT_EQ(fix.latitude_deg, every.gnss.latitude_deg);
  EXPECT_EQ(fix.heading_deg, every.gnss.heading_deg);
  EXPECT_EQ(fix.covariance_enu, every.gnss.covariance_enu);
  const auto& rig = copy->info().rig;
  EXPECT_LT((rig.first(sensors::SensorKind::kImu)->T_body_sensor.matrix() -
             (T_body_lidar.inverse() * every.info.rig.find("imu")->T_body_sensor).matrix())
                .norm(),
            1e-12);
  EXPECT_LT((rig.first(sensors::SensorKind::kGnss)->T_body_sensor.translation -
             (T_body_lidar.inverse() * every.info.rig.find("gps")->T_body_sensor).translation)
                .norm(),
            1e-12);
}

TEST(RecordingWriter, AFoldersBodyIsItsLidar) {
  const TemporaryFolder folder;
  RandomMotion random(9);
  RecordingInfo info;
  info.rig.body_frame = "vehicle";
  const geometry::Pose3 T_body_lidar = random.pose(1, 2);
  info.rig.sensors.push_back(
      {"top", sensors::SensorKind::kLidar, T_body_lidar, sensors::LidarProfile()});
  info.T_body_camera = random.pose(1, 2);
  Reference reference;
  reference.T_map_body.push_back({0}, geometry::Pose3::identity());
  reference.T_map_body.push_back({1'000'000'000}, random.pose(1, 5));
  const auto writer =
      write_scan_folder(folder / "out", info, reference, "top", ScanFolderFormat::kPcd);
  LidarScan scan = made_scan(1, 4);
  scan.sensor = "top";
  writer->add(std::make_shared<const LidarScan>(scan));
  writer->commit();

  const auto copy = open(folder / "out");
  EXPECT_EQ(copy->info().rig.body_frame, "lidar");
  const geometry::Pose3 expected =
      T_body_lidar.inverse() * reference.T_map_body.pose(1) * T_body_lidar;
  EXPECT_LT((copy->reference()->T_map_body.pose(1).matrix() - expected.matrix()).norm(), 1e-12);
  EXPECT_LT((copy->info().T_body_camera->matrix() -
             (T_body_lidar.inverse() * *info.T_body_camera).matrix())
                .norm(),
            1e-12);
}

TEST(RecordingWriter, NothingIsThereBeforeCommitAndNothingIsLeftWithout) {
  const TemporaryFolder folder;
  make_kitti_folder(folder / "drive", 1);
  const auto drive = open(folder / "drive");
  const auto scan = drive->next();
  for (const bool commit : {false, true}) {
    {
      const auto rawlog = write_rawlog(folder / "a.rawlog", drive->info(), std::nullopt, {});
      const auto pcd = write_scan_folder(folder / "pcd", drive->info(), std::nullopt, "velodyne",
                                         ScanFolderFormat::kPcd);
      rawlog->add(*scan);
      pcd->add(*scan);
      EXPECT_FALSE(fs::exists(folder / "a.rawlog"));
      EXPECT_FALSE(fs::exists(folder / "pcd"));
      if (commit) {
        rawlog->commit();
        pcd->commit();
      }
    }
    EXPECT_EQ(fs::exists(folder / "a.rawlog"), commit);
    EXPECT_EQ(fs::exists(folder / "pcd"), commit);
    // Beside the drive: the rawlog, its statements, the folder.
    EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), commit ? 4 : 1);
  }
}

TEST(RecordingWriter, AFullDiskIsAnErrorAndLeavesNothing) {
  const TemporaryFolder folder;
  make_kitti_folder(folder / "drive", 4);
  const auto drive = open(folder / "drive");
  for (const int gzip_level : {0, 1}) {
    const FileSizeLimit limit(4000);
    EXPECT_THROW(to_rawlog(*drive, folder / "a.rawlog", gzip_level), files::OutputError);
  }
  {
    const FileSizeLimit limit(1000);
    EXPECT_THROW(to_folder(*drive, folder / "pcd", ScanFolderFormat::kPcd), files::OutputError);
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1);
}

TEST(RecordingWriter, AnUnwritableFolderIsNamed) {
  const TemporaryFolder folder;
  make_kitti_folder(folder / "drive", 1);
  const auto drive = open(folder / "drive");
  try {
    write_rawlog(folder / "none/a.rawlog", drive->info(), std::nullopt, {});
    FAIL() << "no error";
  } catch (const files::OutputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("none/a.rawlog: cannot be written: No such file"));
  }
  EXPECT_THROW(write_scan_folder(folder / "drive", drive->info(), std::nullopt, "velodyne",
                                 ScanFolderFormat::kPcd),
               files::OutputError);
}

TEST(RecordingWriter, MrptsOwnToolReadsOurRawlog) {
  if (std::system("command -v rawlog-edit > /dev/null") != 0) {
    GTEST_SKIP() << "the package mrpt-apps is not installed";
  }
  const TemporaryFolder folder;
  to_rawlog(*made_drive(folder / "drive"), folder / "a.rawlog");
  const std::string command = "rawlog-edit --info -i '" + (folder / "a.rawlog").string() + "' > '" +
                              (folder / "out.txt").string() + "' 2>&1";
  ASSERT_EQ(std::system(command.c_str()), 0);
  const std::string output = files::read_text(folder / "out.txt");
  EXPECT_THAT(output, HasSubstr("Overall number of objects         : 4"));
  EXPECT_THAT(output, HasSubstr("Observations format               : Yes"));
  EXPECT_THAT(output, HasSubstr("All sensor labels                 : velodyne"));
  EXPECT_THAT(output, HasSubstr("1317042145.123457"));
}

TEST(RecordingWriter, ARealDriveSurvivesTheWayThroughARawlog) {
  const TemporaryFolder folder;
  if (!copy_real_drive("2011_09_26_drive_0005", 2, folder / "drive")) {
    GTEST_SKIP() << testing::kNoDrives;
  }
  OpenOptions options = options_with();
  options.statements_file = fs::path(TRAVERSE_SHARE_DIR) / "recordings/kitti_raw_drive.yaml";
  const auto drive = open_recording(folder / "drive", options);
  to_rawlog(*drive, folder / "a.rawlog");
  const auto rawlog = open(folder / "a.rawlog");
  to_folder(*rawlog, folder / "pcd", ScanFolderFormat::kPcd);
  const auto pcd = open(folder / "pcd");
  expect_same_scans(*drive, *pcd);
  pcd->rewind();
  EXPECT_EQ(read_scans(*pcd).size(), 2U);
}

}  // namespace
}  // namespace traverse::dataset
