// What all odometries promise is tested in tests/lidar/odometry_contract_test.cpp.
#include "traverse/loam/two_stage_odometry.hpp"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "traverse/loam/factor_kinds.hpp"
#include "traverse/optimization/jacobian_audit.hpp"

#include "lidar/odometry_trial.hpp"
#include "lidar/simulated_drive.hpp"
#include "loam/simulated_gyro.hpp"

namespace traverse::loam {
namespace {

using testing::position_error;
using testing::rotation_error;
using testing::SimulatedDrive;
using testing::worst_position_error;

std::vector<lidar::Frame> run(const SimulatedDrive& drive, const TwoStageOdometryOptions& options,
                              const std::vector<sensors::ImuSample>& imu = {}) {
  TwoStageOdometry odometry(options, drive.scanner.profile, false);
  return testing::frames_of(odometry, drive, imu);
}

/// The preset aloam or loam, with one hypothesis of the initial speed: the search has its own test.
TwoStageOdometryOptions preset(SweepMotion sweep_motion) {
  TwoStageOdometryOptions options;
  options.solver.line_form = LineForm::kVector;
  options.odometry.sweep_motion = sweep_motion;
  options.imu.use = sweep_motion == SweepMotion::kDeskew;
  options.start.slowest_mps = options.start.fastest_mps = 12;
  return options;
}

/// A scan of nothing, or of the first `points` points of another one.
sensors::LidarScan cut(const sensors::LidarScan& scan, std::size_t points) {
  sensors::LidarScan result = scan;
  for (auto* values : {&result.x, &result.y, &result.z, &result.intensity, &result.time}) {
    values->resize(points);
  }
  result.ring.resize(points);
  return result;
}

class TwoStage : public ::testing::TestWithParam<SweepMotion> {
 protected:
  static void SetUpTestSuite() {
    street_ = new SimulatedDrive(simulation::street(60, 1), 14, 12);
    swerve_ = new SimulatedDrive(simulation::street(60, 1), 14, testing::swerving());
  }
  static void TearDownTestSuite() {
    delete street_;
    delete swerve_;
  }
  static const SimulatedDrive& street() { return *street_; }
  static const SimulatedDrive& swerve() { return *swerve_; }
  static TwoStageOdometryOptions options() { return preset(GetParam()); }

 private:
  static inline SimulatedDrive* street_ = nullptr;
  static inline SimulatedDrive* swerve_ = nullptr;
};

INSTANTIATE_TEST_SUITE_P(Presets, TwoStage,
                         ::testing::Values(SweepMotion::kPerPoint, SweepMotion::kDeskew),
                         [](const auto& param_info) {
                           return param_info.param == SweepMotion::kPerPoint ? "aloam" : "loam";
                         });

TEST_P(TwoStage, TheFirstStageAloneHasNoMap) {
  TwoStageOdometryOptions options = this->options();
  options.registration_steps = 0;
  TwoStageOdometry odometry(options, street().scanner.profile, false);
  for (const auto& scan : street().scans) odometry.process(scan);
  EXPECT_TRUE(odometry.matches().empty());
  EXPECT_TRUE(odometry.local_map().empty());
}

TEST_P(TwoStage, TellsOfItsFirstStageToo) {
  const auto frames = run(street(), options());
  ASSERT_EQ(frames.size(), street().scans.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].further[0], i > 0 ? 1 : 0) << "registered in the last scan";
    EXPECT_EQ(frames[i].further[6], 0) << "degenerate directions of that";
  }
}

TEST_P(TwoStage, TheMapCorrectsWhatTheOdometryDrifts) {
  TwoStageOdometry odometry(options(), swerve().scanner.profile, false);
  lidar::Frame last;
  for (const auto& scan : swerve().scans) {
    for (const lidar::Frame& frame : odometry.process(scan)) last = frame;
  }
  const geometry::Pose3 T_odom_lidar = odometry.T_map_odom().inverse() * last.T_map_lidar;
  const double drift = (T_odom_lidar.translation - swerve().truth.back().translation).norm();
  EXPECT_LT(position_error(last, swerve()), drift);
}

TEST_P(TwoStage, AScanWithNoFeaturesOrThreeKeepsThePredictionAndSaysSo) {
  for (const std::size_t points : {0U, 3U}) {
    SimulatedDrive drive = street();
    drive.scans[10] = cut(drive.scans[10], points);
    const auto frames = run(drive, options());
    EXPECT_EQ(frames[10].points, points);
    EXPECT_FALSE(frames[10].health.registered);
    EXPECT_EQ(frames[10].further[0], 0);
    EXPECT_EQ(frames[11].further[0], 0) << "the last scan has nothing to be registered in";
    EXPECT_TRUE(frames[11].health.registered) << "in the map";
    EXPECT_EQ(frames[12].further[0], 1);
    EXPECT_LT(worst_position_error(frames, drive), 0.15);
  }
}

TEST_P(TwoStage, EqualStampsGiveAFrameAndLeaveTheSpeed) {
  for (const std::size_t at : {1U, 9U}) {  // within the start, and after it
    SimulatedDrive drive = street();
    drive.scans.insert(drive.scans.begin() + static_cast<std::ptrdiff_t>(at), drive.scans[at]);
    drive.truth.insert(drive.truth.begin() + static_cast<std::ptrdiff_t>(at), drive.truth[at]);
    const auto frames = run(drive, options());
    ASSERT_EQ(frames.size(), drive.scans.size());
    EXPECT_EQ(frames[at + 1].stamp, frames[at].stamp);
    EXPECT_EQ(frames[at + 1].velocity, frames[at].velocity);
    EXPECT_LT(worst_position_error(frames, drive), 0.1);
  }
}

TEST_P(TwoStage, ATunnelIsReportedDegenerateAlongItsAxisAndTheEstimateDoesNotJump) {
  const SimulatedDrive drive(simulation::tunnel(100), 16, 8);
  const Eigen::Vector3d axis_map = drive.drive.pose(0).rotation.transpose().col(0);
  const auto frames = run(drive, options());
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const geometry::Pose3& T_map_lidar = frames[i].T_map_lidar;
    const lidar::Observability& seen = frames[i].health.observability;
    EXPECT_GE(seen.degenerate, 1) << i;
    EXPECT_GE(frames[i].further[6], 1) << i << ": in the first stage";
    const Eigen::Vector3d weakest = seen.directions.col(0).tail<3>();
    EXPECT_GT(std::abs(weakest.dot(T_map_lidar.rotation.transpose() * axis_map)), 0.95) << i;
    // Nothing tells the speed, so the prediction is rest; across the axis the path is seen.
    const Eigen::Vector3d step = T_map_lidar.translation - frames[i - 1].T_map_lidar.translation;
    EXPECT_LT(std::abs(step.dot(axis_map)), 0.05) << i;
    const Eigen::Vector3d error = T_map_lidar.translation - drive.truth[i].translation;
    EXPECT_LT((error - error.dot(axis_map) * axis_map).norm(), 0.15) << i;
  }
}

// What the gyro is for: a lidar that sees nothing for a while, in a bend.
TEST(TwoStageOdometry, TheGyroCarriesARotationThatConstantVelocityCannotKnow) {
  SimulatedDrive drive(simulation::street(60, 1), 16, testing::swerving());
  for (const std::size_t blind : {8U, 9U, 10U}) drive.scans[blind] = cut(drive.scans[blind], 0);
  const auto gyro = testing::simulated_gyro(drive.drive, -0.1, 1.6);
  const auto without = run(drive, preset(SweepMotion::kDeskew));
  const auto with_gyro = run(drive, preset(SweepMotion::kDeskew), gyro);
  EXPECT_EQ(without[10].further[8], 0);
  EXPECT_EQ(with_gyro[10].further[8], 1) << "turn measured";
  EXPECT_LT(rotation_error(with_gyro[10], drive), 0.005);
  EXPECT_GT(rotation_error(without[10], drive), 5 * rotation_error(with_gyro[10], drive));
}

TEST(TwoStageOdometry, AnImuThatStopsIsMissedNotFollowed) {
  const SimulatedDrive drive(simulation::street(60, 1), 16, testing::swerving());
  const auto gyro = testing::simulated_gyro(drive.drive, -0.1, 0.5);
  const auto frames = run(drive, preset(SweepMotion::kDeskew), gyro);
  EXPECT_EQ(frames[4].further[8], 1);
  EXPECT_EQ(frames[8].further[8], 0);
  EXPECT_LT(worst_position_error(frames, drive), 0.1);
}

TEST(TwoStageOdometry, ItsFactorsAreThoseOfItsStages) {
  const auto names = [](const TwoStageOdometryOptions& options, bool motion_compensated) {
    const TwoStageOdometry odometry(options, simulation::demo_scanner().profile,
                                    motion_compensated);
    std::vector<std::string> found;
    for (const auto& kind : optimization::selected(factor_kinds(), odometry.factors())) {
      found.push_back(kind.name);
    }
    return found;
  };
  const std::vector<std::string> plain{"line vector", "plane signed"};
  const std::vector<std::string> swept{"swept line vector", "swept plane signed"};
  const std::vector<std::string> both{swept[0], swept[1], plain[0], plain[1]};
  EXPECT_EQ(names(preset(SweepMotion::kPerPoint), false), both);
  EXPECT_EQ(names(preset(SweepMotion::kPerPoint), true), plain) << "nothing to undo";
  EXPECT_EQ(names(preset(SweepMotion::kDeskew), false), plain);
  TwoStageOdometryOptions first_alone = preset(SweepMotion::kPerPoint);
  first_alone.registration_steps = 0;
  EXPECT_EQ(names(first_alone, false), swept);
}

}  // namespace
}  // namespace traverse::loam
