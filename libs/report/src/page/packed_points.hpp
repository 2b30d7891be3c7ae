#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace traverse::report {

/// Points of a map for the page.
struct ScenePoints {
  std::vector<Eigen::Vector3f> positions;  ///< metres, in the map frame
  std::vector<float> intensities;          ///< one a point, or empty
};

/// At most `most` of the points, one a voxel, with voxels no larger than that needs: the shape of
/// the map stays. The first of a voxel stays, in the order of `points`.
/// \param voxel_m edge of the voxels that were used; 0 if every point could stay
ScenePoints thinned(const ScenePoints& points, std::size_t most, double& voxel_m);

/// Points as bytes for a page: each coordinate a whole number of steps from `origin_m`, 16 bits;
/// then the pose it is nearest to, 16 bits; then the intensity between the least and the largest,
/// 8 bits. Field after field: of 16-bit fields the differences from point to point, first all low
/// bytes, then all high bytes; compressed by zlib; base64.
struct PackedPoints {
  std::size_t count = 0;
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();
  double step_m = 0;
  std::array<float, 2> intensity{0, 0};  ///< of the bytes 0 and 255; equal when there is none
  std::string base64;
};

/// \param nearest_pose one a point, below 65536
PackedPoints pack(const ScenePoints& points, const std::vector<std::uint16_t>& nearest_pose);

}  // namespace traverse::report
