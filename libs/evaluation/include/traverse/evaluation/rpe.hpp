#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

#include "traverse/evaluation/pose_pairs.hpp"
#include "traverse/evaluation/poses.hpp"
#include "traverse/evaluation/relation.hpp"
#include "traverse/evaluation/statistics.hpp"

namespace traverse::evaluation {

/// Whose path or rotation decides which poses are `delta` apart.
enum class PairsFrom { kEstimate, kReference };

inline constexpr std::array<std::pair<std::string_view, PairsFrom>, 2> kPairsFromNames{
    {{"estimate", PairsFrom::kEstimate}, {"reference", PairsFrom::kReference}}};
std::string_view name_of(PairsFrom source);

struct RpeOptions {
  Delta delta;
  bool all_pairs = false;
  PairsFrom pairs_from = PairsFrom::kEstimate;
};

/// Relative pose error: how far the estimated motion between two moments is from the true one.
struct Rpe {
  RpeOptions options;
  Relation relation = Relation::kTranslation;
  std::vector<IndexPair> pairs;  ///< indices into the matches
  std::vector<double> values;    ///< one a pair, in unit_of(relation); belongs to pairs[k].to
  /// Pairs left out of kPointDistanceRatio because the reference did not move between them.
  std::size_t dropped_without_motion = 0;
  Statistics statistics;
};

/// The pairs of matched poses that `options` ask for. \throws EvaluationError if there is none,
/// saying what there is; std::invalid_argument if the sizes differ or the delta is not valid.
std::vector<IndexPair> rpe_pairs(const Poses& estimate, const Poses& reference,
                                 const RpeOptions& options);

/// Over `pairs` that were selected by `options`, of matched poses, the estimate already aligned
/// (its scale matters). Source: Sturm et al., IROS 2012; definitions of evo. \throws
/// EvaluationError if no pair is left because the reference never moves.
Rpe rpe(const Poses& estimate, const Poses& reference, const RpeOptions& options,
        std::vector<IndexPair> pairs, Relation relation);

/// Both steps. \throws as they do.
Rpe rpe(const Poses& estimate, const Poses& reference, const RpeOptions& options,
        Relation relation);

}  // namespace traverse::evaluation
