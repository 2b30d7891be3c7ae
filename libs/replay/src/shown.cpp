#include "traverse/replay/shown.hpp"

#include <cmath>
#include <memory>
#include <variant>

#include "traverse/sensors/rings.hpp"
#include "traverse/sensors/sweep_timing.hpp"

namespace traverse::replay {

namespace {

using LidarPtr = std::shared_ptr<const sensors::LidarScan>;
using PlanarPtr = std::shared_ptr<const sensors::PlanarScan>;

template <typename Scan>
const Scan* scan_of(const SessionFrame& frame) {
  if (!frame.scan) return nullptr;
  const auto* held = std::get_if<std::shared_ptr<const Scan>>(&*frame.scan);
  return held == nullptr ? nullptr : held->get();
}

std::vector<Eigen::Vector3f> points_of(const pipeline::UsedScan& used) {
  std::vector<Eigen::Vector3f> points;
  points.reserve(used.x.size());
  for (std::size_t i = 0; i < used.x.size(); ++i) {
    points.emplace_back(used.x[i], used.y[i], used.z[i]);
  }
  return points;
}

/// The returns of a 2-D laser in the body frame.
std::vector<Eigen::Vector3f> points_of(const sensors::PlanarScan& scan, const sensors::Rig& rig) {
  const auto* sensor = rig.find(scan.sensor);
  const geometry::Pose3 T_body_sensor =
      sensor != nullptr ? sensor->T_body_sensor : geometry::Pose3::identity();
  std::vector<Eigen::Vector3f> points;
  for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
    const double range = scan.ranges_m[i];
    const bool is_return =
        std::isfinite(range) && range > 0 && (scan.max_range_m <= 0 || range < scan.max_range_m);
    if (!is_return) continue;
    const double azimuth = scan.first_azimuth + static_cast<double>(i) * scan.azimuth_step;
    const Eigen::Vector3d p_sensor(range * std::cos(azimuth), range * std::sin(azimuth), 0);
    points.push_back((T_body_sensor * p_sensor).cast<float>());
  }
  return points;
}

/// Ring and time of the points, where the scan or the profile tells them.
void add_rings_and_times(const sensors::LidarScan& scan, const sensors::LidarProfile& profile,
                         const std::vector<std::uint32_t>& source, ShownScan& shown) {
  const sensors::PointClock clock(scan, profile);
  if (clock.knows()) {
    for (const std::uint32_t i : source) shown.time_s.push_back(clock(i));
  }
  try {
    const sensors::RingAssignment rings = sensors::assign_rings(scan, profile);
    for (const std::uint32_t i : source) shown.ring.push_back(rings.ring[i]);
  } catch (const sensors::NoRings&) {
    // Then there is no colouring by ring, and the window says so.
  }
}

}  // namespace

ShownScan scan_to_show(const SessionFrame& frame, const pipeline::Estimator& estimator,
                       const sensors::Rig& rig) {
  ShownScan shown;
  if (const auto* planar = scan_of<sensors::PlanarScan>(frame)) {
    shown.points_body = points_of(*planar, rig);
  }
  const auto* scan = scan_of<sensors::LidarScan>(frame);
  if (scan == nullptr) return shown;
  pipeline::UsedScan used = estimator.used_scan(*scan, frame.pose, true);
  shown.points_body = points_of(used);
  shown.intensity = std::move(used.intensity);
  shown.feature_class = std::move(used.feature_class);
  const auto* sensor = rig.find(scan->sensor);
  if (sensor != nullptr && sensor->lidar && used.source.size() == shown.points_body.size()) {
    add_rings_and_times(*scan, *sensor->lidar, used.source, shown);
  }
  return shown;
}

MapPoints points_in_map(const SessionFrame& frame, const pipeline::Estimator& estimator,
                        const sensors::Rig& rig) {
  MapPoints map;
  if (const auto* planar = scan_of<sensors::PlanarScan>(frame)) {
    map.points_map = points_of(*planar, rig);
  }
  if (const auto* scan = scan_of<sensors::LidarScan>(frame)) {
    pipeline::UsedScan used = estimator.used_scan(*scan, frame.pose, false);
    map.points_map = points_of(used);
    map.intensity = std::move(used.intensity);
  }
  for (Eigen::Vector3f& p : map.points_map) {
    p = (frame.pose.T_map_body * p.cast<double>()).cast<float>();
  }
  return map;
}

}  // namespace traverse::replay
