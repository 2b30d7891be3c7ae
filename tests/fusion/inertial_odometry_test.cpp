#include "traverse/fusion/inertial_odometry.hpp"

#include <cstring>

#include <gtest/gtest.h>

#include "fusion/simulated_imu.hpp"
#include "lidar/odometry_trial.hpp"
#include "lidar/simulated_drive.hpp"

namespace traverse::fusion {
namespace {

using testing::SimulatedDrive;
using testing::worst_position_error;

const Eigen::Vector3d kGyroBias(0.004, -0.006, 0.005);
const Eigen::Vector3d kAccelerometerBias(0.03, -0.02, 0.04);

/// Begins early, with few hypotheses of the initial speed.
InertialOdometryOptions quick_start() {
  InertialOdometryOptions options;
  options.lidar.start.slowest_mps = 8;
  options.lidar.start.fastest_mps = 16;
  options.start.moving_s = 0.8;
  // As that of the lidar alone, which poses are held against.
  options.lidar.covariance = true;
  options.min_plane_width_m = options.lidar.map.planes.fit.min_width_m;
  return options;
}

class InertialStreet : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    street_ = new SimulatedDrive(simulation::street(60, 1), 20, testing::swerving());
    imu_ = new std::vector<sensors::ImuSample>(
        testing::simulated_imu([](double t) { return street_->drive.pose(t); },
                               sensors_.p_lidar_imu, -0.1, 2.1, kGyroBias, kAccelerometerBias));
  }
  static void TearDownTestSuite() {
    delete street_;
    delete imu_;
  }
  static const SimulatedDrive& street() { return *street_; }
  static const std::vector<sensors::ImuSample>& imu() { return *imu_; }

  static InertialOdometry made(const InertialOdometryOptions& options, bool with_imu = true) {
    InertialOdometry odometry(options, street().scanner.profile, false);
    sensors::Rig rig = sensors_.rig;
    if (!with_imu) rig.sensors.pop_back();
    odometry.mount(rig, rig.sensors[0]);
    return odometry;
  }

  static inline testing::LidarAndImu sensors_;

 private:
  static inline SimulatedDrive* street_ = nullptr;
  static inline std::vector<sensors::ImuSample>* imu_ = nullptr;
};

void expect_same_poses(const std::vector<lidar::Frame>& a, const std::vector<lidar::Frame>& b) {
  ASSERT_EQ(a.size(), b.size());
  const auto same = [](const auto& x, const auto& y) {
    return std::memcmp(x.data(), y.data(), sizeof(double) * static_cast<std::size_t>(x.size())) ==
           0;
  };
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_TRUE(same(a[i].T_map_lidar.rotation, b[i].T_map_lidar.rotation)) << i;
    EXPECT_TRUE(same(a[i].T_map_lidar.translation, b[i].T_map_lidar.translation)) << i;
    EXPECT_TRUE(same(a[i].velocity, b[i].velocity)) << i;
    EXPECT_EQ(a[i].map_points, b[i].map_points) << i;
    EXPECT_TRUE(same(a[i].covariance.value(), b[i].covariance.value())) << i;
  }
}

std::size_t count_fused(const std::vector<lidar::Frame>& frames) {
  std::size_t fused = 0;
  for (const lidar::Frame& frame : frames) fused += frame.further.at(0) > 0 ? 1 : 0;
  return fused;
}

std::string note_of(const InertialOdometry& odometry) { return odometry.notes().at(0).value; }

TEST_F(InertialStreet, FollowsTheDriveAndFindsTheBiases) {
  InertialOdometry odometry = made(quick_start());
  const auto frames = testing::frames_of(odometry, street(), imu());
  ASSERT_EQ(frames.size(), street().scans.size());
  EXPECT_GE(count_fused(frames), 10U) << note_of(odometry);
  EXPECT_TRUE(odometry.uses_imu());
  const std::vector<double>& told = frames.back().further;
  for (Eigen::Index k = 0; k < 3; ++k) {
    EXPECT_NEAR(told[1 + static_cast<std::size_t>(k)], kGyroBias[k], 4e-3);
  }
  EXPECT_EQ(odometry.further_columns().size(), told.size());
}

// By the three per cent that it may be worse where nothing but the lidar tells the way.
TEST(InertialOdometry, IsNoWorseThanTheLidarAlone) {
  const testing::LidarAndImu sensors;
  double by_lidar_m = 0;
  double fused_m = 0;
  for (const unsigned seed : {1U, 2U, 3U}) {
    const SimulatedDrive drive(simulation::street(60, seed), 20, testing::swerving());
    const auto imu =
        testing::simulated_imu([&](double t) { return drive.drive.pose(t); }, sensors.p_lidar_imu,
                               -0.1, 2.1, kGyroBias, kAccelerometerBias);
    voxel_map::VoxelMapOdometry alone(quick_start().lidar, drive.scanner.profile, false);
    InertialOdometry odometry(quick_start(), drive.scanner.profile, false);
    odometry.mount(sensors.rig, sensors.rig.sensors[0]);
    by_lidar_m += worst_position_error(testing::frames_of(alone, drive), drive);
    fused_m += worst_position_error(testing::frames_of(odometry, drive, imu), drive);
    EXPECT_TRUE(odometry.uses_imu()) << seed;
  }
  EXPECT_LT(fused_m, 1.03 * by_lidar_m);
}

// Every scan of a lidar that stands shows the same rings: planes through the points of one of them
// would say that nothing moves.
TEST(InertialOdometry, WhileItStandsOneScanIsAllThatTheMapHas) {
  const testing::LidarAndImu sensors;
  simulation::Drive parked;
  parked.speed_mps = 0;
  parked.sway = 0;
  const SimulatedDrive drive(simulation::street(15, 1), 13, parked);
  const auto imu =
      testing::simulated_imu([&](double t) { return drive.drive.pose(t); }, sensors.p_lidar_imu,
                             -0.1, 2.1, kGyroBias, kAccelerometerBias);
  InertialOdometryOptions options;
  options.lidar.start.scans = 2;
  options.lidar.start.slowest_mps = 0;
  options.lidar.start.fastest_mps = 1;
  options.start.stand_still.seconds = 0.5;
  InertialOdometry odometry(options, drive.scanner.profile, false);
  odometry.mount(sensors.rig, sensors.rig.sensors[0]);
  const auto frames = testing::frames_of(odometry, drive, imu);
  ASSERT_EQ(frames.size(), 13U);
  ASSERT_GE(count_fused(frames), 5U) << note_of(odometry);
  const std::size_t alone = frames.size() - count_fused(frames) - 1;
  EXPECT_LT(frames[alone + 2].map_points, frames[alone].map_points);
  EXPECT_EQ(frames[alone + 2].map_points, frames.back().map_points);
  EXPECT_LT(worst_position_error(frames, drive), 0.02);
}

TEST_F(InertialStreet, WithoutAnImuItIsTheLidarAloneBitForBit) {
  voxel_map::VoxelMapOdometry alone(quick_start().lidar, street().scanner.profile, false);
  InertialOdometry odometry = made(quick_start(), false);
  expect_same_poses(testing::frames_of(alone, street()),
                    testing::frames_of(odometry, street(), imu()));
  EXPECT_NE(note_of(odometry).find("no IMU"), std::string::npos);
  EXPECT_FALSE(odometry.uses_imu());
}

TEST_F(InertialStreet, AnImuInGIsNotUsedAndSaysSo) {
  std::vector<sensors::ImuSample> in_g = imu();
  for (sensors::ImuSample& sample : in_g) sample.specific_force /= 9.80665;
  voxel_map::VoxelMapOdometry alone(quick_start().lidar, street().scanner.profile, false);
  InertialOdometry odometry = made(quick_start());
  expect_same_poses(testing::frames_of(alone, street()),
                    testing::frames_of(odometry, street(), in_g));
  EXPECT_NE(note_of(odometry).find("gravity"), std::string::npos) << note_of(odometry);
}

TEST_F(InertialStreet, AnImuOnWrongAxesIsGivenUpAndTheLidarGoesOn) {
  std::vector<sensors::ImuSample> turned = imu();
  for (sensors::ImuSample& sample : turned) {
    for (Eigen::Vector3d* v : {&sample.angular_rate, &sample.specific_force}) {
      *v = Eigen::Vector3d(-v->y(), v->x(), v->z());
    }
  }
  InertialOdometryOptions options = quick_start();
  options.start.most_gravity_error = 100;  // it begins all the same
  InertialOdometry odometry = made(options);
  const auto frames = testing::frames_of(odometry, street(), turned);
  ASSERT_EQ(frames.size(), street().scans.size());
  EXPECT_GT(count_fused(frames), 0U) << note_of(odometry);
  EXPECT_EQ(frames.back().further.at(0), 0) << note_of(odometry);
  EXPECT_TRUE(odometry.notes().at(0).is_trouble);
  EXPECT_NE(note_of(odometry).find("given up after frame"), std::string::npos);
  EXPECT_LT(worst_position_error(frames, street()), 0.1);
}

TEST_F(InertialStreet, TheSameBitsForAnyNumberOfThreads) {
  InertialOdometry one = made(quick_start());
  InertialOdometryOptions options = quick_start();
  options.threads = 3;
  InertialOdometry three = made(options);
  expect_same_poses(testing::frames_of(one, street(), imu()),
                    testing::frames_of(three, street(), imu()));
}

TEST_F(InertialStreet, ACloneGoesOnAlike) {
  InertialOdometry original = made(quick_start());
  SimulatedDrive first = street();
  first.scans.resize(14);
  auto reading = imu().begin();
  std::vector<lidar::Frame> ignored;
  for (const auto& scan : first.scans) {
    for (; reading != imu().end() && reading->stamp <= scan.stamp; ++reading) {
      original.observe(*reading);
    }
    original.process(scan);
  }
  const auto clone = original.clone();
  const auto rest = [&](lidar::Odometry& odometry) {
    SimulatedDrive second = street();
    second.scans.erase(second.scans.begin(), second.scans.begin() + 14);
    return testing::frames_of(odometry, second, {reading, imu().end()});
  };
  expect_same_poses(rest(*clone), rest(original));
}

/// The IMU stops for good after 1.2 s: poses go on, by the lidar and constant velocity.
TEST_F(InertialStreet, AnImuThatEndsDoesNotEndTheEstimate) {
  std::vector<sensors::ImuSample> cut = imu();
  cut.resize(130);
  InertialOdometry odometry = made(quick_start());
  const auto frames = testing::frames_of(odometry, street(), cut);
  ASSERT_EQ(frames.size(), street().scans.size());
  EXPECT_LT(worst_position_error(frames, street()), 0.25);
  EXPECT_EQ(odometry.notes().size(), 2U) << "the gap is told";
}

}  // namespace
}  // namespace traverse::fusion
