#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "traverse/geometry/pose3.hpp"
#include "traverse/geometry/stamp.hpp"

namespace traverse::mapping {

/// A scan of a map with its pose, as a simple map keeps it. Structure of arrays.
struct MapKeyframe {
  geometry::Stamp stamp;
  std::string sensor;
  std::uint16_t run = 0;  ///< which of several runs it is of, from 0
  geometry::Pose3 T_map_body;
  Eigen::Vector3d p_body_sensor = Eigen::Vector3d::Zero();  ///< where its rays start, body frame
  std::vector<float> x, y, z;                               ///< metres, body frame
  std::vector<float> intensity;                             ///< 0 .. 1; empty, or one a point
  std::vector<float> time;          ///< seconds after the stamp; empty, or one a point
  std::vector<std::uint16_t> ring;  ///< as the recording counts them; empty, or one a point

  std::size_t size() const { return x.size(); }
  Eigen::Vector3d p_body(std::size_t i) const { return {x[i], y[i], z[i]}; }
  /// Keeps the points for which `keep` is true, in their order. \param keep one a point
  void keep_only(const std::vector<char>& keep);
};

/// The keyframes of an MRPT simple map (mrpt::maps::CSimpleMap), written by Traverse or by another
/// of MRPT's programs: whatever MRPT makes points of is read, each keyframe's pose is the mean of
/// its density. \throws files::InputError if the file is no simple map or holds no point
std::vector<MapKeyframe> read_simple_map(const std::filesystem::path& file);

}  // namespace traverse::mapping
