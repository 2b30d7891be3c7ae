#include "traverse/mapping/merge_runs.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <Eigen/Dense>
#include <fmt/core.h>

#include "traverse/geometry/angle.hpp"
#include "traverse/geometry/se3.hpp"
#include "traverse/pose_graph/pose_graph.hpp"
#include "traverse/slam/place_index.hpp"

#include "run_places.hpp"
#include "run_search.hpp"

namespace traverse::mapping {

namespace {

geometry::Matrix6 covariance_of(double sigma_m, double sigma_deg) {
  geometry::Matrix6 covariance = geometry::Matrix6::Identity();
  covariance.topLeftCorner<3, 3>() *= std::pow(sigma_deg * geometry::kDegree, 2);
  covariance.bottomRightCorner<3, 3>() *= sigma_m * sigma_m;
  return covariance;
}

struct Link {
  RunLink what;
  geometry::Pose3 T_other_keyframe;
};

class Merger {
 public:
  Merger(const std::vector<std::vector<MapKeyframe>>& runs, const MergeOptions& options,
         const MergeProgress& progress)
      : options_(options), progress_(progress), T_map_run_(runs.size()) {
    for (const auto& keyframes : runs) {
      runs_.emplace_back(keyframes);
      tell("features", static_cast<double>(runs_.size()) / static_cast<double>(runs.size()));
    }
    T_map_run_.front() = geometry::Pose3::identity();
  }

  void place_all() {
    bool goes_on = true;
    while (goes_on) {
      goes_on = false;
      for (std::size_t run = 0; run < runs_.size(); ++run) {
        if (T_map_run_[run]) continue;
        T_map_run_[run] =
            RunSearch(known_keyframes(), options_).place_of(runs_[run], [&](double share) {
              tell(fmt::format("place of run {}", run + 1), share);
            });
        if (!T_map_run_[run]) continue;
        link(run);
        goes_on = true;
      }
    }
    for (std::size_t run = 0; run < runs_.size(); ++run) {
      if (!T_map_run_[run]) throw NoOverlap(run);
    }
  }

  /// Solves for all poses; returns T_map_sensor of every keyframe, run by run.
  std::vector<std::vector<geometry::Pose3>> solve() {
    pose_graph::PoseGraph graph;
    for (std::size_t run = 0; run < runs_.size(); ++run) add_run(graph, run);
    std::vector<std::size_t> edge_of_link;
    for (const Link& link : links_) {
      edge_of_link.push_back(graph.edges().size());
      graph.add_between(id(link.what.other_run, link.what.other_keyframe),
                        id(link.what.run, link.what.keyframe), link.T_other_keyframe,
                        covariance_of(0.05, 0.1), pose_graph::EdgeKind::kLoop);
    }
    tell("pose graph", 0);
    const pose_graph::Result result = graph.optimise();
    if (!result.is_usable) {
      throw std::runtime_error("the pose graph of the runs could not be solved: " + result.message);
    }
    tell("pose graph", 1);
    for (std::size_t l = 0; l < links_.size(); ++l) {
      links_[l].what.weight = graph.edges()[edge_of_link[l]].weight;
    }
    std::vector<std::vector<geometry::Pose3>> poses(runs_.size());
    for (std::size_t run = 0; run < runs_.size(); ++run) {
      for (std::size_t k = 0; k < runs_[run].size(); ++k) {
        poses[run].push_back(graph.pose(id(run, k)));
      }
    }
    return poses;
  }

  std::vector<RunLink> links() const {
    std::vector<RunLink> links;
    for (const Link& link : links_) links.push_back(link.what);
    return links;
  }

 private:
  void tell(const std::string& stage, double share) const {
    if (progress_) progress_(stage, share);
  }

  std::size_t id(std::size_t run, std::size_t keyframe) const {
    for (std::size_t before = 0; before < run; ++before) keyframe += runs_[before].size();
    return keyframe;
  }

  geometry::Pose3 T_map_sensor(std::size_t run, std::size_t keyframe) const {
    return *T_map_run_[run] * runs_[run].T_map_sensor(keyframe);
  }

  /// The keyframes of the runs that are placed.
  std::vector<KnownKeyframe> known_keyframes() const {
    std::vector<KnownKeyframe> all;
    for (std::size_t run = 0; run < runs_.size(); ++run) {
      for (std::size_t k = 0; T_map_run_[run] && k < runs_[run].size(); ++k) {
        all.push_back({run, k, &runs_[run], T_map_sensor(run, k)});
      }
    }
    return all;
  }

  /// Registers every keyframe of a run that was just placed near keyframes that stood before.
  void link(std::size_t run) {
    std::vector<KnownKeyframe> known = known_keyframes();
    std::erase_if(known, [&](const KnownKeyframe& at) { return at.run == run; });
    slam::PlaceIndex positions(3);
    for (const KnownKeyframe& at : known) {
      const Eigen::Vector3f p = at.T_map_sensor.translation.cast<float>();
      positions.add({p.data(), 3});
    }
    for (std::size_t k = 0; k < runs_[run].size(); ++k) {
      tell(fmt::format("links of run {}", run + 1),
           static_cast<double>(k + 1) / static_cast<double>(runs_[run].size()));
      const Eigen::Vector3f p = T_map_sensor(run, k).translation.cast<float>();
      const auto nearest = positions.nearest({p.data(), 3}, 1);
      if (nearest.empty() || nearest.front().distance > options_.reach_m) continue;
      link(run, k, known[nearest.front().number]);
    }
  }

  void link(std::size_t run, std::size_t keyframe, const KnownKeyframe& at) {
    const geometry::Pose3 guess = at.T_map_sensor.inverse() * T_map_sensor(run, keyframe);
    const auto found =
        place(runs_[run], keyframe, at.places->submap(at.keyframe, options_.keyframes_around),
              guess, {options_.correction_m / 2, geometry::kDegree}, options_);
    if (!found) return;
    const double moved = (guess.inverse() * found->T_other_keyframe).translation.norm();
    if (moved > options_.correction_m) return;
    links_.push_back(
        {{run, keyframe, at.run, at.keyframe, found->overlap, found->residual_rms_m, 0},
         found->T_other_keyframe});
  }

  /// Nodes of a run, the steps between them, and what the run knew of its own revisits.
  void add_run(pose_graph::PoseGraph& graph, std::size_t run) const {
    constexpr double kDriftPerRootMetre = 0.02;     // m, and
    constexpr double kDriftDegPerRootMetre = 0.02;  // deg
    constexpr double kRevisitAfter_m = 40;
    const RunPlaces& places = runs_[run];
    slam::PlaceIndex passed(3);
    std::vector<double> way{0};
    std::size_t indexed = 0;
    for (std::size_t k = 0; k < places.size(); ++k) {
      graph.add_node(id(run, k), T_map_sensor(run, k));
      if (k == 0) continue;
      const geometry::Pose3 step = places.T_map_sensor(k - 1).inverse() * places.T_map_sensor(k);
      way.push_back(way.back() + step.translation.norm());
      const double root = std::sqrt(std::max(0.25, step.translation.norm()));
      graph.add_between(id(run, k - 1), id(run, k), step,
                        covariance_of(root * kDriftPerRootMetre, root * kDriftDegPerRootMetre),
                        pose_graph::EdgeKind::kOdometry);
      for (; way[indexed] < way[k] - kRevisitAfter_m; ++indexed) {
        const Eigen::Vector3f p = places.T_map_sensor(indexed).translation.cast<float>();
        passed.add({p.data(), 3});
      }
      const Eigen::Vector3f p = places.T_map_sensor(k).translation.cast<float>();
      const auto nearest = passed.nearest({p.data(), 3}, 1);
      if (nearest.empty() || nearest.front().distance > options_.reach_m) continue;
      const std::size_t before = nearest.front().number;
      graph.add_between(id(run, before), id(run, k),
                        places.T_map_sensor(before).inverse() * places.T_map_sensor(k),
                        covariance_of(0.1, 0.2), pose_graph::EdgeKind::kOdometry);
    }
  }

  const MergeOptions& options_;
  const MergeProgress& progress_;
  std::vector<RunPlaces> runs_;
  std::vector<std::optional<geometry::Pose3>> T_map_run_;
  std::vector<Link> links_;
};

}  // namespace

NoOverlap::NoOverlap(std::size_t run)
    : std::runtime_error(
          fmt::format("run {} shows no place for sure that the runs before it show", run + 1)),
      run_(run) {}

MergedRuns merge_runs(std::vector<std::vector<MapKeyframe>> runs, const MergeOptions& options,
                      const MergeProgress& progress) {
  Merger merger(runs, options, progress);
  merger.place_all();
  const auto poses = merger.solve();
  MergedRuns merged{std::move(runs), merger.links()};
  for (std::size_t run = 0; run < merged.runs.size(); ++run) {
    for (std::size_t k = 0; k < merged.runs[run].size(); ++k) {
      MapKeyframe& keyframe = merged.runs[run][k];
      keyframe.T_map_body =
          poses[run][k] * geometry::Pose3{Eigen::Matrix3d::Identity(), -keyframe.p_body_sensor};
    }
  }
  return merged;
}

}  // namespace traverse::mapping
