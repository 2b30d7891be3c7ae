#include "traverse/evaluation/rpe.hpp"

#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "traverse/evaluation/evaluation_error.hpp"
#include "traverse/evaluation/path_figures.hpp"
#include "traverse/geometry/so3.hpp"

#include "names.hpp"
#include "require_matched.hpp"

namespace traverse::evaluation {

namespace {

double accumulated_angle_deg(const Poses& poses) {
  double angle_rad = 0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    angle_rad += geometry::angle_of(poses[i - 1].rotation.transpose() * poses[i].rotation);
  }
  return angle_rad * 180 / std::numbers::pi;
}

/// What there is instead of a pair `delta` apart.
std::string extent_text(const Poses& poses, const RpeOptions& options) {
  const std::string_view whose = name_of(options.pairs_from);
  switch (options.delta.unit) {
    case DeltaUnit::kFrames:
      return fmt::format("there are {} matched poses", poses.size());
    case DeltaUnit::kMetres:
      return fmt::format("the path of the {} is {:.4g} m long", whose, path_length(poses));
    case DeltaUnit::kDegrees:
    case DeltaUnit::kRadians:
      return fmt::format("the {} turns by {:.4g} deg in all", whose, accumulated_angle_deg(poses));
  }
  return {};
}

bool has_motion(const Poses& reference, const IndexPair& pair) {
  return reference[pair.from].translation != reference[pair.to].translation;
}

}  // namespace

std::string_view name_of(PairsFrom source) { return name_in(kPairsFromNames, source); }

std::vector<IndexPair> rpe_pairs(const Poses& estimate, const Poses& reference,
                                 const RpeOptions& options) {
  require_matched(estimate, reference);
  const Poses& poses = options.pairs_from == PairsFrom::kEstimate ? estimate : reference;
  std::vector<IndexPair> pairs = select_pairs(poses, options.delta, options.all_pairs);
  if (pairs.empty()) {
    throw EvaluationError(fmt::format("no {}pair of poses is {} apart: {}",
                                      options.all_pairs ? "" : "consecutive ",
                                      to_text(options.delta), extent_text(poses, options)));
  }
  return pairs;
}

Rpe rpe(const Poses& estimate, const Poses& reference, const RpeOptions& options,
        std::vector<IndexPair> pairs, Relation relation) {
  require_matched(estimate, reference);
  Rpe result;
  result.options = options;
  result.relation = relation;
  if (relation == Relation::kPointDistanceRatio) {
    result.dropped_without_motion =
        std::erase_if(pairs, [&](const IndexPair& pair) { return !has_motion(reference, pair); });
    if (pairs.empty()) {
      throw EvaluationError(
          fmt::format("the point distance ratio is not defined: the reference does not move within "
                      "any of the {} pairs",
                      result.dropped_without_motion));
    }
  }
  result.pairs = std::move(pairs);
  result.values.reserve(result.pairs.size());
  for (const auto& [from, to] : result.pairs) {
    result.values.push_back(
        relative_error({estimate[from], estimate[to]}, {reference[from], reference[to]}, relation));
  }
  result.statistics = statistics_of(result.values);
  return result;
}

Rpe rpe(const Poses& estimate, const Poses& reference, const RpeOptions& options,
        Relation relation) {
  return rpe(estimate, reference, options, rpe_pairs(estimate, reference, options), relation);
}

}  // namespace traverse::evaluation
