#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "traverse/batch/results.hpp"
#include "traverse/page/table.hpp"

#include "results/run_series.hpp"
#include "results/summary.hpp"

namespace traverse::batch {

/// Whether the best variant by a metric is better than the next for sure.
struct Lead {
  std::string metric;
  std::string first;
  std::string second;     ///< empty: there is no other with the metric
  double mean = 0;        ///< of the first, over the recordings
  double difference = 0;  ///< second less first, mean over the recordings that both have
  /// 95 % interval of the difference; nothing where there is nothing to tell it by. Of three
  /// recordings and more Student's t over them (paired); of fewer the paired moving-block bootstrap
  /// along each, which knows what varies in these drives, not between drives.
  std::optional<std::pair<double, double>> interval;
  std::size_t better_on = 0;   ///< recordings on which the first is better
  std::size_t recordings = 0;  ///< that both have
  bool has_more_ok = false;    ///< the second has fewer runs that are ok: that alone makes the lead

  bool is_sure() const { return has_more_ok || (interval && interval->first > 0); }
};

/// The lead by a metric among the variants of which most runs are usable; nothing if the first of
/// `variants`, which stand as summarise() has them, does not have the metric.
std::optional<Lead> find_lead(const std::string& metric, const Results& results,
                              const std::vector<VariantSummary>& variants,
                              const RunFolderOf& folder_of);

/// A row a metric of which less is better: the best variant, the next, and by how much.
page::Table leads_table(const std::vector<Lead>& leads);

/// "floam leads with 0.041 m APE (loam 0.012 m more, 95 % 0.008 to 0.016)", "floam and loam are
/// tied at ...", as a part of a sentence.
std::string to_text(const Lead& lead);

}  // namespace traverse::batch
