#include "traverse/inertial/inertial_chain.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "inertial/simulated_vehicle.hpp"

namespace traverse::inertial {
namespace {

constexpr double kFrom_s = 12;  // it drives, and turns soon
constexpr double kTo_s = 27;
const Eigen::Vector3d kSensor(0.4, -0.1, 1.3);  // on the body

/// A chain with a state each 0.1 s, whose poses a sensor finds exactly, with `information` of
/// (rotation, position in the map).
class InertialChainWithPoses : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    drive_ = new testing::SimulatedDrive(
        testing::simulate(testing::SimulatedVehicle(), testing::SimulatedSensors(), kTo_s + 1));
  }
  static void TearDownTestSuite() { delete drive_; }
  static const testing::SimulatedDrive& drive() { return *drive_; }

  static std::size_t moment(double t) { return static_cast<std::size_t>(std::lround(100 * t)); }

  static InertialChain driven(const Eigen::Matrix<double, 6, 1>& sigma, bool with_wheels) {
    InertialChainOptions options;
    options.window.states = 5;
    std::optional<ChainWheels> wheels;
    if (with_wheels) wheels = ChainWheels{drive().mounts.wheels, drive().mounts.encoder};
    InertialChain chain(options, wheels, {0, 0, -9.80665});
    NavState first;
    first.stamp = drive().imu[moment(kFrom_s)].stamp;
    first.q_map_body = drive().truth[moment(kFrom_s)].quaternion();
    first.p_map = drive().truth[moment(kFrom_s)].translation;
    first.v_map = drive().velocity[moment(kFrom_s)];
    chain.start(first, first_sigma(options.wheels, 1e-3, 0.01, 0.05, 0.01, 0.2));
    for (double t = kFrom_s; t < kTo_s - 0.05; t += 0.1) {
      const std::size_t i = moment(t);
      const std::vector<sensors::ImuSample> readings(
          drive().imu.begin() + static_cast<long>(i),
          drive().imu.begin() + static_cast<long>(i) + 11);
      std::vector<sensors::WheelOdometry> between;
      for (const sensors::WheelOdometry& reading : drive().wheels) {
        if (reading.stamp > readings.front().stamp && reading.stamp <= readings.back().stamp) {
          between.push_back(reading);
        }
      }
      chain.append(readings, between);
      FoundPose found;
      const geometry::Pose3& truth = drive().truth[i + 10];
      found.T_map_sensor = {truth.rotation, truth * kSensor};
      found.p_body = kSensor;
      found.information = sigma.cwiseAbs2().cwiseInverse().asDiagonal();
      chain.constrain(found);
    }
    return chain;
  }

  static Eigen::Vector3d position_error(const InertialChain& chain) {
    return chain.newest().p_map - drive().truth[moment(kTo_s)].translation;
  }

 private:
  static inline testing::SimulatedDrive* drive_ = nullptr;
};

TEST_F(InertialChainWithPoses, FindsVelocityAndBiases) {
  Eigen::Matrix<double, 6, 1> sigma;
  sigma << Eigen::Vector3d::Constant(1e-3), Eigen::Vector3d::Constant(0.01);
  const InertialChain chain = driven(sigma, false);
  const std::size_t end = moment(kTo_s);
  EXPECT_LT(position_error(chain).norm(), 0.01);
  EXPECT_LT((chain.newest().v_map - drive().velocity[end]).norm(), 0.03);
  EXPECT_LT((chain.newest().gyro_bias - drive().gyro_bias[end]).norm(), 1e-3);
  EXPECT_LT((chain.newest().accelerometer_bias - drive().accelerometer_bias[end]).norm(), 0.05);
}

/// As in a tunnel: nothing is found of the way east.
TEST_F(InertialChainWithPoses, CarryADirectionThatPosesDoNotTell) {
  Eigen::Matrix<double, 6, 1> sigma;
  sigma << Eigen::Vector3d::Constant(1e-3), Eigen::Vector3d::Constant(0.01);
  sigma[3] = INFINITY;
  const InertialChain without = driven(sigma, false);
  const InertialChain with = driven(sigma, true);
  const double sigma_m = std::sqrt(without.covariance()(NavState::kPosition, NavState::kPosition));
  EXPECT_GT(sigma_m, 0.05);
  EXPECT_LT(std::abs(position_error(without).x()), 3 * sigma_m) << "it knows how little it knows";
  EXPECT_LT(std::abs(position_error(with).x()), 0.6) << "150 m, the wheels' scale is unknown";
  EXPECT_LT(position_error(with).tail<2>().norm(), 0.02);
  EXPECT_GT(with.wheel_readings_used(), 100U);
  EXPECT_EQ(with.wheel_readings_rejected(), 0U);
  EXPECT_LT(with.covariance()(NavState::kPosition, NavState::kPosition), sigma_m * sigma_m);
}

}  // namespace
}  // namespace traverse::inertial
