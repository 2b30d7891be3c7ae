#include "traverse/simulation/vehicle_motion.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "traverse/geometry/so3.hpp"

#include "simulation/motion_settings.hpp"

namespace traverse::simulation {
namespace {

using Eigen::Vector3d;
using testing::hills;
using testing::winding_drive;
using testing::winding_route;

void expect_derivatives(const VehicleMotion& motion) {
  geometry::Pose3 T_body_sensor;
  T_body_sensor.rotation = geometry::exp_so3({0.1, -0.2, 0.7});
  T_body_sensor.translation = {1.2, -0.4, 1.7};
  constexpr double h = 1e-4;
  for (double t = 0.7; t < motion.duration_s() - 0.5; t += 1.03) {
    const MotionState before = motion.state(t - h).at(T_body_sensor);
    const MotionState at = motion.state(t).at(T_body_sensor);
    const MotionState after = motion.state(t + h).at(T_body_sensor);
    const Vector3d velocity =
        (after.T_map_body.translation - before.T_map_body.translation) / (2 * h);
    const Vector3d acceleration = (after.velocity_map - before.velocity_map) / (2 * h);
    const Vector3d rate =
        geometry::log_so3(before.T_map_body.rotation.transpose() * after.T_map_body.rotation) /
        (2 * h);
    const Vector3d angular = (after.angular_rate_body - before.angular_rate_body) / (2 * h);
    EXPECT_LT((velocity - at.velocity_map).norm(), 1e-6) << t;
    EXPECT_LT((acceleration - at.acceleration_map).norm(), 1e-5) << t;
    EXPECT_LT((rate - at.angular_rate_body).norm(), 1e-6) << t;
    EXPECT_LT((angular - at.angular_acceleration_body).norm(), 1e-5) << t;
  }
}

TEST(VehicleMotion, RatesAndAccelerationsAreDerivativesOfThePose) {
  expect_derivatives(winding_drive());
}

TEST(VehicleMotion, CarriedByHandItTurnsFastAndStandsWhileItStands) {
  RouteSettings route = winding_route();
  route.speed_mps = 1.4;
  GaitSettings gait;
  gait.turn_deg = 64;
  gait.bob_m = gait.sway_m = 0.03;
  gait.tilt_deg = 3;
  const VehicleMotion motion(route, {}, hills(), 9, {}, gait);
  expect_derivatives(motion);
  double fastest = 0;
  for (double t = 0; t < motion.duration_s(); t += 0.05) {
    fastest = std::max(fastest, motion.state(t).angular_rate_body.norm());
  }
  EXPECT_NEAR(fastest, 200 * M_PI / 180, 0.5);
  EXPECT_LT(motion.state(0.1).velocity_map.norm(), 1e-9);
  EXPECT_LT(motion.state(0.1).angular_rate_body.norm(), 1e-9);
}

TEST(VehicleMotion, TheExpansionIsExactToRoundingWithinAFiring) {
  const VehicleMotion motion = winding_drive();
  constexpr double kLater = 5e-5;
  for (double t = 1; t < motion.duration_s(); t += 0.9) {
    const geometry::Pose3 expanded = motion.state(t).pose_after(kLater);
    const geometry::Pose3 exact = motion.state(t + kLater).T_map_body;
    EXPECT_LT((expanded.translation - exact.translation).norm(), 1e-11);
    EXPECT_LT((expanded.rotation - exact.rotation).norm(), 1e-11);
  }
}

TEST(VehicleMotion, StandsOnTheGroundAndNeverSlipsSideways) {
  const VehicleMotion motion = winding_drive();
  SuspensionSettings stiff;
  stiff.roll_deg_per_mps2 = stiff.pitch_deg_per_mps2 = stiff.roughness_deg = 0;
  const VehicleMotion rigid(winding_route(), stiff, hills(), 9);
  for (double t = 0; t < motion.duration_s(); t += 0.31) {
    const Vector3d& p = motion.state(t).T_map_body.translation;
    EXPECT_NEAR(p.z(), hills().height(p.x(), p.y()), 1e-12);
    const MotionState state = rigid.state(t);
    const Vector3d v_body = state.T_map_body.rotation.transpose() * state.velocity_map;
    EXPECT_NEAR(v_body.y(), 0, 1e-12);
    EXPECT_NEAR(v_body.z(), 0, 1e-12);
    EXPECT_GE(v_body.x(), -1e-12);
    EXPECT_LT((state.T_map_body.rotation.transpose() * state.T_map_body.rotation -
               Eigen::Matrix3d::Identity())
                  .norm(),
              1e-12);
  }
}

TEST(VehicleMotion, KeepsToItsLimitsAndStopsWhereAsked) {
  const RouteSettings route = winding_route();
  const VehicleMotion motion = winding_drive();
  double fastest = 0;
  double jerk = 0;
  double stood_at_stop = 0;
  constexpr double dt = 0.01;
  for (double t = 0; t < motion.duration_s(); t += dt) {
    const Jet s = motion.progress(t);
    fastest = std::max(fastest, s.rate);
    jerk = std::max(jerk, std::abs(motion.progress(t + dt).bend - s.bend) / dt);
    if (std::abs(s.value - 60) < 0.6 && s.rate < 1e-6) stood_at_stop += dt;
  }
  EXPECT_LE(fastest, route.speed_mps * 1.001);
  EXPECT_GT(fastest, 0.8 * route.speed_mps);
  EXPECT_LE(jerk, 1.02 * route.jerk_mps3);
  EXPECT_NEAR(stood_at_stop, route.stop_s, 0.3);
  EXPECT_NEAR(motion.progress(motion.duration_s()).value, motion.route().length_m(), 1e-6);
  EXPECT_LT(motion.state(0).velocity_map.norm(), 1e-9);
}

}  // namespace
}  // namespace traverse::simulation
