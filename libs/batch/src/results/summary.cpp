#include "results/summary.hpp"

#include <algorithm>
#include <limits>
#include <set>
#include <utility>

namespace traverse::batch {

namespace {

/// A running mean.
struct Mean {
  double sum = 0;
  double weight = 0;
  void add(double value, double with_weight = 1) {
    sum += value * with_weight;
    weight += with_weight;
  }
  double value() const { return sum / weight; }
};

/// What is gathered of a variant before it is averaged.
struct Gathered {
  VariantSummary summary;
  std::map<std::string, std::map<std::string, Mean>> by_metric;  ///< metric, recording
  Mean translation_segments;
  Mean rotation_segments;
};

void gather(const Job& job, const Completion& completion, Gathered& gathered) {
  for (const auto& [metric, value] : completion.metrics) {
    gathered.by_metric[metric][job.recording].add(value);
  }
  const auto segments = value_of(completion, "kitti_segments");
  const auto translation = value_of(completion, "kitti_translation_percent");
  const auto rotation = value_of(completion, "kitti_rotation_deg_per_m");
  if (!segments || !translation || !rotation) return;
  gathered.translation_segments.add(*translation, *segments);
  gathered.rotation_segments.add(*rotation, *segments);
}

double mean_of_recordings(const std::map<std::string, Mean>& recordings) {
  Mean mean;
  for (const auto& [recording, repeats] : recordings) mean.add(repeats.value());
  return mean.value();
}

VariantSummary averaged(Gathered gathered) {
  VariantSummary& summary = gathered.summary;
  for (const auto& [metric, recordings] : gathered.by_metric) {
    summary.means[metric] = mean_of_recordings(recordings);
  }
  if (gathered.translation_segments.weight > 0) {
    const auto& per_recording = gathered.by_metric["kitti_translation_percent"];
    summary.kitti = {gathered.translation_segments.value(),
                     mean_of_recordings(per_recording),
                     gathered.rotation_segments.value(),
                     mean_of_recordings(gathered.by_metric["kitti_rotation_deg_per_m"]),
                     static_cast<std::size_t>(gathered.translation_segments.weight),
                     per_recording.size()};
  }
  return std::move(summary);
}

}  // namespace

std::vector<VariantSummary> summarise(const Results& results, const std::vector<Budget>& budgets,
                                      const std::string& rank_by) {
  std::map<std::string, Gathered> by_variant;
  std::vector<std::string> order;
  for (const Job& job : results.jobs()) {
    const std::string variant = job.variant();
    const auto [found, is_new] = by_variant.try_emplace(variant);
    Gathered& gathered = found->second;
    if (is_new) {
      gathered.summary = {.variant = variant, .pipeline = job.pipeline, .settings = job.settings};
      order.push_back(variant);
    }
    ++gathered.summary.runs;
    const Completion* completion = results.find(job);
    if (completion == nullptr) continue;
    ++gathered.summary.finished;
    if (!broken_budgets(*completion, budgets).empty()) ++gathered.summary.over_budget;
    if (!is_usable(completion->outcome)) continue;
    ++gathered.summary.ok;
    if (completion->outcome == Outcome::kDegraded) ++gathered.summary.degraded;
    gather(job, *completion, gathered);
  }
  std::vector<VariantSummary> variants;
  for (const std::string& variant : order) {
    variants.push_back(averaged(std::move(by_variant.at(variant))));
  }
  const auto rank = [&](const VariantSummary& variant) {
    const auto mean = variant.means.find(rank_by);
    return mean == variant.means.end() ? std::numeric_limits<double>::infinity() : mean->second;
  };
  std::stable_sort(variants.begin(), variants.end(), [&](const auto& a, const auto& b) {
    if (a.ok != b.ok) return a.ok > b.ok;
    return a.degraded != b.degraded ? a.degraded < b.degraded : rank(a) < rank(b);
  });
  return variants;
}

RepeatCheck check_repeats(const Results& results, const std::string& metric) {
  struct Repeats {
    std::vector<std::string> digests;
    std::vector<double> values;
  };
  std::map<std::pair<std::string, std::string>, Repeats> groups;
  for (const Job& job : results.jobs()) {
    const Completion* completion = results.find(job);
    if (completion == nullptr || !is_usable(completion->outcome)) continue;
    Repeats& repeats = groups[{job.recording, job.variant()}];
    repeats.digests.push_back(completion->trajectory_sha256);
    if (const auto value = value_of(*completion, metric)) repeats.values.push_back(*value);
  }
  RepeatCheck check;
  for (const auto& [group, repeats] : groups) {
    const auto& digests = repeats.digests;
    if (digests.size() < 2) continue;
    ++check.groups;
    if (std::set<std::string>(digests.begin(), digests.end()).size() == 1) continue;
    ++check.different;
    if (repeats.values.size() < 2) continue;
    const auto [least, most] = std::minmax_element(repeats.values.begin(), repeats.values.end());
    check.spreads.push_back({group.first + ", " + group.second, *least, *most});
  }
  return check;
}

}  // namespace traverse::batch
