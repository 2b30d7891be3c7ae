#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

#include "traverse/config/binder.hpp"
#include "traverse/slam/keyframe_file.hpp"
#include "traverse/slam/map_places.hpp"
#include "traverse/slam/slam.hpp"

namespace traverse::slam {

struct LocalizerOptions {
  int ring_keys = 200;         ///< nearest ring keys whose contexts the global search compares
  int places = 12;             ///< of those most alike that a scan is registered at: rivals, too
  double search_radius_m = 4;  ///< around each, and around a given start
  double search_half_turn_deg = 15;  ///< around a given start
  double slip_m = 1;                 ///< around odometry's pose, when a scan does not fit there
  PlaceChecks checks;
  double max_rival = 0.8;    ///< support of the next best place, as a share of the best one's
  double agreement_m = 0.3;  ///< two scans tell the same place up to this
  double agreement_deg = 1;
  int witnesses_within = 10;  ///< scans before that may confirm a place
  int lost_after = 5;         ///< scans in a row that do not fit the map: the place is lost
};
void bind(config::Binder& binder, LocalizerOptions& options);

/// Follows a lidar in a map that was made before. Odometry tells the motion from scan to scan; each
/// scan is registered in the submap of the map's keyframes around it.
///
/// Without a start, and when the place is lost, a scan is registered wherever the map looks like it
/// (Scan Context). Places resemble each other, so the best one counts only if it stands out from
/// the next best (the ratio test of Lowe, "Distinctive image features from scale-invariant
/// keypoints", IJCV 2004, section 7.1, here on matches), and only when other scans confirm it:
/// scans that are wrong have no reason to agree on where odometry began. Scans of which nothing
/// stands out do not vote for one place but for all those that it could be. A value: copies are
/// independent and share the map.
class Localizer {
 public:
  /// \param options registration, submaps and checks are those of loops
  Localizer(std::vector<MapKeyframe> map, const SlamOptions& options,
            const LocalizerOptions& search);

  /// Where the lidar is at the first scan, up to the search region.
  void start_at(const geometry::Pose3& T_map_lidar) { start_ = T_map_lidar; }

  /// Whether the next scan will be searched for; only then its map points are looked at.
  bool is_searching() const { return !T_map_odom_; }

  struct Fix {
    bool located = false;  ///< the place is known; false while it is searched for
    /// Whether this scan fitted the map there, or why not: where the place is known all the same,
    /// odometry carried the pose on. Of a search, how the best place failed.
    PlaceVerdict verdict = PlaceVerdict::kNotRegistered;
    geometry::Pose3 T_map_odom;
    std::size_t keyframe = 0;  ///< of the map, around which the scan was registered
    double in_common = 0;      ///< MapPlaces::Fit::in_common
    double residual_rms_m = 0;

    bool fits() const { return verdict == PlaceVerdict::kFits; }
  };
  /// \param scan its features, deskewed, its pose by odometry, and its points while searching
  Fix locate(const Keyframe& scan);

 private:
  using Places = std::vector<geometry::Pose3>;  ///< T_map_odom, the best first

  Fix follow(const Keyframe& scan);
  Fix find(const Keyframe& scan);
  std::vector<MapPlaces::Fit> search(const Keyframe& scan);
  Places contenders(const MapPlaces::Fit& best, const std::vector<MapPlaces::Fit>& fits,
                    const Keyframe& scan) const;
  bool is_confirmed(const geometry::Pose3& T_odom_lidar) const;

  double reach_m_;
  double sector_rad_;
  LocalizerOptions search_;
  MapPlaces map_;
  std::optional<geometry::Pose3> start_;
  std::optional<geometry::Pose3> T_map_odom_;  ///< nothing: the place is not known
  std::deque<Places> told_;                    ///< by the latest scans that fit somewhere
  int misses_ = 0;
};

}  // namespace traverse::slam
