#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <numbers>
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

/// When and where the beams of a spinning lidar fire. Only the simulator needs it.
struct LidarFiring {
  double period_us = 0;          ///< from one firing of all beams to the next; 0: unknown
  std::vector<double> times_us;  ///< of each beam after the firing's start; empty: all at once
  std::vector<double> azimuth_offsets_deg;  ///< of each beam, counterclockwise; empty: none
};

/// How well a lidar measures. Only the simulator needs it.
struct LidarNoise {
  double range_m = 0.02;              ///< standard deviation of a range
  double resolution_m = 0.002;        ///< ranges are multiples of this; 0: not rounded
  double reach_at_10_percent_m = 50;  ///< farthest surface of 10 % reflectivity that is seen
  double dropout_share = 0.002;       ///< of returns that are lost without a cause
  double intensity_share = 0.03;      ///< standard deviation of an intensity, relative
};

/// One of several lidars whose returns stand in one scan.
struct LidarInScan {
  std::size_t first_ring = 0;        ///< of the scan; its own rings end where the next one's begin
  std::array<double, 3> origin_m{};  ///< where it looks from, in the scan's frame
};

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

  /// How far before the axis of a round pole the mean of its returns lies, in radii. Beams that hit
  /// it evenly from side to side: the mean of sqrt(1 - u^2) over [-1, 1], pi / 4.
  double pole_depth = std::numbers::pi / 4;

  /// Of scans that several lidars' were put together to: the lidars, by ring. Empty: there is one,
  /// at the origin. Not in files: who puts scans together knows it.
  std::vector<LidarInScan> lidars_in_scan;

  LidarFiring firing;
  LidarNoise noise;
};

void bind(config::Binder& binder, LidarProfile& profile);

/// \throws files::InputError naming file and line.
LidarProfile load_lidar_profile(const std::filesystem::path& yaml);

}  // namespace traverse::sensors
