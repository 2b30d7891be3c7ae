// Runs Traverse's default odometry on scans that come from a loop of your own: a driver, a bag, a
// socket. Here a formula takes them in a made-up street, so that the truth is known.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <numbers>

#include "traverse/simulation/worlds.hpp"
#include "traverse/voxel_map/voxel_map_odometry.hpp"

namespace {

constexpr double kPeriod_s = 0.1;
constexpr double kSpeed_mps = 8;
constexpr int kRings = 32;
constexpr int kFirings = 900;  // of each beam in a sweep

double elevation(int ring) { return (-24.0 + 0.9 * ring) * std::numbers::pi / 180; }

traverse::geometry::Pose3 true_pose(double seconds) {
  traverse::geometry::Pose3 T_world_lidar;
  T_world_lidar.translation = {kSpeed_mps * seconds, std::sin(0.5 * seconds), 1.8};
  const double yaw = std::atan(0.5 * std::cos(0.5 * seconds) / kSpeed_mps);  // along the path
  T_world_lidar.rotation = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return T_world_lidar;
}

// What your driver does: fills a LidarScan. Points lie in the lidar's frame: x ahead, y left, z up.
traverse::sensors::LidarScan take_scan(const traverse::simulation::AnalyticScene& street,
                                       double seconds) {
  traverse::sensors::LidarScan scan;
  scan.stamp = traverse::geometry::Stamp::from_seconds(seconds);
  scan.sensor = "lidar";
  const traverse::geometry::Pose3 T_world_lidar = true_pose(seconds);
  for (int firing = 0; firing < kFirings; ++firing) {
    const double azimuth = std::numbers::pi * (1 - 2.0 * firing / kFirings);  // clockwise
    for (int ring = 0; ring < kRings; ++ring) {
      const double cosine = std::cos(elevation(ring));
      const Eigen::Vector3d ray(cosine * std::cos(azimuth), cosine * std::sin(azimuth),
                                std::sin(elevation(ring)));
      const auto hit =
          street.first_hit(T_world_lidar.translation, T_world_lidar.rotation * ray, 80);
      if (!hit) continue;
      const Eigen::Vector3f p = (hit->distance_m * ray).cast<float>();
      scan.x.push_back(p.x());
      scan.y.push_back(p.y());
      scan.z.push_back(p.z());
      scan.ring.push_back(static_cast<std::uint16_t>(ring));
    }
  }
  return scan;
}

}  // namespace

int main() {
  // What must be known of the lidar. Your scans have rings, so that angles need not be told; they
  // are taken at one moment here. A real sweep takes time: store each point's in scan.time, seconds
  // after scan.stamp, and leave time_source as it is.
  traverse::sensors::LidarProfile profile;
  profile.rings = kRings;
  profile.max_range_m = 80;
  profile.time_source = traverse::sensors::TimeSource::kNone;

  traverse::voxel_map::VoxelMapOdometryOptions options;  // those of the preset `traverse`
  options.threads = 2;
  const bool motion_compensated = true;  // nothing is left to deskew
  traverse::voxel_map::VoxelMapOdometry odometry(options, profile, motion_compensated);

  const traverse::simulation::AnalyticScene street = traverse::simulation::street(60, 1);
  const traverse::geometry::Pose3 T_first_world = true_pose(0).inverse();
  double error = 0;
  std::size_t frames = 0;
  // The first scans may be held back to find the initial speed from; then frames come scan by scan.
  const auto use = [&](const std::vector<traverse::lidar::Frame>& found) {
    for (const traverse::lidar::Frame& frame : found) {
      const Eigen::Vector3d& p =
          frame.T_map_lidar.translation;  // the map is the first scan's frame
      const Eigen::Vector3d truth = (T_first_world * true_pose(frame.stamp.seconds())).translation;
      error = (p - truth).norm();
      ++frames;
      std::printf("%5.1f s  x %7.3f  y %7.3f  z %7.3f m  error %.3f m  %s\n", frame.stamp.seconds(),
                  p.x(), p.y(), p.z(), error, frame.health.registered ? "registered" : "predicted");
    }
  };
  for (int i = 0; i < 25; ++i) use(odometry.process(take_scan(street, i * kPeriod_s)));
  use(odometry.finish());
  return frames == 25 && error < 0.1 ? EXIT_SUCCESS : EXIT_FAILURE;
}
