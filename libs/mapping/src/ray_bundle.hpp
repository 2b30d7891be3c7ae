#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "traverse/mapping/map_keyframe.hpp"

namespace traverse::mapping {

/// The rays of a keyframe, found by direction: from the sensor to each of its points. Map frame.
class RayBundle {
 public:
  explicit RayBundle(const MapKeyframe& keyframe);

  const Eigen::Vector3d& origin() const { return origin_; }

  struct Pass {
    double distance_m = 0;  ///< of the ray from the point
    double beyond_m = 0;    ///< that the ray goes on beyond the point; negative: ends before it
    Eigen::Vector3d direction;
  };
  /// The ray that passes nearest to a point, or would if it went on; nothing if none comes within
  /// `radius_m`.
  std::optional<Pass> nearest(const Eigen::Vector3d& p_map, double radius_m) const;

 private:
  struct Ray {
    Eigen::Vector3f direction;
    float length;
  };
  static constexpr int kColumns = 360;  ///< one a degree of azimuth
  static constexpr int kRows = 180;     ///< and of elevation, in the axes of the map

  static int row_of(double elevation_rad);
  static int column_of(double azimuth_rad);

  Eigen::Vector3d origin_;
  std::vector<Ray> rays_;           ///< bin by bin
  std::vector<std::size_t> begin_;  ///< of each bin in rays_, and the end
};

}  // namespace traverse::mapping
