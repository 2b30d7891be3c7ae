#pragma once

#include <deque>
#include <optional>

#include "traverse/geometry/stamp.hpp"
#include "traverse/sensors/imu_sample.hpp"

namespace traverse::inertial {

/// What the headings of two antennas scatter by, which no receiver's log tells: from one to the
/// next they change by what the gyro turned, and by the noise of both of them. Headings that are
/// wrong altogether are not part of their scatter.
class HeadingScatter {
 public:
  /// Readings of the IMU in the body's axes, in the order of their stamps.
  void add(const sensors::ImuSample& sample);
  /// A heading counterclockwise from east [rad].
  void add(geometry::Stamp stamp, double heading);
  /// The gyro's turn begins anew.
  void forget_turn();

  /// The deviation of a heading [rad], `told` unless they clearly scatter by more.
  double sigma(double told) const;

 private:
  struct Turned {
    geometry::Stamp stamp;
    double heading;
    double turn;
  };
  std::optional<sensors::ImuSample> last_imu_;
  double turn_ = 0;  ///< rad
  std::optional<Turned> last_;
  std::deque<double> differences_;  ///< as of one heading [rad]
};

}  // namespace traverse::inertial
