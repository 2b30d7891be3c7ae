#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "traverse/sensors/lidar_profile.hpp"
#include "traverse/sensors/lidar_scan.hpp"

namespace traverse::lidar {

/// Why points of a scan were left out, counted.
struct DroppedPoints {
  std::size_t not_finite = 0;
  std::size_t at_origin = 0;
  std::size_t out_of_range = 0;
  std::size_t beyond_profile_rings = 0;  ///< ring number not below the profile's count

  std::size_t total() const { return not_finite + at_origin + out_of_range + beyond_profile_rings; }
};

/// The usable points of a scan, sorted by scan line and, within a line, in storage order (which is
/// the order of azimuth for every rotating lidar). Structure of arrays, sensor frame, metres; the
/// profile's vertical correction is applied.
struct ScanLines {
  std::vector<float> x, y, z;
  std::vector<float> range;                  ///< |(x, y, z)|
  std::vector<std::uint32_t> source;         ///< index of the point in the LidarScan
  std::vector<std::uint32_t> line_begin{0};  ///< line k is [line_begin[k], line_begin[k + 1])
  DroppedPoints dropped;

  std::size_t size() const { return x.size(); }
  std::size_t line_count() const { return line_begin.size() - 1; }
};

/// \throws sensors::NoRings if the scan cannot be divided into lines.
ScanLines organise(const sensors::LidarScan& scan, const sensors::LidarProfile& profile);

}  // namespace traverse::lidar
