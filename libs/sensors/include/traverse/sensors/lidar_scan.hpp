#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "traverse/geometry/stamp.hpp"

namespace traverse::sensors {

/// One sweep of a 3-D lidar, as the recording holds it: nothing removed, nothing corrected. Points
/// are a structure of arrays in storage order, in the sensor's frame (x forward, y left, z up).
struct LidarScan {
  geometry::Stamp stamp;  ///< the moment that the scan's pose belongs to
  std::string sensor;     ///< label of the sensor in the Rig

  std::vector<float> x, y, z;       ///< metres; a missing return may be NaN or (0, 0, 0)
  std::vector<float> intensity;     ///< as stored; empty, or one a point
  std::vector<std::uint16_t> ring;  ///< 0 is what the recording calls 0; empty, or one a point
  std::vector<float> time;  ///< seconds after `stamp` (before: negative); empty, or one a point

  std::size_t size() const { return x.size(); }
  bool empty() const { return x.empty(); }
  void reserve(std::size_t points);
};

/// Why points of a scan cannot be used, counted.
struct PointFaults {
  std::size_t not_finite = 0;  ///< a coordinate is NaN or infinite
  std::size_t at_origin = 0;   ///< all coordinates zero: no return

  std::size_t total() const { return not_finite + at_origin; }
};

PointFaults count_faults(const LidarScan& scan);

/// \throws std::invalid_argument if the arrays do not agree in size.
void check_consistent(const LidarScan& scan);

}  // namespace traverse::sensors
