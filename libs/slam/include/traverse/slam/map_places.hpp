#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <string_view>
#include <vector>

#include "traverse/slam/keyframe_file.hpp"
#include "traverse/slam/loop_candidates.hpp"
#include "traverse/slam/place_index.hpp"
#include "traverse/slam/slam.hpp"

namespace traverse::slam {

/// What became of a scan at a place of a map, in the order of the checks.
enum class PlaceVerdict : std::uint8_t {
  kFits,
  kNotRegistered,   ///< too few matches, or the solver failed
  kDegenerate,      ///< the scan does not determine all six directions there
  kLittleInCommon,  ///< fewer matches than the map's own keyframe has there would let expect
  kResidual,        ///< the matches lie off the map's planes and lines
  kNotDistinct,     ///< another place fits about as well
  kAlone,           ///< waits for another scan that agrees
};
std::string_view name_of(PlaceVerdict verdict);

struct PlaceChecks {
  double min_in_common = 0.6;   ///< MapPlaces::Fit::in_common
  double max_residual_m = 0.1;  ///< rms of the matches
};

/// The keyframes of a map that was made before, as places where a scan can be. A value: copies are
/// independent and share the keyframes and their indices.
class MapPlaces {
 public:
  /// \param options registration and submaps are those of loops
  /// \throws std::invalid_argument for a map without keyframes
  MapPlaces(std::vector<MapKeyframe> map, const SlamOptions& options, const PlaceChecks& checks);

  /// The keyframe nearest to a position, and how far it is.
  PlaceIndex::Found nearest(const Eigen::Vector3d& p_map) const;

  /// Where a scan may be that looks like keyframes of the map: their poses, turned as Scan Contexts
  /// say, most alike first. Of those that one search region covers, only the first.
  /// \param ring_keys nearest ring keys whose contexts are compared
  std::vector<geometry::Pose3> alike(const KeyframePoints& scan, std::size_t ring_keys,
                                     std::size_t most, const SearchRegion& region) const;

  /// How a scan fits the map somewhere.
  struct Fit {
    PlaceVerdict verdict = PlaceVerdict::kNotRegistered;
    geometry::Pose3 T_map_lidar;
    std::size_t keyframe = 0;  ///< in whose surroundings it was registered
    LoopRegistration found;
    /// Support for the place a point of the scan, as a share of that which the map's keyframe has
    /// in its own surroundings. Where little is flat, the scan can match little; and the ground,
    /// which matches nearly everywhere, is not in it.
    double in_common = 0;

    bool fits() const { return verdict == PlaceVerdict::kFits; }
  };
  /// Registers a scan in the surroundings of the keyframe nearest to a guess, and checks what was
  /// found.
  Fit fit(const geometry::Pose3& guess_T_map_lidar, const SearchRegion& region,
          const voxel_map::SweepSample& features);

 private:
  /// What copies share.
  struct Content {
    std::vector<MapKeyframe> keyframes;
    std::vector<ScanContext> contexts;
    PlaceIndex ring_keys;
    PlaceIndex positions{3};
  };
  struct Surroundings {
    Submap submap;
    double own_support = 0;  ///< of its centre, a point
  };
  std::shared_ptr<const Surroundings> surroundings(std::size_t keyframe);

  SlamOptions options_;
  PlaceChecks checks_;
  std::shared_ptr<const Content> map_;
  std::deque<std::shared_ptr<const Surroundings>> surroundings_;  ///< used last at the end
};

}  // namespace traverse::slam
