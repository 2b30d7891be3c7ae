#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <tsl/robin_map.h>

#include <Eigen/Core>

#include "traverse/geometry/voxel.hpp"
#include "traverse/mapping/map_keyframe.hpp"

namespace traverse::mapping {

/// How high the ground is, from the lowest points of columns of a metre.
class GroundHeights {
 public:
  explicit GroundHeights(std::span<const MapKeyframe> keyframes);

  /// Of the lowest column in the neighbourhood of p, map frame; nothing where no point is near.
  std::optional<double> at(const Eigen::Vector3d& p_map) const;

 private:
  static constexpr double kColumn_m = 1;

  /// The three lowest points, lowest first: one or two may be reflections from below the ground.
  struct Lowest {
    float z[3];
    int count = 0;
    void add(float value);
    float height() const { return z[count - 1]; }
  };
  static std::uint64_t key_of(double x, double y) {
    return geometry::voxel_key({x, y, 0}, kColumn_m);
  }

  tsl::robin_map<std::uint64_t, Lowest, geometry::VoxelHash> columns_;
};

}  // namespace traverse::mapping
