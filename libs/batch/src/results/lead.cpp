#include "results/lead.hpp"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "traverse/batch/metric.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/files/number_text.hpp"

namespace traverse::batch {

namespace {

constexpr double kLeadConfidence = 0.95;
constexpr double kNormalQuantile = 1.959963984540054;  // of 0.975
constexpr std::size_t kEnoughRecordings = 3;           // for Student's t to say anything

/// By recording: the mean of the metric over the repeats, and the first run that has it.
struct OfRecording {
  double sum = 0;
  double count = 0;
  const Job* job = nullptr;
  double mean() const { return sum / count; }
};

std::map<std::string, OfRecording> by_recording(const Results& results, const std::string& variant,
                                                const std::string& metric) {
  std::map<std::string, OfRecording> recordings;
  for (const Job& job : results.jobs()) {
    const Completion* completion = results.find(job);
    if (job.variant() != variant || completion == nullptr || !is_usable(completion->outcome)) {
      continue;
    }
    const auto value = value_of(*completion, metric);
    if (!value) continue;
    OfRecording& of = recordings[job.recording];
    of.sum += *value;
    ++of.count;
    if (of.job == nullptr) of.job = &job;
  }
  return recordings;
}

std::optional<std::pair<double, double>> interval_over_recordings(
    const std::vector<double>& differences) {
  const auto n = static_cast<double>(differences.size());
  double mean = 0;
  for (const double difference : differences) mean += difference / n;
  double squares = 0;
  for (const double difference : differences) squares += std::pow(difference - mean, 2);
  const boost::math::students_t distribution(n - 1);
  const double half = std::sqrt(squares / (n - 1) / n) *
                      boost::math::quantile(distribution, 0.5 + kLeadConfidence / 2);
  return std::pair(mean - half, mean + half);
}

std::string with_unit(double value, const Metric& metric) {
  return fmt::format("{:.3g}{}{}", value, metric.unit.empty() ? "" : " ", metric.unit);
}

}  // namespace

std::optional<Lead> find_lead(const std::string& metric, const Results& results,
                              const std::vector<VariantSummary>& variants,
                              const RunFolderOf& folder_of) {
  std::vector<const VariantSummary*> with_metric;
  for (const VariantSummary& variant : variants) {
    if (variant.means.contains(metric)) with_metric.push_back(&variant);
  }
  if (with_metric.empty() || with_metric.front() != &variants.front()) return std::nullopt;
  // That more of its runs are degraded makes a variant stand lower, and its figure no worse.
  const auto as_usable = std::find_if(with_metric.begin(), with_metric.end(), [&](const auto* v) {
    return v->ok < with_metric.front()->ok;
  });
  if (find_metric(metric)->lower_is_better) {
    std::stable_sort(with_metric.begin(), as_usable, [&](const auto* a, const auto* b) {
      return a->means.at(metric) < b->means.at(metric);
    });
  }
  Lead lead;
  lead.metric = metric;
  lead.first = with_metric[0]->variant;
  lead.mean = with_metric[0]->means.at(metric);
  if (with_metric.size() < 2) return lead;
  lead.second = with_metric[1]->variant;
  lead.has_more_ok = with_metric[0]->ok > with_metric[1]->ok;
  const auto first = by_recording(results, lead.first, metric);
  const auto second = by_recording(results, lead.second, metric);
  RunSeries series(metric, folder_of);
  std::vector<double> differences;
  double variance = 0;  // of the mean of the differences, by the drives alone
  bool has_variance = series.is_known();
  for (const auto& [recording, of_first] : first) {
    const auto of_second = second.find(recording);
    if (of_second != second.end()) {
      differences.push_back(of_second->second.mean() - of_first.mean());
      ++lead.recordings;
      if (differences.back() > 0) ++lead.better_on;
    }
  }
  if (differences.empty()) {  // of other recordings: nothing is more or less
    lead.second.clear();
    lead.has_more_ok = false;
    return lead;
  }
  const auto n = static_cast<double>(differences.size());
  for (const double difference : differences) lead.difference += difference / n;
  if (differences.size() >= kEnoughRecordings) {
    lead.interval = interval_over_recordings(differences);
    return lead;
  }
  for (const auto& [recording, of_first] : first) {
    const auto of_second = second.find(recording);
    if (!has_variance || of_second == second.end()) continue;
    try {
      const auto half = series.half_of_difference(*of_first.job, *of_second->second.job);
      has_variance = half.has_value();
      if (half) variance += std::pow(*half / kNormalQuantile / n, 2);
    } catch (const files::InputError&) {
      has_variance = false;  // a run folder that somebody has tidied up
    }
  }
  if (has_variance) {
    const double half = kNormalQuantile * std::sqrt(variance);
    lead.interval = std::pair(lead.difference - half, lead.difference + half);
  }
  return lead;
}

std::string to_text(const Lead& lead) {
  const Metric& metric = *find_metric(lead.metric);
  const std::string value = fmt::format("{} {}", with_unit(lead.mean, metric), metric.title);
  if (lead.second.empty()) return fmt::format("{} has {}", lead.first, value);
  const std::string differs =
      lead.interval
          ? fmt::format("{} {} more, 95 % {:.2g} to {:.2g}", lead.second,
                        with_unit(lead.difference, metric), lead.interval->first,
                        lead.interval->second)
          : fmt::format("{} {} more, no interval", lead.second, with_unit(lead.difference, metric));
  if (lead.has_more_ok) {
    return fmt::format("{} leads by more runs that are ok, with {}", lead.first, value);
  }
  if (lead.is_sure()) return fmt::format("{} leads with {} ({})", lead.first, value, differs);
  return fmt::format("{} and {} are tied at {} ({})", lead.first, lead.second, value, differs);
}

page::Table leads_table(const std::vector<Lead>& leads) {
  page::Table table("leads", "The best by each metric",
                    {"metric", "best", "mean", "next", "more by", "95 %", "better on"});
  for (const Lead& lead : leads) {
    const Metric& metric = *find_metric(lead.metric);
    if (!metric.lower_is_better || lead.second.empty()) continue;
    const std::string interval =
        lead.interval ? fmt::format("{:.2g} to {:.2g}", lead.interval->first, lead.interval->second)
                      : "no interval";
    const std::string on =
        fmt::format("{} of {}", lead.better_on, files::plural(lead.recordings, "recording"));
    table.add_row(
        {metric.unit.empty() ? metric.title : fmt::format("{} [{}]", metric.title, metric.unit),
         lead.is_sure() ? lead.first : lead.first + ", tied", lead.mean, lead.second,
         lead.difference, interval, on});
  }
  return table;
}

}  // namespace traverse::batch
