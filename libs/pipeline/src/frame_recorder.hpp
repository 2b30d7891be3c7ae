#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "traverse/dataset/point_cloud_file.hpp"
#include "traverse/evaluation/worst_segments.hpp"
#include "traverse/files/scratch_file.hpp"
#include "traverse/geometry/trajectory.hpp"
#include "traverse/pipeline/estimator.hpp"

namespace traverse::pipeline {

/// Keeps how frames were registered, for pictures of the worst segments, which are known only at
/// the end; of poses that another program made the scans alone: of every five frames the one with
/// the largest residuals, its scan and its matches thinned, in a file without a name. Memory holds
/// one frame; disk about 30 kB for each of the run.
class FrameRecorder {
 public:
  /// \param folder on whose disk there is room
  FrameRecorder(const std::filesystem::path& folder, const Estimator& estimator);

  /// Whether this frame is the worst so far of its five: then add() takes it.
  bool wants(std::size_t pose, const PoseFrame& frame) const;

  /// Takes the frame of pose `pose`, which is wanted and which the estimator gave last of all.
  void add(std::size_t pose, const PoseFrame& frame, const UsedScan& used);

  /// The points of one frame of each segment, the one with the largest residuals of those kept:
  /// worst_frames.ply of docs/run-folder.md. Empty if no frame was kept.
  /// \param T_map_body the final poses of the frames
  /// \param first_frame number of the frame of pose 0
  dataset::PointCloud worst_frames(const evaluation::WorstSegments& worst,
                                   const geometry::Trajectory& T_map_body, std::size_t first_frame);

 private:
  /// Where a frame stands in the scratch file: x y z of the scan's points, then rows of matches, in
  /// the body's frame.
  struct Entry {
    std::size_t pose = 0;
    double residual_rms_m = 0;
    std::size_t scan_points = 0;
    std::size_t matches = 0;
    std::uint64_t offset = 0;
  };

  void keep_pending();
  const Entry* worst_in(const evaluation::WorstSegment& segment) const;
  std::vector<float> values_of(const Entry& entry) const;

  const Estimator& estimator_;
  std::optional<std::size_t> residual_column_;  ///< nothing: this estimator has no registration
  bool is_foreign_;                             ///< its scans are kept all the same
  files::ScratchFile scratch_;
  std::vector<Entry> entries_;
  std::optional<Entry> pending_;  ///< the worst so far of the present five frames
  std::vector<float> pending_values_;
};

}  // namespace traverse::pipeline
