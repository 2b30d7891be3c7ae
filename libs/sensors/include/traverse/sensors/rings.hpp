#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "traverse/sensors/lidar_profile.hpp"
#include "traverse/sensors/lidar_scan.hpp"

namespace traverse::sensors {

/// The scan cannot be divided into rings with what is known of it.
class NoRings : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A ring number for each point.
struct RingAssignment {
  std::vector<std::uint16_t> ring;
  std::size_t ring_count = 0;  ///< largest ring number present, plus 1
};

/// Ring numbers by the profile's ring_source. Numbers at or beyond the profile's count are kept as
/// they are: info and the health record count them.
/// \throws NoRings if the source asked for is not there (no stored rings, no elevation table).
RingAssignment assign_rings(const LidarScan& scan, const LidarProfile& profile);

/// The ring number of every point; empty where they cannot be known.
std::vector<std::uint16_t> rings_if_known(const LidarScan& scan, const LidarProfile& profile);

}  // namespace traverse::sensors
