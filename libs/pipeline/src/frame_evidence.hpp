#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "traverse/geometry/trajectory.hpp"
#include "traverse/pipeline/frame_table.hpp"
#include "traverse/pipeline/sensor_use.hpp"

namespace traverse::pipeline {

/// What the health record of the frames says of the run, whichever estimator wrote it. Each list
/// has one entry a frame.
struct FrameEvidence {
  std::vector<std::size_t> numbers;
  bool is_navigation = false;   ///< GNSS, IMU and wheels: no scans
  bool knows_place = false;     ///< the place is measured, not only the motion: by fixes, in a map
  std::size_t registrable = 0;  ///< as RunHealth has them
  std::size_t registered = 0;
  std::optional<std::size_t> located;
  std::size_t restarts = 0;
  std::size_t frozen = 0;           ///< registered, and yet the pose before to the last bit
  std::vector<bool> is_lost;        ///< registrable, but not registered
  std::vector<bool> is_degenerate;  ///< registered, but not in every direction
  std::vector<bool> is_corrected;   ///< the place is known again after a time without
  std::vector<SensorUse> sensors;   ///< that the columns tell of, without labels of their own
};

/// \param T_map_body one pose a frame
FrameEvidence read_frame_evidence(const FrameTable& frames, const geometry::Trajectory& T_map_body);

}  // namespace traverse::pipeline
