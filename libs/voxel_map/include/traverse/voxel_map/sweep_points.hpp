#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace traverse::voxel_map {

/// Points that the odometry keeps of one sweep. Structure of arrays.
struct SweepPoints {
  std::vector<float> x, y, z;         ///< metres, lidar frame, elevation corrected, not deskewed
  std::vector<float> range;           ///< metres
  std::vector<float> time;            ///< seconds after the scan's stamp
  std::vector<std::uint32_t> source;  ///< index of the point in the LidarScan
  /// Of edge points: square metres, because an edge lies anywhere between two beams; else empty.
  std::vector<float> step_variance;

  std::size_t size() const { return x.size(); }
  void resize(std::size_t points);
  void reserve(std::size_t points);
  void push_back(float px, float py, float pz, float point_range, std::uint32_t point_source);
  void append(const SweepPoints& other);
  void append(const SweepPoints& other, std::size_t index);
};

}  // namespace traverse::voxel_map
