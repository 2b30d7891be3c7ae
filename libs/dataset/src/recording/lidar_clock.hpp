#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "traverse/geometry/pose3.hpp"

#include "recording/lidar_returns.hpp"

namespace traverse::dataset {

/// By how much the stamps of a lidar are late.
struct Lateness {
  double late_s = 0;
  double sigma_s = 0;      ///< standard error, from how single sweeps scatter
  std::size_t sweeps = 0;  ///< that told it
};

/// Finds out how late the stamps of a lidar are against those of another one on the same vehicle.
///
/// Both see the same surfaces. While the vehicle moves, a return that is dated wrongly is put where
/// the vehicle was not when it was measured: off the surface by the way between, along its normal.
/// Of two sweeps of the first lidar and what the other measured meanwhile, the motion (six numbers,
/// constant over two sweeps) and the lateness are those with which the returns of the second sweep
/// and of the other lidar lie best on the surfaces of the first sweep (Gauss-Newton with Cauchy's
/// weights, point to plane, surfaces in cells from coarse to fine). Each such pair of sweeps tells
/// it as well as its speed and the surfaces across it allow.
class LidarClock {
 public:
  /// \param ahead_first the direction in which the vehicle drives, in the first lidar's frame
  explicit LidarClock(const Eigen::Vector3d& ahead_first) : ahead_first_(ahead_first) {}

  /// \param sweep of the first lidar \param next its sweep behind it
  /// \param other what the other lidar measured during both, by its own stamps
  void add(const LidarReturns& sweep, const LidarReturns& next, const LidarReturns& other);

  /// Nothing as long as too few sweeps tell it.
  std::optional<Lateness> lateness() const;
  /// More sweeps would not tell it better.
  bool is_known() const;

 private:
  struct OfSweep {
    double late_s;
    double sigma_s;
  };

  Eigen::Vector3d ahead_first_;
  std::optional<geometry::Twist> motion_;  ///< of the last sweeps, a second
  std::vector<OfSweep> told_;
};

}  // namespace traverse::dataset
