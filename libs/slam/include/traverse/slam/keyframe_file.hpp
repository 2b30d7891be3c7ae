#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <vector>

#include "traverse/geometry/pose3.hpp"
#include "traverse/geometry/stamp.hpp"
#include "traverse/slam/keyframe_store.hpp"

namespace traverse::slam {

/// Writes keyframes as an MRPT simple map, which MRPT's programs open. The pose of each is
/// T_map_lidar; its sensory frame holds four point clouds in the lidar's frame: "map points" with
/// intensity, "surface points" (what a map of planes is made of), "planar points" and "edge points"
/// (what a scan is registered by); time and ring of the map points as an observation without points
/// of its own, because MRPT's clouds cannot hold them; and a comment with the step covariance and
/// the health of the keyframe as JSON. One keyframe is in memory at a time. \param T_map_lidar of a
/// keyframe by its id \throws files::OutputError
void write_keyframes(const std::filesystem::path& file, const KeyframeStore& keyframes,
                     const std::function<geometry::Pose3(std::size_t)>& T_map_lidar);

/// A keyframe of a map that was written before.
struct MapKeyframe {
  geometry::Stamp stamp;
  geometry::Pose3 T_map_lidar;
  Keyframe content;  ///< points and features; odometry and health are not read back
};

/// Reads what write_keyframes() wrote. \throws files::InputError naming the record
std::vector<MapKeyframe> read_keyframes(const std::filesystem::path& file);

}  // namespace traverse::slam
