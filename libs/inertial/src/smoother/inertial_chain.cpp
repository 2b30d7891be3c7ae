#include "traverse/inertial/inertial_chain.hpp"

#include <cmath>
#include <utility>

#include <Eigen/Eigenvalues>

#include "traverse/geometry/angle.hpp"

#include "factors/imu_link.hpp"
#include "factors/wheel_constraint.hpp"
#include "navigation/wheel_speed.hpp"
#include "residuals/sensor_pose.hpp"
#include "smoother/fixed_lag_smoother.hpp"

namespace traverse::inertial {

using sensors::ImuSample;
using sensors::WheelOdometry;

namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// The W with W' W = information; rows of directions without any are zero.
Matrix6d square_root(const Matrix6d& information) {
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(information);
  return eigen.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal() *
         eigen.eigenvectors().transpose();
}

NavigationOptions navigation_options_of(const InertialChainOptions& chain) {
  NavigationOptions options;
  options.wheels = chain.wheels;
  return options;
}

}  // namespace

class InertialChain::Impl {
 public:
  Impl(const InertialChainOptions& options, const std::optional<ChainWheels>& wheels,
       const Eigen::Vector3d& gravity)
      : gravity_map(gravity),
        smoother(options.window, options.imu, calibration_walk(navigation_options_of(options)),
                 gravity),
        link_(options.imu) {
    if (!wheels || !options.wheels.use) return;
    wheels_.emplace(
        Wheels{{wheels->encoder, options.wheels.standing_mps}, {options.wheels, wheels->mount}});
  }

  void start(const NavState& state, const NavState::Tangent& sigma) {
    smoother.start(state, sigma);
    link_.begin(state);
  }

  void append(std::span<const ImuSample> readings, std::span<const WheelOdometry> wheels) {
    link_.begin(smoother.newest());
    link_.set_last(readings.front());
    std::size_t next = 0;
    const auto take_wheels_until = [&](geometry::Stamp stamp) {
      for (; next < wheels.size() && wheels[next].stamp <= stamp; ++next) {
        if (wheels_) wheels_->speed.add(wheels[next]);
      }
    };
    take_wheels_until(readings.front().stamp);
    for (const ImuSample& reading : readings.subspan(1)) {
      link_.observe(reading);
      const ImuLink::Step step = link_.add(reading, smoother.newest(), gravity_map);
      if (wheels_) wheels_->speed.add_change(reading.stamp, step.speed_change_mps);
      take_wheels_until(reading.stamp);
    }
    smoother.append(link_.take());
    if (wheels_) constrain_by_wheels(readings.back());
  }

  void constrain(const FoundPose& found) {
    smoother.add(std::make_unique<ModelFactor<SensorPoseResidual>>(
        SensorPoseResidual{found.T_map_sensor, found.p_body}, square_root(found.information)));
    smoother.solve();
  }

  Eigen::Vector3d gravity_map;
  FixedLagSmoother smoother;
  std::map<std::string, std::size_t> events;
  std::size_t wheels_used = 0;
  std::size_t wheels_rejected = 0;

 private:
  struct Wheels {
    WheelSpeed speed;
    WheelConstraint constraint;
  };

  void constrain_by_wheels(const ImuSample& reading) {
    if (!wheels_->speed.is_fresh()) return;
    NavFrame frame;
    const WheelConstraint::Trust trust{.now = reading.stamp, .has_fixes = true};
    wheels_->constraint.constrain(smoother, wheels_->speed, reading.angular_rate, trust, frame,
                                  events);
    for (const Innovation& said : {frame.wheels, frame.standing}) {
      if (said.rows == 0) continue;
      ++(said.is_rejected ? wheels_rejected : wheels_used);
      if (!said.is_rejected) smoother.solve();
    }
  }

  ImuLink link_;
  std::optional<Wheels> wheels_;
};

InertialChain::InertialChain(const InertialChainOptions& options,
                             const std::optional<ChainWheels>& wheels,
                             const Eigen::Vector3d& gravity_map)
    : impl_(std::make_unique<Impl>(options, wheels, gravity_map)) {}
InertialChain::InertialChain(const InertialChain& other)
    : impl_(std::make_unique<Impl>(*other.impl_)) {}
InertialChain::InertialChain(InertialChain&&) noexcept = default;
InertialChain& InertialChain::operator=(InertialChain&&) noexcept = default;
InertialChain::~InertialChain() = default;

void InertialChain::start(const NavState& state, const NavState::Tangent& sigma) {
  impl_->start(state, sigma);
}
void InertialChain::append(std::span<const ImuSample> readings,
                           std::span<const WheelOdometry> wheels) {
  impl_->append(readings, wheels);
}
void InertialChain::constrain(const FoundPose& found) { impl_->constrain(found); }
const NavState& InertialChain::newest() const { return impl_->smoother.newest(); }
const NavState::Matrix& InertialChain::covariance() const { return impl_->smoother.covariance(); }
const Eigen::Vector3d& InertialChain::gravity_map() const { return impl_->gravity_map; }
std::size_t InertialChain::wheel_readings_used() const { return impl_->wheels_used; }
std::size_t InertialChain::wheel_readings_rejected() const { return impl_->wheels_rejected; }
const std::map<std::string, std::size_t>& InertialChain::events() const { return impl_->events; }
std::size_t InertialChain::bytes() const {
  return impl_->smoother.size() * 4 * sizeof(NavState::Matrix);
}

NavState::Tangent first_sigma(const WheelOptions& wheels, double rotation_rad, double position_m,
                              double velocity_mps, double gyro_bias, double accelerometer_bias) {
  constexpr double kUnmeasured = 1e-3;  // no fixes: what they err by is said to be nothing
  NavState::Tangent sigma = NavState::Tangent::Constant(kUnmeasured);
  sigma.segment<3>(NavState::kRotation).setConstant(rotation_rad);
  sigma.segment<3>(NavState::kPosition).setConstant(position_m);
  sigma.segment<3>(NavState::kVelocity).setConstant(velocity_mps);
  sigma.segment<3>(NavState::kGyroBias).setConstant(gyro_bias);
  sigma.segment<3>(NavState::kAccelerometerBias).setConstant(accelerometer_bias);
  sigma[NavState::kWheelScale] = wheels.scale;
  sigma.segment<2>(NavState::kWheelTurn).setConstant(geometry::kDegree * wheels.turn_deg);
  return sigma;
}

}  // namespace traverse::inertial
