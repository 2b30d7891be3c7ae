#include "run_search.hpp"

#include <algorithm>
#include <numbers>
#include <utility>

#include <Eigen/Dense>

#include "traverse/geometry/angle.hpp"
#include "traverse/geometry/so3.hpp"

namespace traverse::mapping {

RunSearch::RunSearch(std::vector<KnownKeyframe> known, const MergeOptions& options)
    : known_(std::move(known)),
      options_(options),
      ring_keys_(known_.front().places->context(0).ring_key().size()) {
  for (const KnownKeyframe& at : known_) ring_keys_.add(at.places->context(at.keyframe).ring_key());
}

std::optional<geometry::Pose3> RunSearch::place_of(
    const RunPlaces& run, const std::function<void(double)>& progress) const {
  const slam::SearchRegion region{options_.search_m, options_.search_deg * geometry::kDegree};
  const auto samples =
      std::min<std::size_t>(run.size(), static_cast<std::size_t>(options_.samples));
  std::vector<Hypothesis> hypotheses;
  for (std::size_t s = 0; s < samples; ++s) {
    const std::size_t keyframe = s * run.size() / samples;
    for (const Lookalike& like : lookalikes(run, keyframe)) {
      const KnownKeyframe& at = known_[like.number];
      const auto found =
          place(run, keyframe, at.places->submap(at.keyframe, options_.keyframes_around),
                like.T_known_keyframe, region, options_);
      if (!found) continue;
      const geometry::Pose3 T_map_keyframe = at.T_map_sensor * found->T_other_keyframe;
      hypotheses.push_back(
          {keyframe, T_map_keyframe, T_map_keyframe * run.T_map_sensor(keyframe).inverse()});
    }
    progress(static_cast<double>(s + 1) / static_cast<double>(samples));
  }
  return largest_agreement(run, hypotheses);
}

/// The known keyframes that look most like one of a run, also from other lanes. Each comes turned
/// round as well: from above a street looks much alike in both directions.
std::vector<RunSearch::Lookalike> RunSearch::lookalikes(const RunPlaces& run,
                                                        std::size_t keyframe) const {
  constexpr std::size_t kRingKeys = 20;
  std::vector<Lookalike> compared;
  for (const double left_m : {0.0, 2.0, -2.0, 4.0, -4.0}) {
    const slam::ScanContext context = run.context_beside(keyframe, left_m);
    for (const auto& found : ring_keys_.nearest(context.ring_key(), kRingKeys)) {
      const KnownKeyframe& at = known_[found.number];
      const auto match = slam::ScanContext::compare(at.places->context(at.keyframe), context);
      const Eigen::Matrix3d turn = geometry::exp_so3({0, 0, match.turn_rad});
      compared.push_back(
          {match.distance, found.number, {turn, turn * Eigen::Vector3d(0, -left_m, 0)}});
    }
  }
  std::stable_sort(compared.begin(), compared.end(),
                   [](const auto& a, const auto& b) { return a.distance < b.distance; });
  const Eigen::Matrix3d round = geometry::exp_so3({0, 0, std::numbers::pi});
  std::vector<Lookalike> best;
  for (const Lookalike& one : compared) {
    if (best.size() == 2 * static_cast<std::size_t>(options_.candidates)) break;
    const bool is_there = std::any_of(best.begin(), best.end(), [&](const Lookalike& other) {
      return other.number == one.number;
    });
    if (is_there) continue;
    best.push_back(one);
    best.push_back(one);
    best.back().T_known_keyframe.rotation *= round;
  }
  return best;
}

/// Compared where the other keyframe stands, because far from the run's origin a small turn is far.
bool RunSearch::agree(const RunPlaces& run, const Hypothesis& one, const Hypothesis& other) const {
  constexpr double kDrift = 0.01;  // of the distance between the two that runs may be bent by
  const geometry::Pose3 expected = one.T_map_run * run.T_map_sensor(other.keyframe);
  const geometry::Pose3 difference = expected.inverse() * other.T_map_keyframe;
  const double apart = (one.T_map_keyframe.translation - other.T_map_keyframe.translation).norm();
  return difference.translation.norm() <= options_.agreement_m + kDrift * apart &&
         geometry::angle_of(difference.rotation) <= options_.agreement_deg * geometry::kDegree;
}

/// How many keyframes, each counted once, have hypotheses that agree with one.
std::size_t RunSearch::agreeing(const RunPlaces& run, const Hypothesis& one,
                                const std::vector<Hypothesis>& hypotheses) const {
  std::vector<std::size_t> keyframes;
  for (const Hypothesis& other : hypotheses) {
    if (agree(run, one, other)) keyframes.push_back(other.keyframe);
  }
  keyframes.erase(std::unique(keyframes.begin(), keyframes.end()), keyframes.end());
  return keyframes.size();
}

std::optional<geometry::Pose3> RunSearch::largest_agreement(
    const RunPlaces& run, const std::vector<Hypothesis>& hypotheses) const {
  std::vector<std::size_t> support;
  for (const Hypothesis& one : hypotheses) support.push_back(agreeing(run, one, hypotheses));
  const auto most = std::max_element(support.begin(), support.end());
  if (most == support.end() || *most < static_cast<std::size_t>(options_.min_agreeing)) {
    return std::nullopt;
  }
  const Hypothesis& best = hypotheses[static_cast<std::size_t>(most - support.begin())];
  for (std::size_t h = 0; h < hypotheses.size(); ++h) {
    if (2 * support[h] > *most && !agree(run, best, hypotheses[h])) return std::nullopt;
  }
  return best.T_map_run;
}

}  // namespace traverse::mapping
