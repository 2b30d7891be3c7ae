#pragma once

#include "traverse/geometry/stamp.hpp"
#include "traverse/sensors/imu_sample.hpp"

namespace traverse::inertial {

/// The reading between two, by a line between them.
sensors::ImuSample interpolated(const sensors::ImuSample& before, const sensors::ImuSample& after,
                                geometry::Stamp stamp);

}  // namespace traverse::inertial
