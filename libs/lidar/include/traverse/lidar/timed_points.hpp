#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace traverse::lidar {

/// Points of one sweep with the moment each was measured. Structure of arrays.
struct TimedPoints {
  std::vector<float> x, y, z;  ///< metres, lidar frame
  std::vector<float> time;     ///< seconds after the scan's stamp

  std::size_t size() const { return x.size(); }
  void clear();
  void reserve(std::size_t points);
  void push_back(float px, float py, float pz, float seconds);
  Eigen::Vector3d point(std::size_t i) const { return {x[i], y[i], z[i]}; }
};

}  // namespace traverse::lidar
