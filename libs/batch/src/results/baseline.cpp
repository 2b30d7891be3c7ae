#include "results/baseline.hpp"

#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <numeric>

#include "traverse/batch/metric.hpp"
#include "traverse/files/json_document.hpp"

namespace traverse::batch {

namespace {

namespace fs = std::filesystem;

constexpr double kLeastChange = 0.01;
constexpr double kLeastChangeOfTimes = 0.10;
constexpr double kConfidence = 0.95;

/// Values of both batches of one recording, whose repeats are averaged.
struct Pair {
  double before = 0;
  double now = 0;
  double count = 0;
  void add(double value_before, double value_now) {
    before += value_before;
    now += value_now;
    ++count;
  }
};
/// By variant and metric, then by recording.
using Pairs = std::map<std::pair<std::string, std::string>, std::map<std::string, Pair>>;

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Half the width of the interval of the mean.
double half_interval(const std::vector<double>& values) {
  const double middle = mean(values);
  double squares = 0;
  for (const double value : values) squares += (value - middle) * (value - middle);
  const auto n = static_cast<double>(values.size());
  const double standard_error = std::sqrt(squares / (n - 1) / n);
  const boost::math::students_t distribution(n - 1);
  return standard_error * boost::math::quantile(distribution, 0.5 + kConfidence / 2);
}

std::vector<std::pair<double, double>> means(const std::map<std::string, Pair>& recordings) {
  std::vector<std::pair<double, double>> values;
  for (const auto& [recording, pair] : recordings) {
    values.emplace_back(pair.before / pair.count, pair.now / pair.count);
  }
  return values;
}

OkChange judged(OkChange change) {
  if (change.now > change.before) change.verdict = Verdict::kImproved;
  if (change.now < change.before) change.verdict = Verdict::kRegressed;
  return change;
}

}  // namespace

const char* const kBaselineRule =
    "Runs are paired by recording, pipeline and settings; repeats are averaged. A metric has "
    "improved or regressed when its mean over the recordings changed by at least 1 % (times and "
    "memory: 10 %) and, with two recordings and more, the 95 % interval of the mean difference "
    "(Student's t, paired) leaves out zero; else there is no change. With one recording there is "
    "no "
    "interval, only the size of the change.";

std::string_view name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::kImproved:
      return "improved";
    case Verdict::kNoChange:
      return "no change";
    case Verdict::kRegressed:
      return "regressed";
  }
  return "no change";
}

Change judge_change(const std::vector<std::pair<double, double>>& before_and_now,
                    bool is_measured_time) {
  std::vector<double> before;
  std::vector<double> differences;
  for (const auto& [was, is] : before_and_now) {
    before.push_back(was);
    differences.push_back(is - was);
  }
  Change change;
  change.recordings = before.size();
  change.before = mean(before);
  const double difference = mean(differences);
  change.now = change.before + difference;
  const double scale = std::abs(change.before);
  if (scale == 0) {
    change.change_percent = difference == 0 ? 0 : std::copysign(INFINITY, difference);
  } else {
    change.change_percent = 100 * difference / scale;
  }
  bool is_significant = std::abs(change.change_percent) >=
                        100 * (is_measured_time ? kLeastChangeOfTimes : kLeastChange);
  if (differences.size() > 1) {
    const double half = half_interval(differences);
    if (scale > 0) {
      change.interval_percent = {100 * (difference - half) / scale,
                                 100 * (difference + half) / scale};
    }
    is_significant = is_significant && std::abs(difference) > half;
  }
  if (is_significant) change.verdict = difference < 0 ? Verdict::kImproved : Verdict::kRegressed;
  return change;
}

Baseline::Baseline(const fs::path& baseline)
    : file_(fs::is_directory(baseline) ? baseline / "results.json" : baseline) {
  const auto document = files::JsonDocument::read(file_);
  const files::JsonValue runs = document.root()["runs"];
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const files::JsonValue run = runs[i];
    if (run["outcome"].is_null()) continue;
    Run& earlier =
        runs_[{run["recording"].text(), run["variant"].text(), run["repeat"].small_integer()}];
    earlier.ok = run["outcome"].text() == "ok" || run["outcome"].text() == "degraded";
    const files::JsonValue metrics = run["metrics"];
    for (const std::string& name : metrics.keys()) earlier.metrics[name] = metrics[name].number();
  }
}

BaselineComparison Baseline::compare(const Results& results,
                                     const std::vector<std::string>& metrics) const {
  BaselineComparison comparison;
  comparison.source = file_.string();
  Pairs pairs;
  std::map<std::string, OkChange> ok;
  std::vector<std::string> order;
  for (const Job& job : results.jobs()) {
    const Completion* completion = results.find(job);
    if (completion == nullptr) continue;
    const auto found = runs_.find({job.recording, job.variant(), job.repeat});
    if (found == runs_.end()) {
      ++comparison.unmatched;
      continue;
    }
    const Run& earlier = found->second;
    const auto [change, is_new] = ok.try_emplace(job.variant(), OkChange{.variant = job.variant()});
    if (is_new) order.push_back(job.variant());
    const bool is_ok = is_usable(completion->outcome);
    ++change->second.runs;
    change->second.before += earlier.ok ? 1 : 0;
    change->second.now += is_ok ? 1 : 0;
    if (!earlier.ok || !is_ok) continue;
    for (const std::string& metric : metrics) {
      const auto now = value_of(*completion, metric);
      const auto before = earlier.metrics.find(metric);
      if (!now || before == earlier.metrics.end()) continue;
      pairs[{job.variant(), metric}][job.recording].add(before->second, *now);
    }
  }
  for (const std::string& variant : order) {
    comparison.ok.push_back(judged(ok.at(variant)));
    for (const std::string& metric : metrics) {
      const auto found = pairs.find({variant, metric});
      const Metric* known = find_metric(metric);
      if (found == pairs.end() || known == nullptr || !known->lower_is_better) continue;
      Change change = judge_change(means(found->second), known->is_measured_time);
      change.variant = variant;
      change.metric = metric;
      comparison.changes.push_back(std::move(change));
    }
  }
  return comparison;
}

}  // namespace traverse::batch
