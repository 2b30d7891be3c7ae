#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "traverse/pipeline/estimator.hpp"
#include "traverse/replay/recording.hpp"
#include "traverse/replay/session.hpp"

namespace traverse::replay {

/// The points of a frame's scan with everything they can be coloured by.
struct ShownScan {
  std::vector<Eigen::Vector3f> points_body;  ///< metres, body frame at the frame's stamp
  std::vector<float> intensity;              ///< 0 .. 1; empty, or one a point, as the next ones
  std::vector<std::uint8_t> feature_class;   ///< lidar::FeatureClass
  std::vector<float> ring;
  std::vector<float> time_s;  ///< after the scan's stamp
};

/// All there is to see of one frame. Never changed once made: threads share it.
struct Shown {
  std::size_t frame = 0;
  double seconds = 0;  ///< from the recording's first frame
  pipeline::PoseFrame pose;
  ShownScan scan;
  std::vector<pipeline::MatchedPoint> matches;
  std::vector<Eigen::Vector3d> local_map;
};

/// The scan of a frame as its estimator used it; empty for a frame without one.
ShownScan scan_to_show(const SessionFrame& frame, const pipeline::Estimator& estimator,
                       const sensors::Rig& rig);

/// The points of a scan alone, for the map.
struct MapPoints {
  std::vector<Eigen::Vector3f> points_map;
  std::vector<float> intensity;
};
MapPoints points_in_map(const SessionFrame& frame, const pipeline::Estimator& estimator,
                        const sensors::Rig& rig);

}  // namespace traverse::replay
