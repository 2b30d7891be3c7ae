#include "ground_heights.hpp"

#include <algorithm>

#include <Eigen/Dense>

namespace traverse::mapping {

void GroundHeights::Lowest::add(float value) {
  if (count < 3) {
    z[count++] = value;
  } else if (value < z[2]) {
    z[2] = value;
  }
  std::sort(z, z + count);
}

GroundHeights::GroundHeights(std::span<const MapKeyframe> keyframes) {
  for (const MapKeyframe& keyframe : keyframes) {
    for (std::size_t i = 0; i < keyframe.size(); ++i) {
      const Eigen::Vector3d p = keyframe.T_map_body * keyframe.p_body(i);
      columns_[key_of(p.x(), p.y())].add(static_cast<float>(p.z()));
    }
  }
}

std::optional<double> GroundHeights::at(const Eigen::Vector3d& p_map) const {
  std::optional<double> lowest;
  for (const double dx : {-kColumn_m, 0.0, kColumn_m}) {
    for (const double dy : {-kColumn_m, 0.0, kColumn_m}) {
      const auto column = columns_.find(key_of(p_map.x() + dx, p_map.y() + dy));
      if (column == columns_.end()) continue;
      const double height = column->second.height();
      if (!lowest || height < *lowest) lowest = height;
    }
  }
  return lowest;
}

}  // namespace traverse::mapping
