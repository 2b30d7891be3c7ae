#pragma once

#include "traverse/geometry/pose3.hpp"
#include "traverse/lidar/timed_points.hpp"

namespace traverse::lidar {

/// The points as they would have been measured all at once at the scan's stamp by a lidar that
/// moves with the constant body `velocity` (rotation rate [rad/s], velocity [m/s], lidar frame):
/// p_stamp = Exp(time * velocity) p. Exact for that motion, for any rate.
TimedPoints deskewed(const TimedPoints& points, const geometry::Twist& velocity);

}  // namespace traverse::lidar
