#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "traverse/config/binder.hpp"
#include "traverse/mapping/map_keyframe.hpp"

namespace traverse::mapping {

struct MergeOptions {
  int samples = 40;     ///< keyframes of a run whose place is looked for among all others
  int candidates = 3;   ///< that look most alike, for each of them
  double search_m = 3;  ///< around a candidate, from where a registration starts
  double search_deg = 6;
  double min_overlap = 0.6;     ///< share of a keyframe's flat points on the other run's surfaces
  double max_residual_m = 0.1;  ///< rms of the matches
  int min_agreeing = 3;         ///< registrations that place a run alike
  double agreement_m = 1;       ///< up to this; runs drift
  double agreement_deg = 3;
  double reach_m = 8;        ///< keyframes of two runs so near are registered
  double correction_m = 2;   ///< farther from where the run was placed they are not believed
  int keyframes_around = 6;  ///< before and after one that make the surfaces it is registered on
};
void bind(config::Binder& binder, MergeOptions& options);

/// A run shows no place that another one shows, as far as can be told for sure.
class NoOverlap : public std::runtime_error {
 public:
  explicit NoOverlap(std::size_t run);
  std::size_t run() const { return run_; }  ///< its number, from 0

 private:
  std::size_t run_;
};

/// Two keyframes of different runs that saw the same place.
struct RunLink {
  std::size_t run = 0, keyframe = 0;              ///< of the run that was placed
  std::size_t other_run = 0, other_keyframe = 0;  ///< of one that stood before
  double overlap = 0;
  double residual_rms_m = 0;
  double weight = 0;  ///< in the solution, as pose_graph::Edge
};

struct MergedRuns {
  std::vector<std::vector<MapKeyframe>> runs;  ///< as they came, with poses in one map frame
  std::vector<RunLink> links;
};

/// Told what is done now, and how much of it, of 1.
using MergeProgress = std::function<void(const std::string& stage, double share)>;

/// Puts runs of one place into the map frame of the first one.
///
///     until all runs are placed, or throw NoOverlap:
///       for samples of an unplaced run: candidates that look alike (Scan Context),
///         registered on the surfaces around them (line and plane registration of slam)
///       the largest set of registrations that place the run alike, if it is large enough
///       every keyframe near one of a placed run is registered on its surroundings: links
///     pose graph: steps and revisits within each run, links between runs, robust
///
/// \throws NoOverlap for the first run that cannot be placed
MergedRuns merge_runs(std::vector<std::vector<MapKeyframe>> runs, const MergeOptions& options,
                      const MergeProgress& progress = {});

}  // namespace traverse::mapping
