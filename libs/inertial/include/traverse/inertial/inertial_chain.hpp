#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include <Eigen/Core>

#include "traverse/geometry/pose3.hpp"
#include "traverse/inertial/nav_state.hpp"
#include "traverse/inertial/navigation_options.hpp"
#include "traverse/inertial/wheel_mount.hpp"
#include "traverse/sensors/imu_sample.hpp"
#include "traverse/sensors/wheel_encoder.hpp"
#include "traverse/sensors/wheel_odometry.hpp"

namespace traverse::inertial {

struct InertialChainOptions {
  ImuNoise imu;
  WindowOptions window;
  WheelOptions wheels;
};

/// The wheels' place, in the body's axes, and what their pulses mean.
struct ChainWheels {
  WheelMount mount;
  std::optional<sensors::WheelEncoder> encoder;
};

/// A pose that something else than the IMU found, of a sensor that shares the body's axes.
struct FoundPose {
  geometry::Pose3 T_map_sensor;
  Eigen::Vector3d p_body = Eigen::Vector3d::Zero();  ///< of the sensor, m
  /// Of (rotation [rad] on the right, position [m] in the map); directions may have none.
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
};

/// The fixed-lag smoother of navigation for an odometry that finds poses itself: a chain of states
/// that pre-integrated readings of an IMU link, each with the pose that was found for it and what
/// wheels said, marginalised at its old end. The map may lie in any way; gravity in it is told.
///
///     append()    the next state, as the IMU and, if there are any, the wheels predict it
///     predicted(), covariance()    what a pose is to be looked for with
///     constrain() by the pose that was found, and the chain is solved
class InertialChain {
 public:
  /// \param gravity_map  [m/s^2]
  InertialChain(const InertialChainOptions& options, const std::optional<ChainWheels>& wheels,
                const Eigen::Vector3d& gravity_map);
  InertialChain(const InertialChain& other);
  InertialChain(InertialChain&&) noexcept;
  InertialChain& operator=(InertialChain&&) noexcept;
  ~InertialChain();

  /// \param sigma  standard deviations of the tangent; of what nothing is said of, those of the
  /// options
  void start(const NavState& state, const NavState::Tangent& sigma);

  /// Adds the state at the stamp of the last reading. \param readings  of the IMU, the first at the
  /// newest state's stamp, in the body's axes \param wheels  those between the two states
  /// \pre at least two readings, with stamps that grow
  void append(std::span<const sensors::ImuSample> readings,
              std::span<const sensors::WheelOdometry> wheels);

  /// Constrains the newest state and solves. \throws NotSolvable if the states cannot be solved for
  void constrain(const FoundPose& found);

  const NavState& newest() const;
  /// Of the newest state with all that was said of it, in its tangent.
  const NavState::Matrix& covariance() const;
  const Eigen::Vector3d& gravity_map() const;
  std::size_t wheel_readings_used() const;
  std::size_t wheel_readings_rejected() const;
  const std::map<std::string, std::size_t>& events() const;
  std::size_t bytes() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// Standard deviations with which a chain starts, of what is told; the others follow from the
/// wheels' options and from that nothing measures them.
NavState::Tangent first_sigma(const WheelOptions& wheels, double rotation_rad, double position_m,
                              double velocity_mps, double gyro_bias, double accelerometer_bias);

}  // namespace traverse::inertial
