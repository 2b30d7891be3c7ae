#pragma once

#include <cstddef>

namespace traverse::sensors {

/// Raises (or lowers, if negative) the elevation angle of every point by `angle` [rad]; range and
/// azimuth stay. Points on the vertical axis have no azimuth and stay. x, y, z: n values each.
void correct_elevation(float* x, float* y, float* z, std::size_t n, double angle);

}  // namespace traverse::sensors
