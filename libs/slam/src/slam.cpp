#include "traverse/slam/slam.hpp"

#include <algorithm>
#include <utility>

#include "traverse/geometry/se3.hpp"

namespace traverse::slam {

namespace {

constexpr std::size_t kSubmapsKept = 4;
constexpr double kBytesOfMb = 1e6;

}  // namespace

Slam::Slam(const SlamOptions& options, const sensors::LidarProfile& profile)
    : options_(options),
      maker_(options.keyframes, profile),
      keyframes_(static_cast<std::size_t>(options.memory_mb * kBytesOfMb)),
      candidates_(options.candidates),
      graph_(options.graph) {}

void Slam::add(const lidar::Frame& frame, const sensors::LidarScan& scan,
               const lidar::CorrectedScan& points, bool deskewed) {
  Keyframe keyframe = maker_.make(frame, scan, points, deskewed);
  const std::size_t id = keyframe.id;
  chain_.add(keyframe.T_odom_lidar, keyframe.step_covariance);
  graph_.add_node(id, keyframe.T_odom_lidar);
  if (id > 0) {
    graph_.add_between(id - 1, id, chain_.motion(id - 1, id), keyframe.step_covariance,
                       pose_graph::EdgeKind::kOdometry);
  }
  stamps_.push_back(keyframe.stamp);  // of those with a pose alone, should what is above fail
  candidates_.add(
      {keyframe.points.x, keyframe.points.y, keyframe.points.z, options_.candidates.context},
      chain_.way_m(0, id), graph_.pose(id).translation);
  search_loops(id, keyframe);
  keyframes_.add(std::move(keyframe));
}

void Slam::add_gnss(const Eigen::Vector3d& antenna_enu, const Eigen::Matrix3d& covariance,
                    const Eigen::Vector3d& antenna_lidar) {
  graph_.add_gnss(keyframes_.size() - 1, antenna_enu, covariance, antenna_lidar);
}

void Slam::add_gravity(const Eigen::Vector3d& up_lidar, double sigma_rad) {
  graph_.add_gravity(keyframes_.size() - 1, up_lidar, sigma_rad);
}

void Slam::accept(Loop& loop) {
  loop.verdict = LoopVerdict::kAccepted;
  const auto number = static_cast<std::size_t>(&loop - loops_.data());
  edge_of_loop_[number] = graph_.edges().size();
  graph_.add_between(loop.candidate, loop.keyframe, loop.T_candidate_keyframe, loop.covariance,
                     pose_graph::EdgeKind::kLoop);
  last_accepted_ = number;
  ++unsolved_loops_;
  // A solution takes longer the larger the graph; a loop that agrees moves nothing and can wait.
  const std::size_t thousands = std::max<std::size_t>(1, graph_.size() / 1000);
  const std::size_t wait = thousands * static_cast<std::size_t>(options_.solve_every);
  if (loop.odometry_chi2 > options_.solve_at_chi2 || unsolved_loops_ >= wait || !solution_) solve();
}

void Slam::solve() {
  pose_graph::Result result = graph_.optimise();
  unsolved_loops_ = 0;
  failure_.clear();
  if (!result.is_usable) {
    failure_ = std::move(result.message);
    return;
  }
  solution_ = std::move(result);
  std::vector<Eigen::Vector3d> p_map;
  for (std::size_t i = 0; i < graph_.size(); ++i) p_map.push_back(graph_.pose(i).translation);
  candidates_.move(p_map);
}

void Slam::finish() {
  const bool has_more = !graph_.fixes().empty() || !graph_.levels().empty();
  if (last_accepted_ || has_more) solve();
  for (std::size_t k = 0; k < loops_.size(); ++k) {
    if (edge_of_loop_[k] == kNoEdge) continue;
    const pose_graph::Edge& edge = graph_.edges()[edge_of_loop_[k]];
    loops_[k].graph_chi2 = edge.chi2;
    loops_[k].weight = edge.weight;
    if (edge.is_rejected()) loops_[k].verdict = LoopVerdict::kOutvoted;
  }
}

std::size_t Slam::accepted_loops() const {
  return static_cast<std::size_t>(
      std::count_if(loops_.begin(), loops_.end(), [](const Loop& l) { return l.is_accepted(); }));
}

std::vector<optimization::FactorUse> Slam::graph_factors() const {
  std::vector<optimization::FactorUse> uses{{"between poses"}};
  if (!graph_.fixes().empty()) uses.push_back({"antenna position"});
  if (!graph_.levels().empty()) uses.push_back({"up direction"});
  return uses;
}

std::shared_ptr<const Submap> Slam::submap_around(std::size_t candidate) {
  const auto every = static_cast<std::size_t>(options_.submap_every);
  const std::size_t centre =
      std::min((candidate + every / 2) / every * every, candidates_.findable() - 1);
  for (const auto& submap : submaps_) {
    if (submap->centre == centre) return submap;
  }
  const auto before = static_cast<std::size_t>(options_.submap.keyframes_before);
  const auto after = static_cast<std::size_t>(options_.submap.keyframes_after);
  const std::size_t first = centre - std::min(centre, before);
  const std::size_t last = std::min(centre + after, candidates_.findable() - 1);
  std::vector<PlacedKeyframe> placed;
  for (std::size_t i = first; i <= last; ++i) {
    placed.push_back({keyframes_.at(i), chain_.motion(centre, i)});
  }
  auto submap = std::make_shared<Submap>(make_submap(centre, placed, options_.submap.map));
  submap->own_overlap = overlap_at(geometry::Pose3::identity(), *submap,
                                   keyframes_.at(centre)->features, options_.registration);
  submaps_.push_back(std::move(submap));
  if (submaps_.size() > kSubmapsKept) submaps_.pop_front();
  return submaps_.back();
}

std::vector<geometry::Pose3> Slam::corrected(std::span<const geometry::Stamp> stamps,
                                             std::span<const geometry::Pose3> T_odom_lidar) const {
  if (!is_corrected()) return {T_odom_lidar.begin(), T_odom_lidar.end()};
  const auto carried = [&](std::size_t keyframe, const geometry::Pose3& T_odom_frame) {
    return pose(keyframe) * chain_.T_odom_lidar(keyframe).inverse() * T_odom_frame;
  };
  std::vector<geometry::Pose3> poses;
  std::size_t next = 0;  // the first keyframe later than the frame
  for (std::size_t k = 0; k < stamps.size(); ++k) {
    while (next < stamps_.size() && stamps_[next] <= stamps[k]) ++next;
    if (next == 0 || next == stamps_.size()) {
      poses.push_back(carried(next == 0 ? 0 : next - 1, T_odom_lidar[k]));
      continue;
    }
    const double share = geometry::seconds_between(stamps_[next - 1], stamps[k]) /
                         geometry::seconds_between(stamps_[next - 1], stamps_[next]);
    poses.push_back(geometry::interpolate(carried(next - 1, T_odom_lidar[k]),
                                          carried(next, T_odom_lidar[k]), share));
  }
  for (geometry::Pose3& pose : poses) pose = pose.orthonormalised();
  return poses;
}

}  // namespace traverse::slam
