#include "traverse/evaluation/evaluate.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "traverse/evaluation/titles.hpp"

namespace traverse::evaluation {

using geometry::Pose3;

namespace {

constexpr double kFarthest_m = 1e12;  // squares and sums of positions below it stay finite

/// Goes through the poses once. \throws EvaluationError if one is not finite
TrajectoryFacts facts_of(const TrajectoryView& trajectory, const char* which) {
  TrajectoryFacts facts;
  facts.poses = trajectory.size();
  Eigen::Vector3d last;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const Pose3 pose = trajectory.poses[i];
    if (!pose.rotation.allFinite() || !(pose.translation.array().abs() < kFarthest_m).all()) {
      throw EvaluationError(
          fmt::format("pose {} of the {} is not finite or beyond {} m", i, which, kFarthest_m));
    }
    if (i > 0) facts.path_m += (pose.translation - last).norm();
    last = pose.translation;
  }
  if (trajectory.is_stamped && !trajectory.empty()) {
    facts.first = trajectory.stamps.front();
    facts.last = trajectory.stamps.back();
  }
  return facts;
}

std::vector<geometry::Stamp> matched_stamps(const TrajectoryView& estimate,
                                            const Association& association) {
  std::vector<geometry::Stamp> stamps;
  if (association.mode == AssociationMode::kIndex) return stamps;
  stamps.reserve(association.matches.size());
  for (const Match& match : association.matches) stamps.push_back(estimate.stamps[match.estimate]);
  return stamps;
}

/// Does `compute`; where the trajectories do not define its metric, throws or takes note of why.
template <typename Compute>
void compute_if_defined(const EvaluationOptions& options, const std::string& metric,
                        Comparison& comparison, Compute compute) {
  try {
    compute();
  } catch (const EvaluationError& error) {
    if (options.rpe_must_exist) throw EvaluationError(metric + ": " + error.what());
    comparison.undefined.push_back({metric, error.what()});
  }
}

void add_rpe(const Poses& estimate, const Poses& reference, const EvaluationOptions& options,
             Comparison& comparison) {
  for (const RpeOptions& rpe_options : options.rpe) {
    const std::string pairs_text = describe(rpe_options);
    std::vector<IndexPair> pairs;
    compute_if_defined(options, "RPE, " + pairs_text, comparison,
                       [&] { pairs = rpe_pairs(estimate, reference, rpe_options); });
    if (pairs.empty()) continue;
    for (const Relation relation : options.rpe_relations) {
      const std::string metric = fmt::format("RPE {}, {}", title_of(relation), pairs_text);
      compute_if_defined(options, metric, comparison, [&] {
        comparison.rpe.push_back(rpe(estimate, reference, rpe_options, pairs, relation));
      });
    }
  }
}

/// What an alignment that leaves a rotation open says nothing about.
bool is_of_rotation(Relation relation) {
  return relation != Relation::kTranslation && relation != Relation::kPointDistance;
}

void add_ape(const MatchedPoses& matched, const Poses& aligned_estimate,
             const EvaluationOptions& options, Comparison& comparison) {
  const Alignment& alignment = comparison.alignment;
  for (const Relation relation : options.ape_relations) {
    if (!alignment.determines_rotation() && is_of_rotation(relation)) continue;
    comparison.ape.push_back(ape(aligned_estimate, matched.reference, relation));
  }
  if (alignment.undetermined == Undetermined::kNothing) return;
  comparison.undefined.push_back(
      {alignment.determines_rotation() ? "scale" : "APE of rotations",
       fmt::format("{} of the {} alignment is not determined: {}", name_of(alignment.undetermined),
                   name_of(alignment.mode), alignment.reason)});
  const Alignment origin =
      align(matched.estimate, matched.reference, {AlignmentMode::kOrigin, std::nullopt});
  const Poses at_origin = aligned(matched.estimate, origin);
  for (const Relation relation : options.ape_relations) {
    comparison.ape_at_origin.push_back(ape(at_origin, matched.reference, relation));
  }
}

/// Figures over a few of many poses are the few's.
void warn_of_few_matches(std::size_t estimate, std::size_t reference, Comparison& comparison) {
  const std::size_t matches = comparison.association.matches.size();
  const std::size_t shorter = std::min(estimate, reference);
  if (2 * matches >= shorter) return;
  comparison.warnings.push_back(
      fmt::format("only {} of the {} poses of the {} found a match within {} s: the figures are "
                  "those of so few; "
                  "are the two clocks the same, or is a time offset needed?",
                  matches, shorter, estimate <= reference ? "estimate" : "reference",
                  comparison.association.options.max_time_difference_s));
}

void add_kitti(const MatchedPoses& matched, const KittiDriftOptions& options,
               Comparison& comparison) {
  comparison.kitti = kitti_drift(matched.estimate, matched.reference, options);
  if (comparison.kitti) return;
  comparison.undefined.push_back(
      {"KITTI drift", fmt::format("no stretch of the reference is longer than {} m: its path is "
                                  "{:.4g} m long",
                                  kKittiLengths_m.front(), comparison.path.reference_m)});
}

/// rpg's; the lengths where there are too few stretches are told.
void add_sub_trajectories(const MatchedPoses& matched, const std::vector<double>& asked_m,
                          Comparison& comparison) {
  const std::vector<double> lengths_m =
      asked_m.empty() ? sub_trajectory_lengths(comparison.reference.path_m) : asked_m;
  comparison.sub_trajectories = sub_trajectory_errors(matched.estimate, matched.reference,
                                                      comparison.alignment.scale, lengths_m);
  std::vector<std::string> missing;
  for (const double length_m : lengths_m) {
    const bool is_there =
        std::any_of(comparison.sub_trajectories.begin(), comparison.sub_trajectories.end(),
                    [&](const SubTrajectoryErrors& errors) { return errors.length_m == length_m; });
    if (!is_there) missing.push_back(fmt::format("{:g}", length_m));
  }
  if (missing.empty()) return;
  comparison.undefined.push_back(
      {fmt::format("relative errors over {} m", fmt::join(missing, ", ")),
       fmt::format("fewer than two stretches so long: the path of the matched poses of the "
                   "reference is {:.4g} m long",
                   comparison.path.reference_m)});
}

}  // namespace

EvaluationOptions run_evaluation_options() {
  EvaluationOptions options;
  options.alignment.mode = AlignmentMode::kSe3;
  options.ape_relations.clear();
  options.rpe_relations.clear();
  for (const auto& [name, relation] : kRelationNames) {
    if (is_absolute(relation)) options.ape_relations.push_back(relation);
    options.rpe_relations.push_back(relation);
  }
  for (const double frames : {1.0, 10.0, 50.0, 100.0}) {
    options.rpe.push_back({{frames, DeltaUnit::kFrames}, true, PairsFrom::kEstimate});
  }
  options.rpe.push_back({{100, DeltaUnit::kMetres}, true, PairsFrom::kEstimate});
  options.rpe_must_exist = false;
  return options;
}

Evaluation evaluate(const TrajectoryView& estimate, const TrajectoryView& reference,
                    const EvaluationOptions& options) {
  const TrajectoryFacts facts = facts_of(estimate, "estimate");
  Comparison comparison;
  comparison.reference = facts_of(reference, "reference");
  comparison.association = associate(estimate, reference, options.association);
  comparison.stamps = matched_stamps(estimate, comparison.association);
  warn_of_few_matches(estimate.size(), reference.size(), comparison);

  const MatchedPoses matched = matched_poses(estimate, reference, comparison.association.matches);
  comparison.distances_m = accumulated_distances(matched.reference);
  comparison.path = path_figures(matched.estimate, matched.reference);
  add_kitti(matched, options.kitti, comparison);

  comparison.alignment = align(matched.estimate, matched.reference, options.alignment);
  const Poses aligned_estimate = aligned(matched.estimate, comparison.alignment);
  add_ape(matched, aligned_estimate, options, comparison);
  comparison.split = error_split(aligned_estimate, matched.reference);
  add_rpe(aligned_estimate, matched.reference, options, comparison);
  add_sub_trajectories(matched, options.sub_trajectory_lengths_m, comparison);
  return {facts, std::move(comparison), std::nullopt};
}

Evaluation evaluate(const TrajectoryView& estimate) {
  return {facts_of(estimate, "estimate"), std::nullopt, std::nullopt};
}

const Ape* find_ape(const Comparison& comparison, Relation relation) {
  const auto found = std::find_if(comparison.ape.begin(), comparison.ape.end(),
                                  [&](const Ape& ape) { return ape.relation == relation; });
  return found == comparison.ape.end() ? nullptr : &*found;
}

const Rpe* find_rpe(const Comparison& comparison, Relation relation, double frames) {
  const auto found =
      std::find_if(comparison.rpe.begin(), comparison.rpe.end(), [&](const Rpe& rpe) {
        return rpe.relation == relation && rpe.options.delta.unit == DeltaUnit::kFrames &&
               rpe.options.delta.value == frames;
      });
  return found == comparison.rpe.end() ? nullptr : &*found;
}

}  // namespace traverse::evaluation
