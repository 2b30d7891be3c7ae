#include "results/run_series.hpp"

#include <utility>
#include <vector>

#include "traverse/evaluation/json.hpp"
#include "traverse/evaluation/relation.hpp"
#include "traverse/pipeline/run_folder.hpp"

namespace traverse::batch {

using evaluation::Figure;

RunSeries::RunSeries(const std::string& metric, RunFolderOf folder_of)
    : folder_of_(std::move(folder_of)) {
  bool has_figure = false;
  for (const auto& [ending, figure] :
       {std::pair{"_rmse", Figure::kRmse}, std::pair{"_mean", Figure::kMean},
        std::pair{"_median", Figure::kMedian}}) {
    if (!metric.ends_with(ending)) continue;
    figure_ = figure;
    has_figure = true;
  }
  is_ape_ = has_figure && metric.starts_with("ape_translation_");
  is_rpe_ = has_figure && metric.starts_with("rpe_10f_translation_");
}

const RunSeries::Series& RunSeries::of(const Job& job) {
  const auto [found, is_new] = read_.try_emplace(job.id);
  Series& series = found->second;
  if (!is_new) return series;
  const pipeline::RunFolder run{folder_of_(job)};
  const auto evaluation = evaluation::read_evaluation(run.evaluation());
  if (!evaluation.comparison || evaluation.comparison->stamps.empty()) return series;
  const auto& comparison = *evaluation.comparison;
  const auto relation = evaluation::Relation::kTranslation;
  if (const auto* ape = evaluation::find_ape(comparison, relation); is_ape_ && ape != nullptr) {
    for (std::size_t k = 0; k < ape->values.size(); ++k) {
      series[comparison.stamps[k].nanoseconds] = ape->values[k];
    }
  }
  if (const auto* rpe = evaluation::find_rpe(comparison, relation, 10); is_rpe_ && rpe != nullptr) {
    for (std::size_t k = 0; k < rpe->values.size(); ++k) {
      series[comparison.stamps[rpe->pairs[k].to].nanoseconds] = rpe->values[k];
    }
  }
  return series;
}

std::optional<double> RunSeries::half_of_difference(const Job& first, const Job& second) {
  const Series& of_first = of(first);
  const Series& of_second = of(second);
  std::vector<double> a;
  std::vector<double> b;
  for (const auto& [moment, value] : of_first) {
    const auto found = of_second.find(moment);
    if (found == of_second.end()) continue;
    a.push_back(value);
    b.push_back(found->second);
  }
  const auto difference = evaluation::bootstrap_difference(a, b, figure_);
  if (!difference) return std::nullopt;
  return (difference->interval.high - difference->interval.low) / 2;
}

}  // namespace traverse::batch
