#include "traverse/simulation/scanner.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include "traverse/geometry/angle.hpp"

namespace traverse::simulation {

sensors::LidarScan Scanner::scan(const AnalyticScene& scene, const Drive& drive,
                                 double seconds) const {
  sensors::LidarScan scan;
  scan.stamp = geometry::Stamp::from_seconds(seconds);
  scan.sensor = "lidar";
  std::mt19937_64 generator(seed ^ static_cast<std::uint64_t>(scan.stamp.nanoseconds));
  std::normal_distribution<double> noise(0, range_noise_m > 0 ? range_noise_m : 1);

  const double turn = profile.rotation == sensors::Rotation::kClockwise ? -1 : 1;
  for (int column = 0; column < azimuth_steps; ++column) {
    const double fraction = (column + 0.5) / azimuth_steps;
    const double azimuth =
        profile.seam_azimuth_deg * geometry::kDegree + turn * fraction * 2 * std::numbers::pi;
    const double after_stamp = (fraction - profile.stamp_fraction) * profile.sweep_s;
    const geometry::Pose3 T_map_lidar = drive.pose(seconds + after_stamp);
    for (std::size_t ring = 0; ring < profile.elevations_deg.size(); ++ring) {
      const double elevation = profile.elevations_deg[ring] * geometry::kDegree;
      const Eigen::Vector3d direction(std::cos(elevation) * std::cos(azimuth),
                                      std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      const auto hit = scene.first_hit(T_map_lidar.translation, T_map_lidar.rotation * direction,
                                       profile.max_range_m);
      if (!hit) continue;
      const double error = range_noise_m > 0 ? noise(generator) : 0;
      const Eigen::Vector3f p = (direction * (hit->distance_m + error)).cast<float>();
      const double cosine = hit->normal.dot(-(T_map_lidar.rotation * direction));
      scan.x.push_back(p.x());
      scan.y.push_back(p.y());
      scan.z.push_back(p.z());
      scan.intensity.push_back(
          static_cast<float>(profile.intensity_full_scale * hit->reflectivity * cosine));
      scan.ring.push_back(static_cast<std::uint16_t>(ring));
      scan.time.push_back(static_cast<float>(after_stamp));
    }
  }
  return scan;
}

Scanner demo_scanner() {
  Scanner scanner;
  scanner.profile.name = "simulated 64-beam lidar";
  scanner.profile.rings = 64;
  scanner.profile.min_range_m = 1;
  scanner.profile.max_range_m = 80;
  scanner.profile.intensity_full_scale = 1;
  for (int ring = 0; ring < 64; ++ring) {
    scanner.profile.elevations_deg.push_back(2 - ring * 26.8 / 63);
  }
  scanner.range_noise_m = 0.02;
  return scanner;
}

}  // namespace traverse::simulation
