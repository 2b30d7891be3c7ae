#include "traverse/batch/results.hpp"

#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "traverse/batch/metric.hpp"
#include "traverse/files/atomic_file.hpp"
#include "traverse/files/csv.hpp"
#include "traverse/files/numbers.hpp"

namespace traverse::batch {

namespace {

using Json = nlohmann::ordered_json;

/// The metrics that any run has, in their fixed order.
std::vector<std::string> present_metrics(const Results& results) {
  std::set<std::string_view> seen;
  for (const Job& job : results.jobs()) {
    const Completion* completion = results.find(job);
    if (completion == nullptr) continue;
    for (const auto& [name, value] : completion->metrics) seen.insert(name);
  }
  std::vector<std::string> ordered;
  for (const Metric& metric : known_metrics()) {
    if (seen.contains(metric.key)) ordered.push_back(metric.key);
  }
  return ordered;
}

}  // namespace

void Results::load(const BatchFolder& folder, const std::function<bool(const Completion&)>& again) {
  for (const Job& job : distinct(jobs_)) {
    auto completion = find_completion(folder.completion(job.id));
    // The id too: folders are named by its beginning.
    if (!completion || completion->id != job.id) continue;
    if (is_outdated(*completion, job) || again(*completion)) continue;
    completions_[job.id] = std::move(*completion);
  }
}

const Completion* Results::find(const Job& job) const {
  const auto found = completions_.find(job.id);
  return found == completions_.end() ? nullptr : &found->second;
}

std::vector<Job> Results::pending() const {
  std::vector<Job> pending;
  for (const Job& job : distinct(jobs_)) {
    if (find(job) == nullptr) pending.push_back(job);
  }
  return pending;
}

std::optional<double> value_of(const Completion& completion, const std::string& metric) {
  for (const auto& [name, value] : completion.metrics) {
    if (name == metric) return value;
  }
  return std::nullopt;
}

std::map<Outcome, std::size_t> count_outcomes(const Results& results) {
  std::map<Outcome, std::size_t> counts;
  for (const Job& job : results.jobs()) {
    if (const Completion* completion = results.find(job)) ++counts[completion->outcome];
  }
  return counts;
}

std::string_view limit_words(const Budget& budget) {
  const Metric* metric = find_metric(budget.metric);
  return metric != nullptr && metric->higher_is_better ? "at least" : "at most";
}

std::vector<std::string> broken_budgets(const Completion& completion,
                                        const std::vector<Budget>& budgets) {
  std::vector<std::string> broken;
  for (const Budget& budget : budgets) {
    const auto value = value_of(completion, budget.metric);
    const Metric* metric = find_metric(budget.metric);
    const bool is_least = metric != nullptr && metric->higher_is_better;
    if (value && (is_least ? *value < budget.most : *value > budget.most)) {
      broken.push_back(budget.metric);
    }
  }
  return broken;
}

void write_csv(const std::filesystem::path& file, const Results& results) {
  const std::vector<std::string> metrics = present_metrics(results);
  std::string text = "recording,pipeline,settings,repeat,outcome,reason,id,trajectory_sha256";
  for (const std::string& metric : metrics) text += "," + metric;
  text += ",attempts,host,started_utc\n";
  for (const Job& job : results.jobs()) {
    const Completion* completion = results.find(job);
    if (completion == nullptr) continue;
    text += fmt::format(
        "{},{},{},{},{},{},{},{}", files::csv_cell(job.recording), files::csv_cell(job.pipeline),
        files::csv_cell(fmt::format("{}", fmt::join(job.settings, "; "))), job.repeat,
        name_of(completion->outcome), files::csv_cell(completion->reason), files::csv_cell(job.id),
        files::csv_cell(completion->trajectory_sha256));
    const std::map<std::string_view, double> values(completion->metrics.begin(),
                                                    completion->metrics.end());
    for (const std::string& metric : metrics) {
      const auto value = values.find(metric);
      text += "," + (value == values.end() ? "" : files::to_text(value->second));
    }
    text += fmt::format(",{},{},{}\n", completion->attempts, files::csv_cell(completion->host),
                        files::csv_cell(completion->started_utc));
  }
  files::write_text(file, text);
}

void write_json(const std::filesystem::path& file, const Plan& plan, const Results& results) {
  Json runs = Json::array();
  for (const Job& job : results.jobs()) {
    const Completion* completion = results.find(job);
    Json run{{"recording", job.recording}, {"pipeline", job.pipeline}, {"settings", job.settings},
             {"variant", job.variant()},   {"repeat", job.repeat},     {"id", job.id}};
    if (completion == nullptr) {
      run["outcome"] = nullptr;
      runs.push_back(std::move(run));
      continue;
    }
    Json metrics = Json::object();
    for (const auto& [name, value] : completion->metrics) metrics[name] = value;
    run["outcome"] = name_of(completion->outcome);
    run["reason"] = completion->reason;
    run["folder"] = "runs/" + BatchFolder::run_name(job.id);
    run["trajectory_sha256"] = completion->trajectory_sha256;
    run["metrics"] = std::move(metrics);
    run["broken_budgets"] = broken_budgets(*completion, plan.budgets);
    run["attempts"] = completion->attempts;
    run["host"] = completion->host;
    run["started_utc"] = completion->started_utc;
    run["last_lines"] = completion->last_lines;
    runs.push_back(std::move(run));
  }
  const Json json{
      {"description", plan.description}, {"metrics", plan.metrics}, {"runs", std::move(runs)}};
  files::write_text(file, json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace traverse::batch
