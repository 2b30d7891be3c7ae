#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "traverse/geometry/pose3.hpp"
#include "traverse/mapping/map_keyframe.hpp"
#include "traverse/mapping/merge_runs.hpp"
#include "traverse/slam/keyframe.hpp"
#include "traverse/slam/loop_registration.hpp"
#include "traverse/slam/scan_context.hpp"

namespace traverse::mapping {

/// A run as slam sees it. Frames of keyframes are upright ones at the sensor: axes of the body.
class RunPlaces {
 public:
  explicit RunPlaces(const std::vector<MapKeyframe>& keyframes);

  std::size_t size() const { return T_map_sensor_.size(); }
  /// In the run's own map frame.
  const geometry::Pose3& T_map_sensor(std::size_t k) const { return T_map_sensor_[k]; }
  const slam::ScanContext& context(std::size_t k) const { return contexts_[k]; }
  /// As if the sensor stood so far to the left (Kim, Choi and Kim, "Scan Context++", T-RO 2022).
  slam::ScanContext context_beside(std::size_t k, double left_m) const;
  const voxel_map::SweepSample& features(std::size_t k) const { return keyframes_[k]->features; }

  /// The surfaces that keyframe k and those around it saw, in its frame.
  slam::Submap submap(std::size_t k, int keyframes_around) const;

 private:
  std::vector<geometry::Pose3> T_map_sensor_;
  std::vector<slam::ScanContext> contexts_;
  std::vector<std::shared_ptr<const slam::Keyframe>> keyframes_;
};

/// A keyframe of one run in the frame of a keyframe of another one.
struct Placement {
  geometry::Pose3 T_other_keyframe;
  double overlap = 0;
  double residual_rms_m = 0;
};

/// Registers a keyframe on the surroundings of a keyframe of another run.
/// \returns nothing unless it overlaps, fits and is determined in all directions
std::optional<Placement> place(const RunPlaces& run, std::size_t keyframe, const slam::Submap& on,
                               const geometry::Pose3& guess_other_keyframe,
                               const slam::SearchRegion& region, const MergeOptions& options);

}  // namespace traverse::mapping
