#pragma once

#include <optional>

#include "traverse/geometry/stamp.hpp"

namespace traverse::inertial {

/// Whether wheels that disagree with the estimate have themselves to blame. A wheel that locks or
/// spins changes its speed from one reading to the next as no IMU has felt it; an estimate that has
/// gone astray has done so bit by bit. The jumps are added up: when a wheel grips again it jumps
/// back, and what is left of the disagreement is the estimate's.
class WheelJumps {
 public:
  /// \param sigma_mps  of a reading, forward
  explicit WheelJumps(double sigma_mps) : sigma_mps_(sigma_mps) {}

  /// \param excess_mps  the estimate's forward speed less the wheels'
  void add(geometry::Stamp stamp, double excess_mps);
  /// The estimate has taken a reading, or has begun again.
  void agree() { jumped_mps_ = 0; }
  bool has_jumped() const;

 private:
  double bound() const;

  double sigma_mps_;
  double jumped_mps_ = 0;
  struct Reading {
    geometry::Stamp stamp;
    double excess_mps;
  };
  std::optional<Reading> last_;
};

}  // namespace traverse::inertial
