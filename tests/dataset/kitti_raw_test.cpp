#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/files/atomic_file.hpp"

#include "dataset/made_recordings.hpp"
#include "temporary_folder.hpp"

namespace traverse::dataset {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using namespace traverse::testing;  // made recordings

constexpr double kPi = 3.14159265358979323846;

struct Fix {
  double lat, lon, alt, roll, pitch, yaw;
};

Fix fix(std::size_t i) {
  const double s = static_cast<double>(i);
  return {49.015 + 1e-6 * s, 8.4343 - 2e-6 * s, 116.4 + 0.01 * s, 0.035,
          0.009 + 0.001 * s, -2.6 + 0.02 * s};
}

std::string oxts_line(std::size_t i) {
  const Fix f = fix(i);
  return fmt::format(
      "{:.13g} {:.13g} {:.13g} {:.13g} {:.13g} {:.13g} 1 2 3 4 5 0.1 0.2 9.8 14 15 16 0.01 0.02 "
      "0.03 21 22 23 0.05 0.02 4 10 4 4 0\n",
      f.lat, f.lon, f.alt, f.roll, f.pitch, f.yaw);
}

/// A line of timestamps.txt, `i` tenths of a second after 13:02:25 and some nanoseconds.
std::string date_and_time(std::size_t i, std::size_t nanoseconds) {
  nanoseconds += i * 100'000'000;
  return fmt::format("2011-09-26 13:02:{:02d}.{:09d}\n", 25 + nanoseconds / 1'000'000'000,
                     nanoseconds % 1'000'000'000);
}

/// DATE/DATE_drive_0001_sync with calibration in DATE.
fs::path make_raw_drive(const fs::path& folder, std::size_t scans) {
  const fs::path date = folder / "2011_09_26";
  const fs::path drive = date / "2011_09_26_drive_0001_sync";
  fs::create_directories(drive / "velodyne_points/data");
  fs::create_directories(drive / "oxts/data");
  std::string velodyne_times;
  std::string oxts_times;
  for (std::size_t i = 0; i < scans; ++i) {
    write_bin(drive / fmt::format("velodyne_points/data/{:010d}.bin", i), made_scan(2, 30));
    files::write_text(drive / fmt::format("oxts/data/{:010d}.txt", i), oxts_line(i));
    velodyne_times += date_and_time(i, 954312960);
    oxts_times += date_and_time(i, 964389445);
  }
  files::write_text(drive / "velodyne_points/timestamps.txt", velodyne_times);
  files::write_text(drive / "oxts/timestamps.txt", oxts_times);
  files::write_text(date / "calib_imu_to_velo.txt",
                    "calib_time: 25-May-2012 16:47:16\nR: 0 -1 0 1 0 0 0 0 1\nT: -0.8 0.3 -0.8\n");
  files::write_text(date / "calib_velo_to_cam.txt",
                    "calib_time: 15-Mar-2012 11:37:16\nR: 0 -1 0 0 0 -1 1 0 0\nT: 0 -0.08 -0.27\n"
                    "delta_f: 0 0\n");
  files::write_text(date / "calib_cam_to_cam.txt",
                    "S_00: 1392 512\nR_rect_00: 1 0 0 0 1 0 0 0 1\nR_rect_01: 1 0 0 0 1 0 0 0 1\n");
  return drive;
}

/// convertOxtsToPose() and latToScale() of the devkit, written out once more.
Eigen::Matrix4d devkit_pose(const Fix& f, double scale) {
  const double er = 6378137;
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  T(0, 3) = scale * f.lon * kPi * er / 180;
  T(1, 3) = scale * er * std::log(std::tan((90 + f.lat) * kPi / 360));
  T(2, 3) = f.alt;
  Eigen::Matrix3d Rx, Ry, Rz;
  Rx << 1, 0, 0, 0, std::cos(f.roll), -std::sin(f.roll), 0, std::sin(f.roll), std::cos(f.roll);
  Ry << std::cos(f.pitch), 0, std::sin(f.pitch), 0, 1, 0, -std::sin(f.pitch), 0, std::cos(f.pitch);
  Rz << std::cos(f.yaw), -std::sin(f.yaw), 0, std::sin(f.yaw), std::cos(f.yaw), 0, 0, 0, 1;
  T.topLeftCorner<3, 3>() = Rz * Ry * Rx;
  return T;
}

TEST(KittiRaw, MergesScansAndOxtsByTheirStamps) {
  const TemporaryFolder folder;
  const auto source = open(make_raw_drive(folder.path(), 1));
  EXPECT_EQ(source->info().format, "KITTI raw");
  EXPECT_EQ(source->info().name, "2011_09_26_drive_0001_sync");
  EXPECT_FALSE(source->info().motion_compensated);
  const auto measurements = read_all(*source);
  ASSERT_EQ(measurements.size(), 3U);
  EXPECT_EQ(sensor_of(measurements[0]), "velodyne");
  EXPECT_EQ(stamp_of(measurements[0]).nanoseconds, 1317042145954312960);
  EXPECT_EQ(stamp_of(measurements[1]).nanoseconds, 1317042145964389445);

  const auto& imu = std::get<sensors::ImuSample>(measurements[1]);
  EXPECT_EQ(imu.specific_force, Eigen::Vector3d(0.1, 0.2, 9.8));
  EXPECT_EQ(imu.angular_rate, Eigen::Vector3d(0.01, 0.02, 0.03));
  const auto& gnss = std::get<sensors::GnssFix>(measurements[2]);
  EXPECT_EQ(gnss.latitude_deg, 49.015);
  EXPECT_EQ(gnss.longitude_deg, 8.4343);
  // Yaw is from east counterclockwise, heading from north clockwise.
  EXPECT_NEAR(*gnss.heading_deg, 90 + 2.6 * 180 / kPi, 1e-9);
  EXPECT_DOUBLE_EQ((*gnss.covariance_enu)(0, 0), 0.0025);
}

TEST(KittiRaw, TheReferenceIsTheDevkitsPathSeenFromTheLidar) {
  const TemporaryFolder folder;
  const auto source = open(make_raw_drive(folder.path(), 6));
  ASSERT_TRUE(source->reference());
  const geometry::Trajectory& path = source->reference()->T_map_body;
  ASSERT_EQ(path.size(), 6U);
  const double scale = std::cos(49.015 * kPi / 180);
  Eigen::Matrix4d T_lidar_imu = Eigen::Matrix4d::Identity();
  T_lidar_imu.topRows<3>() << 0, -1, 0, -0.8, 1, 0, 0, 0.3, 0, 0, 1, -0.8;
  for (std::size_t i = 0; i < 6; ++i) {
    const Eigen::Matrix4d T_imu0_imu =
        devkit_pose(fix(0), scale).inverse() * devkit_pose(fix(i), scale);
    const Eigen::Matrix4d expected = T_lidar_imu * T_imu0_imu * T_lidar_imu.inverse();
    EXPECT_LT((path.pose(i).matrix() - expected).norm(), 1e-8) << i;  // coordinates of 6e6 m
  }
  EXPECT_EQ(source->info().rig.find("oxts_imu")->T_body_sensor.translation,
            Eigen::Vector3d(-0.8, 0.3, -0.8));
  EXPECT_THAT(fact_value(*source, "reference"), HasSubstr("oxts"));
  // North is y of the Mercator map, seen from the first pose.
  const Eigen::Matrix3d R_lidar_mercator =
      T_lidar_imu.topLeftCorner<3, 3>() *
      devkit_pose(fix(0), scale).topLeftCorner<3, 3>().transpose();
  ASSERT_TRUE(source->reference()->north_map);
  EXPECT_LT((*source->reference()->north_map - R_lidar_mercator.col(1)).norm(), 1e-9);
}

TEST(KittiRaw, TheCameraComesFromTheCalibrationOfTheDate) {
  const TemporaryFolder folder;
  const auto source = open(make_raw_drive(folder.path(), 1));
  ASSERT_TRUE(source->info().T_body_camera);
  EXPECT_TRUE(
      source->info().T_body_camera->translation.isApprox(Eigen::Vector3d(0.27, 0, -0.08), 1e-12));
}

TEST(KittiRaw, WithoutCalibrationTheImuIsTakenToBeTheLidarAndSaysSo) {
  const TemporaryFolder folder;
  const fs::path drive = make_raw_drive(folder.path(), 3);
  fs::remove(drive.parent_path() / "calib_imu_to_velo.txt");
  fs::remove(drive.parent_path() / "calib_cam_to_cam.txt");
  const auto source = open(drive);
  EXPECT_FALSE(source->info().T_body_camera);
  EXPECT_THAT(fact_value(*source, "IMU calibration"), HasSubstr("taken to be at the lidar"));
  EXPECT_TRUE(source->info().rig.find("oxts_imu")->T_body_sensor.translation.isZero());
  EXPECT_TRUE(source->reference());
}

TEST(KittiRaw, ADriveWithoutOxtsTakesTheTablesBesideIt) {
  const TemporaryFolder folder;
  const fs::path drive = make_raw_drive(folder.path(), 3);
  files::write_text(drive / "imu.csv",
                    "t,wx,wy,wz,ax,ay,az\n1317042146.0,0.1,0.2,0.3,1,2,9.8\n"
                    "1317042146.1,0.1,0.2,0.3,1,2,9.8\n");
  files::write_text(drive / "gnss.csv", "t,latitude,longitude,altitude\n1317042146.05,48,11,500\n");
  {
    const auto source = open(drive);
    EXPECT_EQ(read_all(*source).size(), 9U) << "the INS of the drive is its IMU and receiver";
    EXPECT_EQ(source->info().rig.sensors.size(), 3U);
  }
  fs::remove_all(drive / "oxts");
  const auto source = open(drive, {"vehicle.imu.position_m=[1, 2, 3]"});
  EXPECT_EQ(read_all(*source).size(), 3U + 2U + 1U);
  ASSERT_NE(source->info().rig.first(sensors::SensorKind::kImu), nullptr);
  EXPECT_EQ(source->info().rig.first(sensors::SensorKind::kImu)->T_body_sensor.translation,
            Eigen::Vector3d(1, 2, 3));
}

TEST(KittiRaw, ABadPacketIsSkippedAndCounted) {
  const TemporaryFolder folder;
  const fs::path drive = make_raw_drive(folder.path(), 4);
  files::write_text(drive / "oxts/data/0000000001.txt", "49 8 116\n");
  files::write_text(drive / "oxts/data/0000000002.txt", "");
  const auto source = open(drive);
  EXPECT_EQ(read_all(*source).size(), 4U + 2U * 2U);
  EXPECT_THAT(skipped_in(*source),
              ElementsAre("1 x oxts packet cannot be used: expected 30 numbers",
                          "1 x oxts packet cannot be used: expected a line of numbers"));
  EXPECT_EQ(source->reference()->T_map_body.size(), 2U);
}

TEST(KittiRaw, TheFormatFileGivesTheOrderOfThePackets) {
  const TemporaryFolder folder;
  const fs::path drive = make_raw_drive(folder.path(), 1);
  std::string format;
  for (const char* name : {"lon", "lat", "alt", "roll", "pitch", "yaw", "ax", "ay", "az", "wx",
                           "wy", "wz", "pos_accuracy"}) {
    format += std::string(name) + ":   meaning\n";
  }
  files::write_text(drive / "oxts/dataformat.txt", format);
  files::write_text(drive / "oxts/data/0000000000.txt", "8 49 116 0 0 0 1 2 3 4 5 6 0.1\n");
  const auto measurements = read_all(*open(drive));
  EXPECT_EQ(std::get<sensors::GnssFix>(measurements.at(2)).latitude_deg, 49);
  EXPECT_EQ(std::get<sensors::ImuSample>(measurements.at(1)).angular_rate,
            Eigen::Vector3d(4, 5, 6));
  files::write_text(drive / "oxts/dataformat.txt", "lat: latitude\n");
  EXPECT_THAT(opening_error(drive), HasSubstr("dataformat.txt, key lon: expected the line"));
}

TEST(KittiRaw, AMissingScanDoesNotShiftTheTimesOfTheOthers) {
  const TemporaryFolder folder;
  const fs::path drive = make_raw_drive(folder.path(), 4);
  fs::remove(drive / "velodyne_points/data/0000000001.bin");
  const auto scans = read_scans(*open(drive));
  ASSERT_EQ(scans.size(), 3U);
  EXPECT_NEAR(seconds_between(scans[0]->stamp, scans[1]->stamp), 0.2, 1e-9);
}

TEST(KittiRaw, AStampThatIsNoDateCostsItsScanOnly) {
  const TemporaryFolder folder;
  const fs::path drive = make_raw_drive(folder.path(), 5);
  files::write_text(drive / "velodyne_points/timestamps.txt",
                    "2011-09-26 13:02:25.0\n2011-02-30 13:02:25.1\n2011-09-26 25:02:25.2\n"
                    "2011-09-26T13:02:25.3\n2011-09-26 13:02:25.4x\n");
  const auto source = open(drive, {"reference.frame=body"});
  EXPECT_THAT(milliseconds_of(read_scans(*source)), ElementsAre(1317042145000, 1317042145300));
}

}  // namespace
}  // namespace traverse::dataset
