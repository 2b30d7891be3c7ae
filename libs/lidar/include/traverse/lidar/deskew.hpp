#pragma once

#include <string>

#include "traverse/geometry/pose3.hpp"
#include "traverse/lidar/timed_points.hpp"
#include "traverse/sensors/lidar_profile.hpp"

namespace traverse::lidar {

/// The points as they would have been measured all at once at the scan's stamp by a lidar that
/// moves with the constant body `velocity` (rotation rate [rad/s], velocity [m/s], lidar frame):
/// p_stamp = Exp(time * velocity) p. Exact for that motion, for any rate.
TimedPoints deskewed(const TimedPoints& points, const geometry::Twist& velocity);

/// Whether an odometry deskews ("on"), and, if not, why.
std::string deskew_note(bool wanted, const sensors::LidarProfile& profile, bool motion_compensated);

}  // namespace traverse::lidar
