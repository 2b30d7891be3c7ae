#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "traverse/batch/plan.hpp"
#include "traverse/batch/results.hpp"
#include "traverse/page/table.hpp"

#include "results/run_series.hpp"
#include "results/summary.hpp"

namespace traverse::batch {

/// A variant among the others, over all recordings.
struct RankedVariant {
  std::string variant;
  std::size_t recordings = 0;      ///< on which it has the metric
  std::optional<double> mean;      ///< of it over these
  std::optional<double> wall_s;    ///< mean over the recordings
  std::optional<double> frames_s;  ///< that its frames alone took, where it tells that
  double mean_rank = 0;            ///< over all recordings; those without the metric are last
  /// 95 % interval of the mean rank: percentiles of 20 000 resamples of the recordings.
  std::optional<std::pair<double, double>> interval;
  /// Variants that share a letter are not told apart: the bootstrap of the difference of their mean
  /// ranks, paired by recording, at 5 % after Holm. Of fewer than five recordings the interval is
  /// not told, and letters are of what differs along these drives, by the intervals of
  /// differences; of more than sixty variants (then: sixteen) they are empty.
  std::string letters;
  /// Mean over the recordings of the metric less that of the first, and its 95 % interval by the
  /// paired moving-block bootstrap along each drive; of the first and where there are five
  /// recordings nothing.
  struct Difference {
    double mean = 0;
    double low = 0;
    double high = 0;
  };
  std::optional<Difference> over_first;
  /// No other is both better and faster.
  bool is_on_front = false;
};

struct Ranking {
  std::string metric;
  std::size_t recordings = 0;
  std::vector<RankedVariant> variants;  ///< by their mean rank
};

/// The ranking by a metric; nothing for fewer than two variants or a metric that has no better.
/// \param folder_of where runs are; nothing: what they say of differences along drives is not told
std::optional<Ranking> rank_variants(const Results& results, const std::string& metric,
                                     const RunFolderOf& folder_of = {});

/// Letters so that two share one unless they differ, as few as that takes (insert and absorb;
/// Piepho, "An algorithm for a letter-based representation of all-pairwise comparisons", 2004).
/// \param differ [i][j]: of items in the order in which letters are given
std::vector<std::string> compact_letters(const std::vector<std::vector<bool>>& differ);

page::Table ranking_table(const Ranking& ranking);

/// What each pipeline was told, and what its figures are of.
page::Table fairness_table(const Plan& plan, const Results& results);

}  // namespace traverse::batch
