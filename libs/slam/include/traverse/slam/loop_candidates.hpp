#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "traverse/config/binder.hpp"
#include "traverse/slam/place_index.hpp"
#include "traverse/slam/ring_key_index.hpp"
#include "traverse/slam/scan_context.hpp"

namespace traverse::slam {

struct CandidateOptions {
  double min_way_m = 40;  ///< driven since; nearer keyframes are the present surroundings
  double reach_m = 8;     ///< keyframes farther apart do not make a loop
  double sigmas = 3;      ///< of the predicted position that reach_m grows by
  int ring_keys = 10;     ///< nearest ring keys whose contexts are compared
  double max_descriptor_distance = 0.35;  ///< of two contexts that look like one place
  ScanContextOptions context;
};
void bind(config::Binder& binder, CandidateOptions& options);

/// A keyframe that may show the place of another.
struct Candidate {
  std::size_t keyframe = 0;
  double descriptor_distance = 1;
  double turn_rad = 0;  ///< about z, from the candidate's frame to that of the one asked for
};

/// Which of the earlier keyframes look like, or lie by, a place. The time of both searches grows
/// with the logarithm of the number of keyframes.
class LoopCandidates {
 public:
  explicit LoopCandidates(const CandidateOptions& options);

  /// Adds the next keyframe. Those within min_way_m of it are not found yet.
  void add(ScanContext context, double way_m, const Eigen::Vector3d& p_map);

  /// The keyframes that can be found are those before this one.
  std::size_t findable() const { return positions_.size(); }

  /// The nearest keyframe to a position within `reach_m`.
  std::optional<Candidate> by_position(const Eigen::Vector3d& p_map, double reach_m) const;
  /// Keyframes whose context resembles that of `context`, best first.
  std::vector<Candidate> by_appearance(const ScanContext& context) const;

  const ScanContext& context(std::size_t keyframe) const { return contexts_.at(keyframe); }

  /// After the graph was solved: new positions of all keyframes. Their index is made anew only when
  /// one has moved by more than a metre since it was; a search looks as much farther.
  void move(const std::vector<Eigen::Vector3d>& p_map);

 private:
  void let_find(double way_m);
  void index_positions();

  CandidateOptions options_;
  std::vector<ScanContext> contexts_;
  std::vector<double> way_m_;
  std::vector<Eigen::Vector3d> p_map_;
  RingKeyIndex ring_keys_;
  PlaceIndex positions_;
  std::vector<Eigen::Vector3d> p_indexed_;  ///< as positions_ has them
  double moved_m_ = 0;                      ///< the farthest of them since
};

}  // namespace traverse::slam
