#pragma once

#include <cmath>
#include <vector>

#include "traverse/inertial/navigation.hpp"

#include "inertial/simulated_vehicle.hpp"

namespace traverse::testing {

/// Options as the presets have them, with the noise that is simulated.
inline inertial::NavigationOptions window(const SimulatedSensors& sensors) {
  inertial::SlidingWindowOptions options;
  options.imu = sensors.imu_noise;
  options.gnss.horizontal_m = sensors.gnss_sigma_m;
  options.gnss.vertical_m = 2 * sensors.gnss_sigma_m;
  options.wheels.forward_mps = 0.02;
  options.wheels.sideways_mps = 0.02;
  options.wheels.upwards_mps = 0.02;
  return options;
}

inline inertial::NavigationOptions two_frame(inertial::Trigger trigger,
                                             const SimulatedSensors& sensors) {
  inertial::NavigationOptions options = window(sensors);
  options.window.states = 2;
  options.trigger = trigger;
  options.gnss.form = inertial::GnssForm::kPose;
  options.gnss.heading_deg = 1;
  options.wheels.forward_mps = 0.05;
  options.wheels.use = trigger == inertial::Trigger::kGnssAndWheels;
  return options;
}

struct NavigationFigures {
  double position_rmse_m = 0;
  double heading_rmse_deg = 0;
  double roughness_m = 0;  ///< rms of the second difference of position at 10 Hz, less the truth's
};

inline std::size_t truth_index(const inertial::NavFrame& frame) {
  return static_cast<std::size_t>(std::lround(100 * (frame.state.stamp.seconds() - 1000)));
}

/// The pose of the truth at a frame's stamp, in the estimate's map (origin: the first fix).
inline geometry::Pose3 truth_at(const inertial::NavFrame& frame, const SimulatedDrive& drive,
                                const inertial::Navigation& navigation) {
  geometry::Pose3 T = drive.truth[truth_index(frame)];
  T.translation = navigation.plane()->to_enu(drive.plane.to_geodetic(T.translation));
  return T;
}

/// From `from_s` on, when the start's uncertainty is over; roughness over frames by fixes, which
/// all estimators have at the same moments.
inline NavigationFigures figures(const std::vector<inertial::NavFrame>& frames,
                                 const SimulatedDrive& drive,
                                 const inertial::Navigation& navigation, double from_s) {
  NavigationFigures f;
  double count = 0;
  double second_differences = 0;
  std::vector<Eigen::Vector3d> errors;
  for (const auto& frame : frames) {
    if (frame.state.stamp.seconds() < 1000 + from_s) continue;
    const geometry::Pose3 truth = truth_at(frame, drive, navigation);
    const Eigen::Vector3d error = frame.state.p_map - truth.translation;
    const Eigen::Matrix3d R = frame.state.rotation();
    const double heading = std::remainder(
        std::atan2(R(1, 0), R(0, 0)) - std::atan2(truth.rotation(1, 0), truth.rotation(0, 0)),
        2 * M_PI);
    f.position_rmse_m += error.squaredNorm();
    f.heading_rmse_deg += heading * heading;
    count += 1;
    if (frame.by_gnss) errors.push_back(error);
  }
  for (std::size_t k = 2; k < errors.size(); ++k) {
    second_differences += (errors[k] - 2 * errors[k - 1] + errors[k - 2]).squaredNorm();
  }
  f.position_rmse_m = std::sqrt(f.position_rmse_m / count);
  f.heading_rmse_deg = std::sqrt(f.heading_rmse_deg / count) * 180 / M_PI;
  if (errors.size() > 2) {
    f.roughness_m = std::sqrt(second_differences / static_cast<double>(errors.size() - 2));
  }
  return f;
}

/// Over so many drives with different noise; 95 % bounds of chi-square with 15 times as many
/// degrees of freedom, over the drives.
constexpr int kNeesDrives = 16;
constexpr double kLeastNees = 198.98 / kNeesDrives;
constexpr double kMostNees = 284.80 / kNeesDrives;

/// Normalised estimation error squared at the end of 45 s of the 15 unknowns before the wheel
/// scale. Without wheels, whose no-slip is exact here and whose pulses are no white noise.
inline double mean_nees() {
  constexpr int kUnknowns = 15;
  SimulatedVehicle car;
  car.light_every_s = 0;
  double sum = 0;
  for (int n = 0; n < kNeesDrives; ++n) {
    SimulatedSensors sensors;
    sensors.seed = static_cast<std::uint32_t>(n + 1);
    sensors.gnss_hz = 5;
    const SimulatedDrive drive = simulate(car, sensors, 45);
    inertial::NavigationOptions options = window(sensors);
    options.start.accelerometer_bias = sensors.accelerometer_bias;
    options.gnss.huber = 0;
    inertial::Navigation navigation(options, drive.mounts);
    const inertial::NavFrame last = run(navigation, drive, true, false).back();
    const std::size_t k = truth_index(last);
    inertial::NavState truth = last.state;
    const geometry::Pose3 T = truth_at(last, drive, navigation);
    truth.q_map_body = Eigen::Quaterniond(T.rotation);
    truth.p_map = T.translation;
    truth.v_map = drive.velocity[k];
    truth.gyro_bias = drive.gyro_bias[k];
    truth.accelerometer_bias = drive.accelerometer_bias[k];
    const Eigen::Matrix<double, kUnknowns, 1> e = truth.minus(last.state).head<kUnknowns>();
    const Eigen::Matrix<double, kUnknowns, kUnknowns> P =
        last.covariance.topLeftCorner<kUnknowns, kUnknowns>();
    sum += e.dot(P.ldlt().solve(e));
  }
  return sum / kNeesDrives;
}

}  // namespace traverse::testing
