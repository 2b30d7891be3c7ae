#pragma once

#include <memory>
#include <string>
#include <variant>

#include "traverse/sensors/gnss_fix.hpp"
#include "traverse/sensors/imu_sample.hpp"
#include "traverse/sensors/lidar_scan.hpp"
#include "traverse/sensors/planar_scan.hpp"
#include "traverse/sensors/wheel_odometry.hpp"

namespace traverse::sensors {

/// Anything a recording yields. Scans are shared: they are large and nobody changes them.
using Measurement =
    std::variant<std::shared_ptr<const LidarScan>, std::shared_ptr<const PlanarScan>, ImuSample,
                 GnssFix, WheelOdometry>;

geometry::Stamp stamp_of(const Measurement& measurement);
const std::string& sensor_of(const Measurement& measurement);

}  // namespace traverse::sensors
