#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "traverse/config/binder.hpp"

namespace traverse::sensors {

/// Where the ring number of a point comes from.
enum class RingSource {
  kData,          ///< stored with each point
  kStorageOrder,  ///< points are stored ring after ring; a ring ends where the azimuth wraps
  kElevation,     ///< the beam with the nearest elevation angle; the last resort
};

/// Where the time of a point within the sweep comes from.
enum class TimeSource {
  kData,     ///< stored with each point
  kAzimuth,  ///< from the azimuth, for a head that turns at constant rate
  kNone,     ///< unknown: no deskew
};

enum class Rotation { kClockwise, kCounterclockwise };  ///< of the head, seen from above

/// What must be known of a lidar to use its points. Read from share/sensors/*.yaml.
struct LidarProfile {
  std::string name = "unknown lidar";
  int rings = 0;             ///< beams; 0: unknown
  double min_range_m = 0.5;  ///< nearer points are the vehicle itself or noise
  double max_range_m = 120;
  double intensity_full_scale = 255;  ///< the stored intensity that stands for "brightest"

  RingSource ring_source = RingSource::kData;
  std::vector<double> elevations_deg;  ///< of the beams, ring 0 first, up positive; may be empty

  TimeSource time_source = TimeSource::kData;
  double sweep_s = 0.1;  ///< duration of one revolution
  Rotation rotation = Rotation::kClockwise;
  double seam_azimuth_deg = 180;  ///< where a sweep begins and ends; 0 ahead, 90 left
  double stamp_fraction = 0.5;    ///< share of the sweep that is over at the scan's stamp

  /// Added to every point's elevation angle. KITTI's HDL-64E reads 0.205 degrees low: Deschaud,
  /// "IMLS-SLAM", ICRA 2018, section IV.
  double vertical_correction_deg = 0;
};

void bind(config::Binder& binder, LidarProfile& profile);

/// \throws files::InputError naming file and line.
LidarProfile load_lidar_profile(const std::filesystem::path& yaml);

}  // namespace traverse::sensors
