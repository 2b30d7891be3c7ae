#pragma once

#include <cmath>

#include "traverse/inertial/navigation_options.hpp"

namespace traverse::inertial {

/// Pairing::kPaired counts each measurement twice, in each of two states: at half its weight that
/// is once.
inline constexpr double kPairedVariance = 2;

inline bool is_paired(const NavigationOptions& options) {
  return options.trigger == Trigger::kGnssAndWheels && options.pairing == Pairing::kPaired;
}

/// The wheels' options with which the estimate is made.
inline WheelOptions weighed(const NavigationOptions& options) {
  WheelOptions wheels = options.wheels;
  if (!is_paired(options)) return wheels;
  for (double* sigma : {&wheels.forward_mps, &wheels.sideways_mps, &wheels.upwards_mps}) {
    *sigma *= std::sqrt(kPairedVariance);
  }
  return wheels;
}

}  // namespace traverse::inertial
