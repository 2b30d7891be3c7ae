#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "traverse/evaluation/poses.hpp"
#include "traverse/geometry/pose3.hpp"

namespace traverse::evaluation {

inline constexpr std::array<double, 8> kKittiLengths_m{100, 200, 300, 400, 500, 600, 700, 800};
inline constexpr std::array<double, 12> kKittiSpeeds_mps{2,  4,  6,  8,  10, 12,
                                                         14, 16, 18, 20, 22, 24};
/// The devkit draws a point of its curves only where at least so many segments lie behind it.
inline constexpr std::size_t kKittiFewestSegmentsToDraw = 3;

struct KittiDriftOptions {
  std::size_t step = 10;       ///< a segment starts at every step-th pose
  double frame_seconds = 0.1;  ///< time from pose to pose, for the speed: 10 Hz in KITTI
  /// The devkit measures in the frame of camera 0, and the translation error depends on the frame.
  /// Where this is set, the poses T_map_body become T_map_camera first.
  std::optional<geometry::Pose3> T_body_camera;
  std::string body_frame = "body";      ///< what the frame of the poses is called
  std::string camera_frame = "camera";  ///< what T_body_camera leads to
};

/// One stretch of the path and the drift over it.
struct KittiSegment {
  std::size_t first = 0;  ///< indices of the matches where it starts and ends
  std::size_t last = 0;
  double length_m = 0;             ///< nominal: 100, 200, ... 800
  double translation_percent = 0;  ///< 100 |t_E| / length_m
  double rotation_deg_per_m = 0;   ///< angle of R_E / length_m
  double speed_mps = 0;            ///< length_m over the time of its frames
};

/// The mean over the segments near one length or one speed.
struct KittiBin {
  double centre = 0;  ///< metres or metres per second
  std::size_t segments = 0;
  double translation_percent = 0;
  double rotation_deg_per_m = 0;
};

struct KittiDrift {
  std::string frame;                             ///< the frame that the errors are measured in
  std::optional<geometry::Pose3> T_body_camera;  ///< that led there; nothing for the body frame
  std::size_t step = 10;
  double frame_seconds = 0.1;
  double translation_percent = 0;  ///< mean over all segments
  double rotation_deg_per_m = 0;
  std::vector<KittiSegment> segments;
  std::vector<KittiBin> by_length;  ///< of kKittiLengths_m those with a segment
  std::vector<KittiBin> by_speed;   ///< of kKittiSpeeds_mps those with a segment; bins overlap
};

/// Drift over stretches of 100 to 800 m as the KITTI odometry benchmark measures it, in double
/// precision, of matched poses that are not aligned; nothing where the reference is shorter than
/// the shortest stretch. Source: Geiger et al., CVPR 2012, and evaluate_odometry.cpp of its devkit.
/// \throws std::invalid_argument if the sizes differ or step or frame_seconds is not positive.
std::optional<KittiDrift> kitti_drift(const Poses& estimate, const Poses& reference,
                                      const KittiDriftOptions& options);

}  // namespace traverse::evaluation
