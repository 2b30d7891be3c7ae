#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "traverse/geometry/pose3.hpp"
#include "traverse/geometry/stamp.hpp"
#include "traverse/sensors/lidar_scan.hpp"
#include "traverse/sensors/rig.hpp"

#include "comparison/distortion_fit.hpp"

namespace traverse::plausibility {

/// How the times of a scan's points are told.
enum class TimeModel {
  kKnown,             ///< as the recording and the lidar's profile tell
  kClockwise,         ///< by the azimuth, where nothing tells: one turn from one scan to the next,
  kCounterclockwise,  ///< from the azimuth of the first point on
};

/// The distortion of pairs of scans a few metres apart, of the first that moved fast enough to
/// tell. Of a scan a few thousand points are looked at; pairs are few, so that all of it costs what
/// two or three scans take to be estimated.
class DistortionTrack {
 public:
  void take(const std::shared_ptr<const sensors::LidarScan>& scan);
  void take_pose(geometry::Stamp stamp, const geometry::Pose3& T_map_body, const sensors::Rig& rig);

  struct Pair {
    TimeModel model = TimeModel::kKnown;
    Distortion distortion;
  };
  const std::vector<Pair>& pairs() const { return pairs_; }
  double seam_deg() const {
    return seam_deg_;
  }  ///< of a scan's first point, where times are unknown
  double sweep_s() const { return interval_s_; }

 private:
  struct PosedScan {
    geometry::Stamp stamp;
    std::shared_ptr<const sensors::LidarScan> scan;
    geometry::Pose3 T_map_lidar;
    geometry::Twist velocity = geometry::Twist::Zero();
  };
  void pair_up(const PosedScan& now, const sensors::LidarProfile& profile);
  void compare(const PosedScan& a, const PosedScan& b, const sensors::LidarProfile& profile);
  TimedScan timed(const PosedScan& scan, const sensors::LidarProfile& profile, TimeModel model,
                  std::size_t points) const;
  bool is_fast(const PosedScan& scan) const;

  std::deque<std::shared_ptr<const sensors::LidarScan>> waiting_;  ///< for their poses
  std::optional<PosedScan> last_;
  std::deque<PosedScan> stops_;  ///< to be compared with
  std::vector<Pair> pairs_;
  std::size_t compared_ = 0;
  double interval_s_ = 0;
  double seam_deg_ = 0;
};

}  // namespace traverse::plausibility
