#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/io/lazy_load_path.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationGPS.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationRotatingScan.h>
#include <mrpt/obs/CSensoryFrame.h>

#include "dataset/made_recordings.hpp"
#include "dataset/rawlog_maker.hpp"
#include "packets/made_velodyne_packet.hpp"
#include "temporary_folder.hpp"

namespace traverse::dataset {
namespace {

namespace fs = std::filesystem;
using namespace mrpt::obs;
using ::testing::ElementsAre;
using ::testing::FloatEq;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using namespace traverse::testing;  // made recordings and rawlogs

TEST(Rawlog, AVelodyneScanKeepsPointsRingsAndTimes) {
  const TemporaryFolder folder;
  {
    RawlogMaker maker(folder / "a.rawlog");
    maker.add(made_velodyne(0.5));
  }
  const auto source = open(folder / "a.rawlog");
  EXPECT_EQ(source->info().format, "MRPT rawlog");
  EXPECT_EQ(source->info().name, "a");
  const auto scans = read_scans(*source);
  ASSERT_THAT(scans, SizeIs(1));
  const sensors::LidarScan& scan = *scans[0];
  EXPECT_EQ(scan.sensor, "top");
  EXPECT_EQ(scan.stamp.nanoseconds, kMadeEpochNanoseconds + 500'000'000);
  EXPECT_THAT(scan.x, ElementsAre(0.1F, 1.1F, 2.1F, 3.1F, 4.1F, 5.1F));
  EXPECT_THAT(scan.ring, ElementsAre(0, 1, 0, 1, 0, 1));
  EXPECT_THAT(scan.intensity, ElementsAre(0, 40, 80, 120, 160, 200));
  EXPECT_THAT(scan.time, ElementsAre(0, FloatEq(0.01F), FloatEq(0.02F), FloatEq(0.03F),
                                     FloatEq(0.04F), FloatEq(0.05F)));
  const auto* lidar = source->info().rig.find("top");
  EXPECT_EQ(lidar->T_body_sensor.translation, Eigen::Vector3d(1, 0, 2));
  EXPECT_EQ(lidar->lidar->rings, 2);
  EXPECT_EQ(lidar->lidar->min_range_m, 0.9);
  EXPECT_EQ(lidar->lidar->ring_source, sensors::RingSource::kData);
  EXPECT_EQ(lidar->lidar->time_source, sensors::TimeSource::kData);
}

/// MRPT 2.5.8's decoder gives 16 of the 32 returns of a block, all of a packet at one time.
TEST(Rawlog, OfVelodynePacketsEveryReturnIsAPointWithATimeOfItsOwn) {
  for (const auto& [model, lasers] : {std::pair(0x22, 16), std::pair(0x21, 32)}) {
    const TemporaryFolder folder;
    CObservationVelodyneScan observation = made_velodyne(0.5, 4);  // whose points are not taken
    observation.calibration.laser_corrections.clear();
    for (int i = 0; i < 3; ++i) {
      MadeVelodynePacket packet(5.0 * i, 0.4, static_cast<std::uint32_t>(1000 + 2000 * i), 0x37,
                                static_cast<std::uint8_t>(model));
      packet.fill(20);
      packet.set_return(2, 7, 0, 0);
      auto& stored = observation.scan_packets.emplace_back();
      std::memcpy(&stored, packet.bytes().data(), sizeof(stored));
    }
    {
      RawlogMaker maker(folder / "a.rawlog");
      maker.add(observation);
    }
    const auto source = open(folder / "a.rawlog");
    const auto scans = read_scans(*source);
    ASSERT_THAT(scans, SizeIs(1));
    const sensors::LidarScan& scan = *scans[0];
    EXPECT_EQ(scan.size(), 3U * (12 * 32 - 1));
    EXPECT_EQ(std::set<float>(scan.time.begin(), scan.time.end()).size(), 3U * 12 * 32 - 3);
    EXPECT_EQ(*std::max_element(scan.ring.begin(), scan.ring.end()), lasers - 1);
    EXPECT_NEAR(scan.time.back(), 4000e-6 + (lasers == 16 ? 1.306e-3 : 0.5426e-3), 1e-6);
    EXPECT_EQ(source->info().rig.find("top")->lidar->rings, lasers);
    EXPECT_THAT(skipped_in(*source), IsEmpty());
  }
}

TEST(Rawlog, PointCloudsInTheFileOrInFilesOfTheirOwn) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "a_Images");
  CObservationPointCloud inside;
  inside.timestamp = mrpt_time(0);
  inside.sensorLabel = "cloud";
  auto points = mrpt::maps::CPointsMapXYZI::Create();
  points->setSize(2);
  points->setPoint(0, 1, 2, 3);
  points->setPoint(1, 4, 5, 6);
  points->setPointIntensity(0, 0.25F);
  points->setPointIntensity(1, 0.75F);
  inside.pointcloud = points;
  CObservationPointCloud outside = inside;
  outside.timestamp = mrpt_time(1);
  outside.setAsExternalStorage("1.bin",
                               CObservationPointCloud::ExternalStorageFormat::MRPT_Serialization);
  CObservationPointCloud text = inside;
  text.timestamp = mrpt_time(2);
  text.setAsExternalStorage("2.txt", CObservationPointCloud::ExternalStorageFormat::PlainTextFile);
  CObservationPointCloud missing = inside;
  missing.timestamp = mrpt_time(3);
  missing.setAsExternalStorage("3.bin",
                               CObservationPointCloud::ExternalStorageFormat::MRPT_Serialization);
  CObservationPointCloud nothing;
  nothing.timestamp = mrpt_time(4);
  {
    RawlogMaker maker(folder / "a.rawlog");
    for (const auto* observation : {&inside, &outside, &text, &missing, &nothing}) {
      maker.add(*observation);
    }
  }
  mrpt::io::setLazyLoadPathBase((folder / "a_Images").string());
  outside.unload();
  text.unload();
  mrpt::io::setLazyLoadPathBase(".");

  const auto source = open(folder / "a.rawlog");
  const auto scans = read_scans(*source);
  EXPECT_THAT(skipped_in(*source),
              ElementsAre(HasSubstr("1 x external point cloud cannot be loaded: "),
                          "1 x point cloud is missing"));
  ASSERT_EQ(scans.size(), 3U);
  for (const auto& scan : scans) {
    EXPECT_THAT(scan->x, ElementsAre(1, 4));
    EXPECT_THAT(scan->z, ElementsAre(3, 6));
    EXPECT_THAT(scan->intensity, ElementsAre(0.25F, 0.75F));
    EXPECT_THAT(scan->ring, IsEmpty());
  }
  EXPECT_EQ(source->info().rig.find("cloud")->lidar->intensity_full_scale, 1);
}

/// A fix of that quality code of GGA.
CObservationGPS made_gga(double seconds, std::uint8_t quality) {
  CObservationGPS fix;
  fix.timestamp = mrpt_time(seconds);
  fix.sensorLabel = "gps";
  gnss::Message_NMEA_GGA message;
  message.fields.fix_quality = quality;
  message.fields.latitude_degrees = 36.5;
  message.fields.longitude_degrees = -2.5;
  fix.setMsg(message);
  return fix;
}

TEST(Rawlog, SaysOnceWhatEachQualityOfFixesIsTakenFor) {
  const TemporaryFolder folder;
  {
    RawlogMaker maker(folder / "a.rawlog");
    for (const int k : {0, 1, 2, 3}) maker.add(made_gga(0.1 * k, k < 2 ? 4 : 5));
    CObservationGPS told = made_gga(0.4, 1);  // whose own message says how exact it is
    gnss::Message_NV_OEM6_BESTPOS best;
    best.fields.solution_stat = gnss::nv_oem6_solution_status::SOL_COMPUTED;
    best.fields.lat_sigma = best.fields.lon_sigma = best.fields.hgt_sigma = 0.5F;
    told.setMsg(best);
    maker.add(told);
  }
  const auto source = open(folder / "a.rawlog");
  EXPECT_THAT(read_all(*source), SizeIs(5));
  std::vector<std::string> facts;
  for (const Fact& fact : source->info().facts) {
    if (fact.name.starts_with("sigma of fixes")) facts.push_back(fact.name + ": " + fact.value);
  }
  EXPECT_THAT(facts, ElementsAre("sigma of fixes of GGA quality 4: 0.02 m horizontally, 0.04 m "
                                 "vertically",
                                 "sigma of fixes of GGA quality 5: 0.3 m horizontally, 0.6 m "
                                 "vertically"));
}

TEST(Rawlog, PlanarScansImuGnssAndWheels) {
  CObservation2DRangeScan laser;
  laser.timestamp = mrpt_time(0);
  laser.sensorLabel = "front";
  laser.aperture = 3.0F;
  laser.rightToLeft = false;
  laser.maxRange = 30;
  laser.resizeScanAndAssign(3, 7, true);
  laser.setScanRangeValidity(1, false);

  CObservationGPS gga;
  gga.timestamp = mrpt_time(0.1);
  gga.sensorLabel = "gps";
  gnss::Message_NMEA_GGA gga_message;
  gga_message.fields.fix_quality = 4;
  gga_message.fields.latitude_degrees = 36.5;
  gga_message.fields.longitude_degrees = -2.5;
  gga_message.fields.altitude_meters = 100;
  gga_message.fields.geoidal_distance = 50;
  gga.setMsg(gga_message);
  CObservationGPS rmc = gga;
  rmc.clear();
  rmc.timestamp = mrpt_time(0.2);
  gnss::Message_NMEA_RMC rmc_message;
  rmc_message.fields.validity_char = 'A';
  rmc_message.fields.latitude_degrees = 36.6;
  rmc_message.fields.direction_degrees = 77;
  rmc.setMsg(rmc_message);

  CObservationOdometry wheels;
  wheels.timestamp = mrpt_time(0.3);
  wheels.sensorLabel = "odo";
  wheels.odometry = mrpt::poses::CPose2D(1, 2, 0.5);
  wheels.hasEncodersInfo = true;
  wheels.encoderLeftTicks = 11;
  wheels.encoderRightTicks = -12;
  wheels.hasVelocities = true;
  wheels.velocityLocal = {3, 0.1, 0.2};

  const auto all = measurements_of(laser, gga, rmc, wheels, made_imu(0.4));
  ASSERT_THAT(all, SizeIs(5));
  const auto& scan = *std::get<std::shared_ptr<const sensors::PlanarScan>>(all[0]);
  EXPECT_EQ(scan.first_azimuth, 1.5);  // clockwise: from the left
  EXPECT_EQ(scan.azimuth_step, -1.5);
  EXPECT_EQ(scan.max_range_m, 30);
  EXPECT_EQ(scan.ranges_m[0], 7);
  EXPECT_TRUE(std::isnan(scan.ranges_m[1]));

  const auto& fix = std::get<sensors::GnssFix>(all[1]);
  EXPECT_EQ(fix.latitude_deg, 36.5);
  EXPECT_EQ(fix.longitude_deg, -2.5);
  EXPECT_EQ(fix.altitude_m, 150);
  EXPECT_FALSE(fix.heading_deg);
  ASSERT_TRUE(fix.covariance_enu) << "fixed ambiguities";
  EXPECT_LT((*fix.covariance_enu)(0, 0), 0.05 * 0.05);
  const auto& flat_fix = std::get<sensors::GnssFix>(all[2]);
  EXPECT_EQ(flat_fix.latitude_deg, 36.6);
  EXPECT_TRUE(std::isnan(flat_fix.altitude_m));
  EXPECT_FALSE(flat_fix.heading_deg);  // the course is none

  const auto& odometry = std::get<sensors::WheelOdometry>(all[3]);
  EXPECT_EQ(odometry.T_odom_body->translation, Eigen::Vector3d(1, 2, 0));
  EXPECT_NEAR(odometry.T_odom_body->rotation(1, 0), std::sin(0.5), 1e-15);
  EXPECT_EQ(odometry.ticks->left, 11);
  EXPECT_EQ(odometry.ticks->right, -12);
  EXPECT_EQ(odometry.velocity->forward_mps, 3);
  EXPECT_EQ(odometry.velocity->yaw_rate, 0.2);

  const auto& imu = std::get<sensors::ImuSample>(all[4]);
  EXPECT_EQ(imu.sensor, "imu");
  EXPECT_EQ(imu.specific_force, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(imu.angular_rate, Eigen::Vector3d(4, 5, 6));
}

TEST(Rawlog, ActionsAddUpAndWaitForAStamp) {
  const auto action = [](double x, double seconds) {
    CActionRobotMovement2D movement;
    movement.rawOdometryIncrementReading = mrpt::poses::CPose2D(x, 0, 0);
    movement.hasEncodersInfo = true;
    movement.encoderLeftTicks = 5;
    movement.encoderRightTicks = 6;
    if (seconds > 0) movement.timestamp = mrpt_time(seconds);
    CActionCollection actions;
    actions.insert(movement);
    return actions;
  };
  const auto frame = [](double seconds) {
    auto laser = CObservation2DRangeScan::Create();
    laser->timestamp = mrpt_time(seconds);
    laser->resizeScanAndAssign(2, 1, true);
    CSensoryFrame result;
    result.insert(laser);
    return result;
  };
  const auto all =
      measurements_of(action(1, 0), frame(0.5), action(2, 0.9), frame(1.0), action(3, 0));
  EXPECT_THAT(made_stamps_of(all), ElementsAre(500, 500, 900, 1000));
  const auto& first = std::get<sensors::WheelOdometry>(all[0]);
  const auto& second = std::get<sensors::WheelOdometry>(all[2]);
  EXPECT_EQ(first.T_odom_body->translation.x(), 1);
  EXPECT_EQ(second.T_odom_body->translation.x(), 3);
  EXPECT_EQ(second.ticks->left, 10);
  EXPECT_EQ(second.ticks->right, 12);
  EXPECT_FALSE(second.velocity);
}

TEST(Rawlog, ScansOfAnySizeAndNameOfAnyLength) {
  for (std::size_t points = 1; points < 10; ++points) {
    const std::string name(points, 'n');
    const auto all = measurements_of(made_velodyne(0, points, name));
    ASSERT_THAT(all, SizeIs(1)) << points;
    EXPECT_EQ(sensor_of(all[0]), name);
    EXPECT_EQ(scans_in(all).at(0)->size(), points);
  }
}

TEST(Rawlog, ARotatingScanOfOneRowIsPlanar) {
  CObservationRotatingScan scan;
  scan.timestamp = mrpt_time(0);
  scan.rowCount = 1;
  scan.columnCount = 3;
  scan.rangeImage.resize(1, 3);
  scan.rangeImage(0, 0) = 100;
  scan.rangeImage(0, 1) = 0;
  scan.rangeImage(0, 2) = 300;
  scan.rangeResolution = 0.01;
  scan.startAzimuth = -1;
  scan.azimuthSpan = 2;
  const auto all = measurements_of(scan);
  const auto& planar = *std::get<std::shared_ptr<const sensors::PlanarScan>>(all.at(0));
  EXPECT_EQ(planar.first_azimuth, -1);
  EXPECT_EQ(planar.azimuth_step, 1);
  EXPECT_EQ(planar.ranges_m[2], 3);
  EXPECT_TRUE(std::isnan(planar.ranges_m[1]));
}

TEST(Rawlog, ARangeImageNeedsElevationsWhichCanBeStated) {
  const TemporaryFolder folder;
  {
    CObservationRotatingScan scan;
    scan.timestamp = mrpt_time(0);
    scan.lidarModel = "mine";
    scan.rowCount = 2;
    scan.columnCount = 4;
    scan.rangeImage.resize(2, 4);
    scan.rangeImage.fill(0);
    scan.rangeImage(1, 1) = 1000;
    scan.rangeResolution = 0.01;
    scan.startAzimuth = 0;
    scan.azimuthSpan = 2 * M_PI;  // counterclockwise, as documented
    scan.sweepDuration = 0.1;
    RawlogMaker maker(folder / "a.rawlog");
    maker.add(scan);
  }
  EXPECT_THAT(skipped_in(*[&] {
                auto source = open(folder / "a.rawlog");
                read_all(*source);
                return source;
              }()),
              ElementsAre("1 x range image of 2 rows without as many lidar.elevations_deg"));
  const auto scans = read_scans(*open(folder / "a.rawlog", {"lidar.elevations_deg=[0, 30]"}));
  ASSERT_THAT(scans, SizeIs(1));
  ASSERT_EQ(scans[0]->size(), 1U);
  EXPECT_NEAR(scans[0]->x[0], 0, 1e-6);
  EXPECT_NEAR(scans[0]->y[0], 10 * std::cos(M_PI / 6), 1e-5);
  EXPECT_NEAR(scans[0]->z[0], 5, 1e-5);
  EXPECT_THAT(scans[0]->ring, ElementsAre(1));
  EXPECT_THAT(scans[0]->time, ElementsAre(FloatEq(0.025F)));
}

}  // namespace
}  // namespace traverse::dataset
