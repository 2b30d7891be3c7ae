#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "traverse/evaluation/consistency.hpp"
#include "traverse/files/scratch_file.hpp"
#include "traverse/geometry/trajectory.hpp"
#include "traverse/mapping/keyframe_map.hpp"
#include "traverse/mapping/voxel_map.hpp"
#include "traverse/pipeline/estimator.hpp"

namespace traverse::pipeline {

/// Scans that the consistency score will take once their final poses are known. Of each only those
/// points are kept that the score may use, on disk.
class WaitingForScore {
 public:
  /// \param scratch a folder with room for them; nothing is left there
  explicit WaitingForScore(const std::filesystem::path& scratch) : room_(scratch) {}

  /// \param frame number of the scan's pose in the trajectory
  void add(std::size_t frame, const UsedScan& scan);

  /// The score under these poses.
  std::optional<evaluation::Consistency> score(const geometry::Trajectory& T_map_body,
                                               const std::string& points_are) const;

 private:
  struct Scan {
    std::size_t frame = 0;
    std::size_t points = 0;
    std::uint64_t offset = 0;  ///< in the room on disk: all x, all y, all z
  };
  files::ScratchFile room_;
  std::vector<Scan> scans_;
};

/// Fills the maps of a run from its keyframes at their optimised poses.
void rebuild_maps(const SlamMap& slam_map, const std::string& sensor, mapping::VoxelMap& points,
                  mapping::KeyframeMap& keyframes);

}  // namespace traverse::pipeline
