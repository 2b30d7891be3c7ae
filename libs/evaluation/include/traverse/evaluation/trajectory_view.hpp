#pragma once

#include <cstddef>
#include <span>

#include "traverse/evaluation/poses.hpp"
#include "traverse/evaluation/trajectory_store.hpp"
#include "traverse/geometry/trajectory.hpp"

namespace traverse::evaluation {

/// What the file of a trajectory tells time in. Association is evo's, which makes floating-point
/// seconds of either in its own way.
enum class TimesInFile {
  kSeconds,      ///< TUM: the double that is nearest to the decimal number
  kNanoseconds,  ///< EuRoC: the double that is nearest to the whole number, divided by 1e9
};

/// A trajectory to be evaluated, in memory or in a TrajectoryStore. A view: the trajectory must
/// outlive it.
struct TrajectoryView {
  bool is_stamped = true;
  std::span<const geometry::Stamp> stamps;  ///< one a pose; empty when not is_stamped
  TimesInFile times = TimesInFile::kSeconds;
  Poses poses;  ///< T_map_body

  TrajectoryView(const geometry::Trajectory& trajectory)
      : is_stamped(trajectory.is_stamped()),
        stamps(trajectory.stamps()),
        poses(trajectory.poses()) {}
  TrajectoryView(const TrajectoryStore& trajectory)
      : is_stamped(trajectory.is_stamped()),
        stamps(trajectory.stamps()),
        poses(trajectory.size(), [&trajectory](std::size_t i) { return trajectory.pose(i); }) {}

  std::size_t size() const { return poses.size(); }
  bool empty() const { return poses.empty(); }
};

}  // namespace traverse::evaluation
