#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "traverse/batch/plan.hpp"
#include "traverse/batch/results.hpp"
#include "traverse/page/table.hpp"

#include "results/summary.hpp"

namespace traverse::batch {

/// A variant among the others, over all recordings.
struct RankedVariant {
  std::string variant;
  std::size_t recordings = 0;    ///< on which it has the metric
  std::optional<double> mean;    ///< of it over these
  std::optional<double> wall_s;  ///< mean over the recordings
  double mean_rank = 0;          ///< over all recordings; those without the metric are last
  /// 95 % interval of the mean rank: percentiles of 20 000 resamples of the recordings.
  std::optional<std::pair<double, double>> interval;
  /// Variants that share a letter are not told apart: the bootstrap of the difference of their mean
  /// ranks, paired by recording, at 5 % after Holm. Empty where there are fewer than five
  /// recordings or more than sixty variants, as the interval is.
  std::string letters;
  /// No other is both better and faster.
  bool is_on_front = false;
};

struct Ranking {
  std::string metric;
  std::size_t recordings = 0;
  std::vector<RankedVariant> variants;  ///< by their mean rank
};

/// The ranking by a metric; nothing for fewer than two variants or a metric that has no better.
std::optional<Ranking> rank_variants(const Results& results, const std::string& metric);

/// Letters so that two share one unless they differ, as few as that takes (insert and absorb;
/// Piepho, "An algorithm for a letter-based representation of all-pairwise comparisons", 2004).
/// \param differ [i][j]: of items in the order in which letters are given
std::vector<std::string> compact_letters(const std::vector<std::vector<bool>>& differ);

page::Table ranking_table(const Ranking& ranking);

/// What each pipeline was told, and what its figures are of.
page::Table fairness_table(const Plan& plan, const Results& results);

}  // namespace traverse::batch
