#pragma once

#include <cstddef>
#include <deque>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "traverse/config/binder.hpp"
#include "traverse/optimization/factor_kind.hpp"
#include "traverse/pose_graph/pose_graph.hpp"
#include "traverse/slam/keyframe.hpp"
#include "traverse/slam/keyframe_maker.hpp"
#include "traverse/slam/keyframe_store.hpp"
#include "traverse/slam/loop.hpp"
#include "traverse/slam/loop_candidates.hpp"
#include "traverse/slam/loop_registration.hpp"
#include "traverse/slam/odometry_chain.hpp"
#include "traverse/slam/submap.hpp"

namespace traverse::slam {

/// What a verified loop must satisfy.
struct LoopChecks {
  double min_overlap = 0.5;         ///< share of the keyframe's points on the submap's surfaces,
                                    ///< to the share that the submap's centre reaches
  double max_residual_m = 0.1;      ///< rms of the matches
  double max_chi2 = 22.5;           ///< of the difference to odometry; 99.9 % of 6 d.o.f.
  double odometry_share = 0.003;    ///< of the way, odometry's systematic part of that difference
  double confirmed_within_m = 0.5;  ///< a prediction this certain confirms a loop by itself;
  int witnesses_within = 8;         ///< else one among so many keyframes before must agree,
  double agreement_m = 0.3;         ///< the two and odometry closing a circle up to this
  double agreement_deg = 1;
  double inflation = 100;     ///< of the covariance from the solver's information, and
  double min_sigma_m = 0.02;  ///< the least that is believed of a loop
  double min_sigma_deg = 0.05;
};
void bind(config::Binder& binder, LoopChecks& options);

struct SlamOptions {
  KeyframeOptions keyframes;
  double memory_mb = 1000;  ///< of keyframes; more are spilled to disk
  CandidateOptions candidates;
  SubmapOptions submap;
  int submap_every = 2;  ///< submaps are centred at every so manieth keyframe
  LoopRegistrationOptions registration;
  LoopChecks loops;
  double solve_at_chi2 = 12;  ///< the graph is solved when an accepted loop is off by this, and
  int solve_every = 1;        ///< after so many loops for each thousand keyframes, at least one
  pose_graph::GraphOptions graph;
};
void bind(config::Binder& binder, SlamOptions& options);

/// Closes loops over any lidar odometry, which goes on undisturbed.
///
///     for each frame that is far enough from the last keyframe:
///       make a keyframe, add it to the graph with odometry's motion and covariance
///       candidates: the nearest earlier keyframe within the uncertainty of the position,
///                   and the one that looks most alike (Scan Context)
///       register the keyframe in the submap around each candidate, from several starts
///       accept a loop that overlaps, fits, is determined and agrees with odometry and its witness
///       solve the graph when accepted loops contradict its poses
///
/// Everything is in the lidar's frames; the map frame is that of the first keyframe, or ENU once
/// GNSS fixes orient the graph. A value: copies are independent and share keyframes.
class Slam {
 public:
  Slam(const SlamOptions& options, const sensors::LidarProfile& profile);

  /// See KeyframeStore::spill_to().
  void spill_to(const std::filesystem::path& folder) { keyframes_.spill_to(folder); }

  /// Whether the frame would become a keyframe; to be asked once for every frame, in order.
  bool wants(const lidar::Frame& frame) { return maker_.observe(frame); }
  /// Takes the frame that was wanted. \param points its scan as odometry used it \param deskewed
  /// whether scans are deskewed by Frame::velocity
  void add(const lidar::Frame& frame, const sensors::LidarScan& scan,
           const lidar::CorrectedScan& points, bool deskewed);

  /// Position of an antenna at the latest keyframe [m, ENU], its covariance, and the antenna in the
  /// lidar's frame.
  void add_gnss(const Eigen::Vector3d& antenna_enu, const Eigen::Matrix3d& covariance,
                const Eigen::Vector3d& antenna_lidar);
  /// Up at the latest keyframe, lidar frame.
  void add_gravity(const Eigen::Vector3d& up_lidar, double sigma_rad);

  /// At the end: loops that found no witness are turned away, the graph is solved once more.
  void finish();

  const OdometryChain& chain() const { return chain_; }
  const KeyframeStore& keyframes() const { return keyframes_; }
  /// T_map_lidar of a keyframe by the last solution.
  const geometry::Pose3& pose(std::size_t keyframe) const { return graph_.pose(keyframe); }
  const std::vector<Loop>& loops() const { return loops_; }
  std::size_t accepted_loops() const;
  const pose_graph::PoseGraph& graph() const { return graph_; }
  /// The factors that its graph solves with; a run checks their Jacobians.
  std::vector<optimization::FactorUse> graph_factors() const;
  /// The last one that could be used.
  const std::optional<pose_graph::Result>& solution() const { return solution_; }
  /// Why the graph could not be solved when it was to be, last; empty if it could. Its poses are
  /// those of the solution before, or odometry's.
  const std::string& failure() const { return failure_; }
  /// Whether anything but odometry is in the graph; else the map is odometry's.
  bool is_corrected() const { return solution_.has_value(); }

  /// Poses T_map_lidar of frames by odometry: carried along with the keyframes around them.
  /// Without any correction they are returned as they are. \param stamps ascending
  std::vector<geometry::Pose3> corrected(std::span<const geometry::Stamp> stamps,
                                         std::span<const geometry::Pose3> T_odom_lidar) const;

 private:
  static constexpr std::size_t kNoEdge = std::numeric_limits<std::size_t>::max();
  struct Prediction {
    geometry::Pose3 T_candidate_keyframe;
    geometry::Matrix6 covariance;  ///< of the twist, axes of the keyframe
    double sigma_m = 0;            ///< of the position, the largest axis
  };
  Prediction predict(std::size_t candidate, std::size_t keyframe) const;
  void search_loops(std::size_t keyframe, const Keyframe& content);
  Loop verify(const Candidate& candidate, LoopSource source, const Keyframe& content,
              const Prediction& prediction);
  LoopVerdict judge(const Loop& loop, const LoopRegistration& found, bool degenerate) const;
  void confirm(Loop& loop);
  bool agree(const Loop& a, const Loop& b) const;
  void accept(Loop& loop);
  void solve();
  std::shared_ptr<const Submap> submap_around(std::size_t candidate);

  SlamOptions options_;
  KeyframeMaker maker_;
  KeyframeStore keyframes_;
  std::vector<geometry::Stamp> stamps_;
  OdometryChain chain_;
  LoopCandidates candidates_;
  pose_graph::PoseGraph graph_;
  std::vector<Loop> loops_;
  std::vector<std::size_t> edge_of_loop_;              ///< in the graph; kNoEdge
  std::deque<std::shared_ptr<const Submap>> submaps_;  ///< the last few used
  std::optional<std::size_t> last_accepted_;           ///< in loops_
  std::size_t unsolved_loops_ = 0;
  std::optional<pose_graph::Result> solution_;
  std::string failure_;
};

}  // namespace traverse::slam
