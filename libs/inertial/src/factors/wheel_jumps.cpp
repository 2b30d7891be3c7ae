#include "factors/wheel_jumps.hpp"

#include <cmath>
#include <numbers>

#include "factors/innovation.hpp"

namespace traverse::inertial {

void WheelJumps::add(geometry::Stamp stamp, double excess_mps) {
  constexpr double kLongest = 1;  // s between readings; beyond, what happened is not known
  if (last_ && geometry::seconds_between(last_->stamp, stamp) <= kLongest) {
    const double change = excess_mps - last_->excess_mps;
    if (std::abs(change) > bound()) jumped_mps_ += change;
  }
  last_ = {stamp, excess_mps};
}

bool WheelJumps::has_jumped() const { return std::abs(jumped_mps_) > bound(); }

/// Of the difference of two readings, by chi-square; the IMU's share in a tenth of a second is
/// thousandths of a metre a second.
double WheelJumps::bound() const {
  return std::sqrt(chi2_bound(1)) * std::numbers::sqrt2 * sigma_mps_;
}

}  // namespace traverse::inertial
