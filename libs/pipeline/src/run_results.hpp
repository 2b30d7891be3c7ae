#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "traverse/dataset/point_cloud_file.hpp"
#include "traverse/dataset/source.hpp"
#include "traverse/evaluation/consistency.hpp"
#include "traverse/evaluation/worst_segments.hpp"
#include "traverse/geometry/trajectory.hpp"
#include "traverse/mapping/keyframe_map.hpp"
#include "traverse/mapping/voxel_map.hpp"
#include "traverse/pipeline/frame_table.hpp"
#include "traverse/pipeline/run.hpp"

#include "frame_recorder.hpp"
#include "slam_results.hpp"
#include "waiting_scans.hpp"

namespace traverse::pipeline {

/// Takes frames as they come and keeps what the run folder will hold.
class RunResults {
 public:
  RunResults(const Estimator& estimator, const dataset::RecordingInfo& recording,
             const RunOptions& options, const RunFolder& folder);

  /// \param latest the estimator has given none after it
  void add(const PoseFrame& frame, const ScanPtr& scan, bool latest);

  /// Once the last frame is in: the trajectory and the maps by what loops have taught.
  void correct();

  /// The final poses of the frames.
  const geometry::Trajectory& trajectory() const { return trajectory_; }
  /// Those by odometry alone, if loops were closed over it.
  const std::optional<geometry::Trajectory>& odometry() const { return odometry_; }
  const FrameTable& frames() const { return frames_; }
  const mapping::VoxelMap& map() const { return map_; }
  const mapping::KeyframeMap& keyframes() const { return keyframes_; }
  const UsedScan& sample() const { return sample_; }
  std::size_t sample_frame() const { return sample_frame_; }
  std::optional<evaluation::Consistency> consistency();
  std::optional<evaluation::Consistency> odometry_consistency() const;
  /// How the worst frames were registered, under their final poses.
  dataset::PointCloud worst_frames(const evaluation::WorstSegments& worst);

 private:
  void add_to_maps(const PoseFrame& frame, const sensors::LidarScan& scan, const UsedScan& used);

  void add_row(const PoseFrame& frame);

  /// The scan to show is one from the middle of the run: without knowing how long the run will be,
  /// the latest whose number is a power of two lies in its second half.
  bool is_sample() const;

  const Estimator& estimator_;
  const dataset::RecordingInfo& recording_;  ///< of the source: a rawlog's rig grows in reading
  std::size_t first_frame_;
  std::size_t score_every_;
  geometry::Trajectory trajectory_;
  FrameTable frames_;
  evaluation::ConsistencyScorer scorer_;
  mapping::VoxelMap map_;
  mapping::KeyframeMap keyframes_;
  bool closes_loops_;
  FrameRecorder recorder_;
  std::optional<geometry::Trajectory> odometry_;
  WaitingForScore waiting_;
  std::string sensor_;
  UsedScan sample_;
  std::size_t sample_frame_ = 0;
};

}  // namespace traverse::pipeline
