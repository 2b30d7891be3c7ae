#pragma once

#include <array>
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

/// The distortion of pairs of scans a few metres apart, of the first that moved fast enough to
/// tell. Of a scan a few thousand points are looked at; pairs are few, so that all of it costs what
/// two or three scans take to be estimated.
class DistortionTrack {
 public:
  void take(const std::shared_ptr<const sensors::LidarScan>& scan);
  void take_pose(geometry::Stamp stamp, const geometry::Pose3& T_map_body, const sensors::Rig& rig);

  /// Where nothing tells the times of points: by the azimuth, for a lidar that turns clockwise once
  /// from one scan to the next, from a seam on that is one of four. One that turns the other way
  /// has the same with the other sign.
  struct Pair {
    std::optional<double> seam_deg;  ///< nothing: times are as the recording tells
    Distortion distortion;
  };
  const std::vector<Pair>& pairs() const { return pairs_; }
  double sweep_s() const { return interval_s_; }

  static constexpr std::array<double, 4> kSeams_deg{180, 0, 90, -90};

 private:
  struct PosedScan {
    geometry::Stamp stamp;
    std::shared_ptr<const sensors::LidarScan> scan;
    geometry::Pose3 T_map_lidar;
    geometry::Twist velocity = geometry::Twist::Zero();
  };
  void pair_up(const PosedScan& now, const sensors::LidarProfile& profile);
  void compare(const PosedScan& a, const PosedScan& b, const sensors::LidarProfile& profile);
  TimedScan timed(const PosedScan& scan, const sensors::LidarProfile& profile,
                  std::optional<double> seam_deg, std::size_t points) const;
  bool is_fast(const PosedScan& scan) const;

  std::deque<std::shared_ptr<const sensors::LidarScan>> waiting_;  ///< for their poses
  std::optional<PosedScan> last_;  ///< whose velocity the next one tells
  std::optional<geometry::Pose3> last_but_one_;
  std::deque<PosedScan> stops_;  ///< to be compared with
  std::vector<Pair> pairs_;
  std::size_t compared_ = 0;
  double interval_s_ = 0;
};

}  // namespace traverse::plausibility
