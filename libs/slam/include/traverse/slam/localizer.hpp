#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "traverse/config/binder.hpp"
#include "traverse/slam/keyframe_file.hpp"
#include "traverse/slam/place_index.hpp"
#include "traverse/slam/slam.hpp"

namespace traverse::slam {

struct LocalizerOptions {
  int places = 4;              ///< of the map that a scan of the global search is tried at
  double search_radius_m = 4;  ///< around each, and around a given start
  double search_half_turn_deg = 15;
  int lost_after = 5;  ///< scans in a row that do not fit the map: the place is lost
};
void bind(config::Binder& binder, LocalizerOptions& options);

/// Follows a lidar in a map that was made before. Odometry tells the motion from scan to scan; each
/// scan is registered in the submap of the map's keyframes around it. Without a start, and when the
/// place is lost, it is searched for among all keyframes by their Scan Contexts; a place counts as
/// found when two scans in a row agree on it. A value: copies are independent and share the map.
class Localizer {
 public:
  /// \param options registration, submaps and checks are those of loops
  Localizer(std::vector<MapKeyframe> map, const SlamOptions& options,
            const LocalizerOptions& search);

  /// Where the lidar is at the first scan, up to the search region.
  void start_at(const geometry::Pose3& T_map_lidar) { start_ = T_map_lidar; }

  struct Fix {
    bool located = false;  ///< the place is known; false while it is searched for
    bool fits = false;     ///< this scan fitted the map there; else odometry carried the pose on
    geometry::Pose3 T_map_odom;
    std::size_t keyframe = 0;  ///< of the map, around which the scan was registered
    double overlap = 0;
    double residual_rms_m = 0;
  };
  /// \param scan its points and features, deskewed, and its pose by odometry
  Fix locate(const Keyframe& scan);

 private:
  /// A registration that passed the checks.
  struct Place {
    geometry::Pose3 T_map_odom;
    std::size_t keyframe = 0;
    LoopRegistration found;
  };
  std::optional<Place> fit(std::size_t keyframe, const geometry::Pose3& guess_T_map_lidar,
                           const SearchRegion& region, const Keyframe& scan);
  std::vector<Place> search(const Keyframe& scan);
  Fix follow(const Keyframe& scan);
  bool agree(const Place& a, const Place& b, const geometry::Pose3& T_odom_lidar) const;
  std::shared_ptr<const Submap> submap_around(std::size_t keyframe);

  SlamOptions options_;
  LocalizerOptions search_;
  std::shared_ptr<const std::vector<MapKeyframe>> map_;
  std::vector<ScanContext> contexts_;
  PlaceIndex ring_keys_;
  PlaceIndex positions_;
  std::deque<std::shared_ptr<const Submap>> submaps_;
  std::optional<geometry::Pose3> start_;
  std::optional<geometry::Pose3> T_map_odom_;  ///< nothing: the place is not known
  std::vector<Place> last_search_;             ///< that wait for a scan that agrees
  int misses_ = 0;
};

}  // namespace traverse::slam
