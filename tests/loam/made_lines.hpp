#pragma once

#include <cmath>
#include <functional>

#include "traverse/lidar/scan_lines.hpp"

namespace traverse::testing {

/// Appends a scan line in the plane z = 0 whose k-th of `count` points lies at azimuth
/// `first + k step` [rad] and at the range that `range_at(azimuth)` gives.
inline void add_line(lidar::ScanLines& lines, int count, double first, double step,
                     const std::function<double(double)>& range_at) {
  for (int k = 0; k < count; ++k) {
    const double azimuth = first + k * step;
    const double range = range_at(azimuth);
    lines.x.push_back(static_cast<float>(range * std::cos(azimuth)));
    lines.y.push_back(static_cast<float>(range * std::sin(azimuth)));
    lines.z.push_back(0);
    lines.range.push_back(static_cast<float>(range));
    lines.source.push_back(static_cast<std::uint32_t>(lines.source.size()));
  }
  lines.line_begin.push_back(static_cast<std::uint32_t>(lines.x.size()));
}

}  // namespace traverse::testing
