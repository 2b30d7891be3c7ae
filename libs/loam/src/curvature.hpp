#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "traverse/lidar/scan_lines.hpp"

namespace traverse::loam {

/// Neighbours on each side that curvature looks at.
inline constexpr std::size_t kCurvatureReach = 5;

/// Curvature of points that have too few neighbours in their line.
inline constexpr float kNoCurvature = std::numeric_limits<float>::quiet_NaN();

/// Local surface smoothness of each point,
///     c_i = | sum_{j in S} (X_j - X_i) | / (|S| |X_i|),   S: five neighbours on each side,
/// inside one scan line only; kNoCurvature for the first and last five points of a line.
/// Source: Zhang and Singh, "LOAM: Lidar odometry and mapping in real-time", RSS 2014, eq. 1.
std::vector<float> curvature(const lidar::ScanLines& lines);

}  // namespace traverse::loam
