#include "traverse/mapping/merge_runs.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include <Eigen/Dense>
#include <fmt/core.h>

#include "traverse/geometry/se3.hpp"
#include "traverse/geometry/so3.hpp"
#include "traverse/pose_graph/pose_graph.hpp"
#include "traverse/slam/place_index.hpp"

#include "run_places.hpp"

namespace traverse::mapping {

namespace {

constexpr double kDegree = std::numbers::pi / 180;

geometry::Matrix6 covariance_of(double sigma_m, double sigma_deg) {
  geometry::Matrix6 covariance = geometry::Matrix6::Identity();
  covariance.topLeftCorner<3, 3>() *= std::pow(sigma_deg * kDegree, 2);
  covariance.bottomRightCorner<3, 3>() *= sigma_m * sigma_m;
  return covariance;
}

struct PlacedKeyframeId {
  std::size_t run = 0;
  std::size_t keyframe = 0;
};

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
        T_map_run_[run] = placed(run);
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
    graph.optimise();
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

  geometry::Pose3 T_map_sensor(const PlacedKeyframeId& at) const {
    return *T_map_run_[at.run] * runs_[at.run].T_map_sensor(at.keyframe);
  }

  /// The keyframes of the runs that are placed.
  std::vector<PlacedKeyframeId> placed_keyframes() const {
    std::vector<PlacedKeyframeId> all;
    for (std::size_t run = 0; run < runs_.size(); ++run) {
      for (std::size_t k = 0; T_map_run_[run] && k < runs_[run].size(); ++k)
        all.push_back({run, k});
    }
    return all;
  }

  bool alike(const geometry::Pose3& a, const geometry::Pose3& b) const {
    const geometry::Pose3 difference = a.inverse() * b;
    return difference.translation.norm() <= options_.agreement_m &&
           geometry::angle_of(difference.rotation) <= options_.agreement_deg * kDegree;
  }

  /// Where a run lies, by what its keyframes look like.
  std::optional<geometry::Pose3> placed(std::size_t run) const {
    const std::vector<PlacedKeyframeId> known = placed_keyframes();
    slam::PlaceIndex ring_keys(runs_.front().context(0).ring_key().size());
    for (const auto& at : known) ring_keys.add(runs_[at.run].context(at.keyframe).ring_key());

    std::vector<Hypothesis> hypotheses;
    const auto samples =
        std::min<std::size_t>(runs_[run].size(), static_cast<std::size_t>(options_.samples));
    for (std::size_t s = 0; s < samples; ++s) {
      const std::size_t keyframe = s * runs_[run].size() / samples;
      for (const Lookalike& like : lookalikes(run, keyframe, known, ring_keys)) {
        const PlacedKeyframeId& at = known[like.number];
        const auto found = place(
            runs_[run], keyframe, runs_[at.run].submap(at.keyframe, options_.keyframes_around),
            like.T_known_keyframe, {options_.search_m, options_.search_deg * kDegree}, options_);
        if (!found) continue;
        const geometry::Pose3 T_map_keyframe = T_map_sensor(at) * found->T_other_keyframe;
        hypotheses.push_back({keyframe, T_map_keyframe,
                              T_map_keyframe * runs_[run].T_map_sensor(keyframe).inverse()});
      }
      tell(fmt::format("place of run {}", run + 1),
           static_cast<double>(s + 1) / static_cast<double>(samples));
    }
    return largest_agreement(run, hypotheses);
  }

  /// A keyframe's place, and what it says of its run's.
  struct Hypothesis {
    std::size_t keyframe;
    geometry::Pose3 T_map_keyframe;
    geometry::Pose3 T_map_run;
  };

  struct Lookalike {
    double distance = 1;     ///< of the contexts
    std::size_t number = 0;  ///< of the known keyframe
    geometry::Pose3 T_known_keyframe;
  };
  /// The known keyframes that look most like a keyframe of a run, also from other lanes. Each comes
  /// turned round as well: from above a street looks much alike in both directions.
  std::vector<Lookalike> lookalikes(std::size_t run, std::size_t keyframe,
                                    const std::vector<PlacedKeyframeId>& known,
                                    const slam::PlaceIndex& ring_keys) const {
    constexpr std::size_t kRingKeys = 20;
    std::vector<Lookalike> compared;
    for (const double left_m : {0.0, 2.0, -2.0, 4.0, -4.0}) {
      const slam::ScanContext context = runs_[run].context_beside(keyframe, left_m);
      for (const auto& found : ring_keys.nearest(context.ring_key(), kRingKeys)) {
        const PlacedKeyframeId& at = known[found.number];
        const auto match = slam::ScanContext::compare(runs_[at.run].context(at.keyframe), context);
        const Eigen::Matrix3d turn = geometry::exp_so3({0, 0, match.turn_rad});
        compared.push_back(
            {match.distance, found.number, {turn, turn * Eigen::Vector3d(0, -left_m, 0)}});
      }
    }
    std::stable_sort(compared.begin(), compared.end(),
                     [](const auto& a, const auto& b) { return a.distance < b.distance; });
    std::vector<Lookalike> best;
    for (const Lookalike& one : compared) {
      if (best.size() == 2 * static_cast<std::size_t>(options_.candidates)) break;
      const bool is_there = std::any_of(best.begin(), best.end(), [&](const Lookalike& other) {
        return other.number == one.number;
      });
      if (is_there) continue;
      best.push_back(one);
      best.push_back(one);
      const Eigen::Matrix3d round = geometry::exp_so3({0, 0, std::numbers::pi});
      best.back().T_known_keyframe.rotation *= round;
    }
    return best;
  }

  /// By the keyframes, each counted once, that the hypotheses alike to one come from. What another
  /// place would explain half as well is not sure.
  std::optional<geometry::Pose3> largest_agreement(
      std::size_t run, const std::vector<Hypothesis>& hypotheses) const {
    const auto agreeing = [&](const Hypothesis& one, bool with_it) {
      std::vector<std::size_t> keyframes;
      for (const Hypothesis& other : hypotheses) {
        // Compared where the other keyframe stands: far from the run's origin a small turn is far.
        const geometry::Pose3 expected = one.T_map_run * runs_[run].T_map_sensor(other.keyframe);
        if (alike(expected, other.T_map_keyframe) == with_it) keyframes.push_back(other.keyframe);
      }
      keyframes.erase(std::unique(keyframes.begin(), keyframes.end()), keyframes.end());
      return keyframes.size();
    };
    const Hypothesis* best = nullptr;
    std::size_t most = 0;
    for (const Hypothesis& one : hypotheses) {
      const std::size_t count = agreeing(one, true);
      if (count > most) {
        most = count;
        best = &one;
      }
    }
    if (best == nullptr || most < static_cast<std::size_t>(options_.least_agreeing)) return {};
    for (const Hypothesis& one : hypotheses) {
      const geometry::Pose3 expected = best->T_map_run * runs_[run].T_map_sensor(one.keyframe);
      if (!alike(expected, one.T_map_keyframe) && 2 * agreeing(one, true) > most) return {};
    }
    return best->T_map_run;
  }

  /// Registers every keyframe of a run that was just placed near keyframes that stood before.
  void link(std::size_t run) {
    std::vector<PlacedKeyframeId> known = placed_keyframes();
    std::erase_if(known, [&](const auto& at) { return at.run == run; });
    slam::PlaceIndex positions(3);
    for (const auto& at : known) {
      const Eigen::Vector3f p = T_map_sensor(at).translation.cast<float>();
      positions.add({p.data(), 3});
    }
    for (std::size_t k = 0; k < runs_[run].size(); ++k) {
      const geometry::Pose3 predicted = T_map_sensor({run, k});
      const Eigen::Vector3f p = predicted.translation.cast<float>();
      const auto nearest = positions.nearest({p.data(), 3}, 1);
      tell(fmt::format("links of run {}", run + 1),
           static_cast<double>(k + 1) / static_cast<double>(runs_[run].size()));
      if (nearest.empty() || nearest.front().distance > options_.reach_m) continue;
      const PlacedKeyframeId& at = known[nearest.front().number];
      const geometry::Pose3 guess = T_map_sensor(at).inverse() * predicted;
      const auto found =
          place(runs_[run], k, runs_[at.run].submap(at.keyframe, options_.keyframes_around), guess,
                {options_.correction_m / 2, kDegree}, options_);
      if (!found) continue;
      const double moved = (guess.inverse() * found->T_other_keyframe).translation.norm();
      if (moved > options_.correction_m) continue;
      links_.push_back({{run, k, at.run, at.keyframe, found->overlap, found->residual_rms_m, 0},
                        found->T_other_keyframe});
    }
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
      graph.add_node(id(run, k), T_map_sensor({run, k}));
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
