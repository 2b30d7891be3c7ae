#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace traverse::dataset {

/// What one lidar returned, in the frame of the first of those that are used as one.
struct LidarReturns {
  std::vector<float> x, y, z;  ///< [m]
  std::vector<float> intensity;
  std::vector<std::uint16_t> ring;
  std::vector<std::int64_t> ns;  ///< when, since the epoch

  std::size_t size() const { return x.size(); }
  void move_to(LidarReturns& to, std::size_t i) const {
    to.x.push_back(x[i]);
    to.y.push_back(y[i]);
    to.z.push_back(z[i]);
    to.intensity.push_back(intensity[i]);
    to.ring.push_back(ring[i]);
    to.ns.push_back(ns[i]);
  }
};

}  // namespace traverse::dataset
