#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "traverse/geometry/pose3.hpp"
#include "traverse/sensors/lidar_profile.hpp"
#include "traverse/sensors/lidar_scan.hpp"
#include "traverse/simulation/counter_noise.hpp"
#include "traverse/simulation/surroundings.hpp"
#include "traverse/simulation/vehicle_motion.hpp"

namespace traverse::simulation {

/// A spinning lidar on a moving vehicle, or one whose mirror turns and nods. Every ray leaves from
/// where the sensor is at that moment and in the direction of its beam; a ray that meets nothing
/// gives no point. Ranges have the profile's noise and resolution; dark surfaces, far ones and
/// those met at a flat angle are lost. Points are stored in firing order with ring and time.
class LidarSimulator {
 public:
  /// The references must outlive this.
  /// \throws std::invalid_argument saying what the profile lacks.
  LidarSimulator(const sensors::LidarProfile& profile, const geometry::Pose3& T_body_lidar,
                 const Surroundings& surroundings, const VehicleMotion& motion, std::uint64_t seed);

  /// Whole sweeps within the drive.
  std::size_t sweeps() const;
  /// When sweep `i` begins, and the moment of its stamp; seconds of the drive.
  double begin_s(std::size_t i) const;
  double stamp_s(std::size_t i) const;

  /// Sweep `i`, its stamp in seconds of the drive. Safe to call from several threads; the same
  /// bytes each time.
  sensors::LidarScan scan(std::size_t i) const;

 private:
  struct Block;
  void aim(double seconds, double sweep_begin_s, std::size_t column, Block& block) const;
  Eigen::Vector3d by_mirror(std::size_t beam, double seconds) const;
  void keep(const Block& block, std::size_t column, std::uint64_t firing, double stamp_s,
            sensors::LidarScan& scan) const;

  sensors::LidarProfile profile_;
  geometry::Pose3 T_body_lidar_;
  const Surroundings& surroundings_;
  const VehicleMotion& motion_;
  CounterNoise noise_;

  /// One beam: when it fires after the others, and its direction when the head looks ahead.
  struct Beam {
    double after_s;
    double cos_elevation, sin_elevation;
    double cos_azimuth, sin_azimuth;  ///< of its offset and of the head's turn during after_s
  };
  std::vector<Beam> beams_;
  double period_s_;
  double turn_rate_;  ///< of the head or the mirror, rad/s, counterclockwise
  bool has_mirror_ = false;
};

}  // namespace traverse::simulation
