#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "traverse/evaluation/consistency.hpp"

namespace traverse::evaluation {

/// Finds out which point is the first in its voxel. Leaves `occupied` as it found it: all false.
class FirstOfVoxel {
 public:
  explicit FirstOfVoxel(std::vector<bool>& occupied) : occupied_(occupied) {
    occupied_.resize(static_cast<std::size_t>(kVoxelsAcross * kVoxelsAcross * kVoxelsAcross));
  }
  ~FirstOfVoxel() {
    for (const std::size_t voxel : touched_) occupied_[voxel] = false;
  }
  FirstOfVoxel(const FirstOfVoxel&) = delete;
  FirstOfVoxel& operator=(const FirstOfVoxel&) = delete;

  /// Of a point within the range of the score.
  bool operator()(const Eigen::Vector3d& p_lidar) {
    const auto axis = [](double coordinate) {
      return static_cast<std::int64_t>(std::floor(coordinate / consistency::kVoxel_m)) +
             kVoxelsAside;
    };
    const auto voxel = static_cast<std::size_t>(
        (axis(p_lidar.x()) * kVoxelsAcross + axis(p_lidar.y())) * kVoxelsAcross +
        axis(p_lidar.z()));
    if (occupied_[voxel]) return false;
    occupied_[voxel] = true;
    touched_.push_back(voxel);
    return true;
  }

 private:
  static constexpr std::int64_t kVoxelsAside =
      static_cast<std::int64_t>(consistency::kMostRange_m / consistency::kVoxel_m) + 1;
  static constexpr std::int64_t kVoxelsAcross = 2 * kVoxelsAside + 1;

  std::vector<bool>& occupied_;
  std::vector<std::size_t> touched_;
};

}  // namespace traverse::evaluation
