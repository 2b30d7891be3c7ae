#include "traverse/simulation/ring_order.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <tuple>
#include <vector>

namespace traverse::simulation {

sensors::LidarScan in_ring_order(const sensors::LidarScan& scan) {
  std::vector<double> azimuth;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const double angle = std::atan2(scan.y[i], scan.x[i]);
    azimuth.push_back(angle < 0 ? angle + 2 * std::numbers::pi : angle);
  }
  std::vector<std::size_t> order(scan.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::tie(scan.ring[a], azimuth[a]) < std::tie(scan.ring[b], azimuth[b]);
  });
  sensors::LidarScan result;
  result.stamp = scan.stamp;
  result.sensor = scan.sensor;
  result.reserve(scan.size());
  for (const std::size_t i : order) {
    result.x.push_back(scan.x[i]);
    result.y.push_back(scan.y[i]);
    result.z.push_back(scan.z[i]);
    result.intensity.push_back(scan.intensity[i] / 255.0F);
  }
  return result;
}

sensors::LidarProfile in_ring_order(sensors::LidarProfile profile) {
  profile.ring_source = sensors::RingSource::kStorageOrder;
  profile.time_source = sensors::TimeSource::kAzimuth;
  profile.intensity_full_scale = 1;
  return profile;
}

geometry::Pose3 camera_axes() {
  geometry::Pose3 T_lidar_camera;
  T_lidar_camera.rotation << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return T_lidar_camera;
}

}  // namespace traverse::simulation
