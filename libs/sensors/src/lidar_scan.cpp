#include "traverse/sensors/lidar_scan.hpp"

#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace traverse::sensors {

void LidarScan::reserve(std::size_t points) {
  x.reserve(points);
  y.reserve(points);
  z.reserve(points);
}

PointFaults count_faults(const LidarScan& scan) {
  PointFaults faults;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const bool finite =
        std::isfinite(scan.x[i]) && std::isfinite(scan.y[i]) && std::isfinite(scan.z[i]);
    if (!finite) {
      ++faults.not_finite;
    } else if (scan.x[i] == 0 && scan.y[i] == 0 && scan.z[i] == 0) {
      ++faults.at_origin;
    }
  }
  return faults;
}

void check_consistent(const LidarScan& scan) {
  const auto fits = [&](std::size_t size) { return size == 0 || size == scan.size(); };
  if (scan.y.size() != scan.size() || scan.z.size() != scan.size() ||
      !fits(scan.intensity.size()) || !fits(scan.ring.size()) || !fits(scan.time.size())) {
    throw std::invalid_argument(fmt::format(
        "a scan's arrays differ in size: x {}, y {}, z {}, intensity {}, ring {}, time {}",
        scan.x.size(), scan.y.size(), scan.z.size(), scan.intensity.size(), scan.ring.size(),
        scan.time.size()));
  }
}

}  // namespace traverse::sensors
