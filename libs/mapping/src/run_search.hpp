#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "traverse/geometry/pose3.hpp"
#include "traverse/mapping/merge_runs.hpp"
#include "traverse/slam/place_index.hpp"

#include "run_places.hpp"

namespace traverse::mapping {

/// A keyframe whose place in the map is known.
struct KnownKeyframe {
  std::size_t run = 0;
  std::size_t keyframe = 0;
  const RunPlaces* places = nullptr;  ///< of the run
  geometry::Pose3 T_map_sensor;
};

/// Finds where a run lies in a map, by what its keyframes look like.
class RunSearch {
 public:
  RunSearch(std::vector<KnownKeyframe> known, const MergeOptions& options);

  /// T_map_run, where most keyframes say it is; nothing if too few do, or if another place would
  /// explain half as many. \param progress told the share of the keyframes that were tried
  std::optional<geometry::Pose3> place_of(const RunPlaces& run,
                                          const std::function<void(double)>& progress) const;

 private:
  struct Lookalike {
    double distance = 1;     ///< of the contexts
    std::size_t number = 0;  ///< of the known keyframe
    geometry::Pose3 T_known_keyframe;
  };
  std::vector<Lookalike> lookalikes(const RunPlaces& run, std::size_t keyframe) const;

  /// A keyframe's place, and what it says of its run's.
  struct Hypothesis {
    std::size_t keyframe;
    geometry::Pose3 T_map_keyframe;
    geometry::Pose3 T_map_run;
  };
  bool agree(const RunPlaces& run, const Hypothesis& one, const Hypothesis& other) const;
  std::size_t agreeing(const RunPlaces& run, const Hypothesis& one,
                       const std::vector<Hypothesis>& hypotheses) const;
  std::optional<geometry::Pose3> largest_agreement(const RunPlaces& run,
                                                   const std::vector<Hypothesis>& hypotheses) const;

  std::vector<KnownKeyframe> known_;
  const MergeOptions& options_;
  slam::PlaceIndex ring_keys_;
};

}  // namespace traverse::mapping
