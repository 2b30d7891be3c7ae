#include "results/report.hpp"

#include <algorithm>
#include <kainjow/mustache.hpp>
#include <map>
#include <tuple>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "traverse/batch/batch_folder.hpp"
#include "traverse/batch/metric.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/files/text_file.hpp"
#include "traverse/pipeline/provenance.hpp"

#include "results/report_data.hpp"

namespace traverse::batch {

namespace {

using TemplateData = kainjow::mustache::data;

constexpr std::size_t kMostListedRuns = 200;

std::string plural(std::size_t count, const std::string& noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

/// Three significant digits, plainly where a person would.
std::string number_text(double value) {
  std::string text = fmt::format("{:.3g}", value);
  if (text.starts_with('-')) text = "\u2212" + text.substr(1);
  return text;
}

std::string in_uri(const std::string& text) {
  std::string uri;
  for (const char c : text) {
    const bool plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
    uri += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return uri;
}

struct Counts {
  std::size_t ok = 0;
  std::size_t finished = 0;
  std::size_t over_budget = 0;
  double run_seconds = 0;
};

Counts count(const ReportData& data) {
  Counts counts;
  for (const Job& job : data.results.jobs()) {
    const Completion* completion = data.results.find(job);
    if (completion == nullptr) continue;
    ++counts.finished;
    if (completion->outcome == Outcome::kOk) ++counts.ok;
    if (!broken_budgets(*completion, data.plan.budgets).empty()) ++counts.over_budget;
    counts.run_seconds += completion->wall_s;
  }
  return counts;
}

/// The best variant in words: "floam solver.huber_m=0.1 leads with 0.041 m APE".
std::string leader(const ReportData& data) {
  const Metric& metric = *find_metric(data.plan.metrics.front());
  if (data.variants.empty()) return "";
  const auto mean = data.variants.front().means.find(metric.key);
  if (mean == data.variants.front().means.end()) return "";
  return fmt::format("; {} leads with {}{} {}", data.variants.front().variant,
                     number_text(mean->second), metric.unit.empty() ? "" : " " + metric.unit,
                     metric.title);
}

std::string verdict(const ReportData& data, const Counts& counts) {
  std::string text =
      fmt::format("{} of {} ok", counts.ok, plural(data.results.jobs().size(), "run"));
  text += leader(data);
  if (counts.over_budget > 0) text += fmt::format("; {} over budget", counts.over_budget);
  return text + ".";
}

void add_headline(TemplateData& list, const std::string& label, const std::string& value,
                  const std::string& unit, const std::string& how) {
  TemplateData entry;
  entry.set("label", label);
  entry.set("value", value);
  entry.set("unit", unit);
  entry.set("how", how);
  list.push_back(entry);
}

TemplateData headlines(const ReportData& data, const Counts& counts) {
  TemplateData list{TemplateData::type::list};
  add_headline(list, "Runs ok", std::to_string(counts.ok),
               fmt::format("of {}", data.results.jobs().size()),
               counts.finished < data.results.jobs().size()
                   ? fmt::format("{} not made yet", data.results.jobs().size() - counts.finished)
                   : "all made");
  add_headline(list, "Recordings", std::to_string(data.plan.recordings.size()), "", "of the plan");
  add_headline(
      list, "Pipelines", std::to_string(data.variants.size()), "",
      fmt::format("at every point of the grid, {} of the plan", data.plan.pipelines.size()));
  add_headline(list, "Work", number_text(counts.run_seconds / 60), "min",
               "wall time of all runs together");
  return list;
}

void add_notice(TemplateData& list, const std::string& kind, const std::string& word,
                const std::string& text) {
  TemplateData entry;
  entry.set("kind", kind);
  entry.set("word", word + ":");
  entry.set("text", text);
  list.push_back(entry);
}

void add_baseline_notice(const BaselineComparison& baseline, TemplateData& list) {
  std::map<Verdict, std::size_t> verdicts;
  for (const OkChange& change : baseline.ok) ++verdicts[change.verdict];
  for (const Change& change : baseline.changes) ++verdicts[change.verdict];
  const std::size_t regressed = verdicts[Verdict::kRegressed];
  std::string text =
      fmt::format("{} improved, {} without change, {} regressed.", verdicts[Verdict::kImproved],
                  verdicts[Verdict::kNoChange], regressed);
  if (baseline.unmatched > 0) {
    text += fmt::format(" {} not in the baseline.", plural(baseline.unmatched, "run"));
  }
  add_notice(list, regressed > 0 ? "fail" : "good", "Against the baseline", text);
}

TemplateData notices(const ReportData& data, const Counts& counts) {
  TemplateData list{TemplateData::type::list};
  const std::size_t rows = data.results.jobs().size();
  if (counts.finished < rows) {
    add_notice(list, "warn", "Unfinished",
               fmt::format("{} of {} are not made; this is what is there.", rows - counts.finished,
                           plural(rows, "run")));
  }
  if (counts.finished > counts.ok) {
    std::vector<std::string> parts;
    for (const auto& [outcome, number] : count_outcomes(data.results)) {
      if (outcome != Outcome::kOk) parts.push_back(fmt::format("{} {}", number, name_of(outcome)));
    }
    add_notice(list, "fail", "Not ok", fmt::format("{}.", fmt::join(parts, ", ")));
  }
  if (!data.plan.budgets.empty()) {
    std::vector<std::string> parts;
    for (const Budget& budget : data.plan.budgets) {
      parts.push_back(fmt::format("{} at most {}", budget.metric, number_text(budget.most)));
    }
    add_notice(list, counts.over_budget > 0 ? "fail" : "good",
               counts.over_budget > 0 ? "Fail" : "Pass",
               fmt::format("{} over budget ({}).", plural(counts.over_budget, "run"),
                           fmt::join(parts, ", ")));
  }
  if (data.baseline) add_baseline_notice(*data.baseline, list);
  const RepeatCheck repeats = check_repeats(data.results);
  if (repeats.different > 0) {
    add_notice(list, "warn", "Repeats differ",
               fmt::format("{} of {} gave other trajectories when repeated.", repeats.different,
                           plural(repeats.groups, "combination")));
  } else if (repeats.groups > 0) {
    add_notice(list, "good", "Repeats",
               fmt::format("all {} gave the same trajectory, bit for bit, on every repeat.",
                           plural(repeats.groups, "combination")));
  }
  return list;
}

/// Runs that ended the same way for the same reason.
TemplateData failures(const ReportData& data) {
  std::map<std::tuple<Outcome, std::string>, std::vector<const Job*>> groups;
  for (const Job& job : data.results.jobs()) {
    const Completion* completion = data.results.find(job);
    if (completion == nullptr || completion->outcome == Outcome::kOk) continue;
    groups[{completion->outcome, completion->reason}].push_back(&job);
  }
  TemplateData list{TemplateData::type::list};
  for (const auto& [group, jobs] : groups) {
    TemplateData runs{TemplateData::type::list};
    const std::size_t listed = std::min(jobs.size(), kMostListedRuns);
    for (std::size_t i = 0; i < listed; ++i) {
      TemplateData run;
      run.set("folder", "runs/" + BatchFolder::run_name(jobs[i]->id));
      run.set("title", jobs[i]->title());
      run.set("separator", i + 1 < listed ? "; "
                           : listed < jobs.size()
                               ? fmt::format(" and {} more", jobs.size() - listed)
                               : "");
      runs.push_back(run);
    }
    TemplateData entry;
    entry.set("outcome", std::string(name_of(std::get<0>(group))));
    entry.set("reason", std::get<1>(group));
    entry.set("count", plural(jobs.size(), "run"));
    entry.set("runs", runs);
    entry.set("last_lines",
              fmt::format("{}", fmt::join(data.results.find(*jobs.front())->last_lines, "\n")));
    list.push_back(entry);
  }
  return list;
}

TemplateData made(const ReportData& data) {
  const pipeline::BuildInfo build = pipeline::build_info();
  const pipeline::HostInfo host = pipeline::host_info();
  TemplateData list{TemplateData::type::list};
  const auto add = [&](const std::string& name, const std::string& value) {
    TemplateData entry;
    entry.set("name", name);
    entry.set("value", value);
    list.push_back(entry);
  };
  const RunLimits& limits = data.plan.limits;
  add("Plan", data.plan.file.string());
  add("Runs", describe(data.plan));
  add("Limits of a run", fmt::format("{:g} s, {}, {}", limits.time_s,
                                     limits.memory_mb > 0 ? fmt::format("{:g} MB", limits.memory_mb)
                                                          : "no memory limit",
                                     plural(static_cast<std::size_t>(limits.threads), "thread")));
  add("Program", fmt::format("Traverse {} at {}, {}, {}", build.version, build.commit,
                             build.build_type, build.compiler));
  add("Report made on",
      fmt::format("{}, {}, {} logical CPUs", host.name, host.cpu, host.logical_cpus));
  return list;
}

std::string read_all(const std::filesystem::path& folder, const std::vector<const char*>& names) {
  std::string text;
  for (const char* name : names) text += files::read_text(folder / name);
  return text;
}

}  // namespace

std::string batch_page(const ReportData& data, const std::filesystem::path& templates) {
  const Counts counts = count(data);
  TemplateData page;
  page.set("program_version", pipeline::build_info().version);
  page.set("name", data.plan.file.stem().string());
  page.set("date", pipeline::utc_now().substr(0, 10));
  page.set("style", read_all(templates, {"run.css", "batch.css"}));
  page.set("script", read_all(templates, {"csv.js", "batch_tables.js", "batch_charts.js"}));
  page.set("verdict", verdict(data, counts));
  if (data.plan.description.empty()) {
    page.set("description", false);
  } else {
    page.set("description", data.plan.description);
  }
  page.set("headlines", headlines(data, counts));
  page.set("notices", notices(data, counts));
  page.set("rank_title", find_metric(data.plan.metrics.front())->title);
  page.set("latex_uri",
           "data:application/x-tex," + in_uri(leaderboard_latex(data.variants, data.plan.metrics)));
  page.set("has_baseline", data.baseline.has_value());
  if (data.baseline) {
    page.set("baseline_source", data.baseline->source);
    page.set("baseline_rule", kBaselineRule);
  }
  page.set("has_grid", std::any_of(data.variants.begin(), data.variants.end(),
                                   [](const auto& variant) { return !variant.settings.empty(); }));
  page.set("has_failures", counts.finished > counts.ok);
  page.set("failures", failures(data));
  page.set("made", made(data));
  page.set("plan", data.plan.text);
  page.set("command", fmt::format("{}", fmt::join(data.command, " ")));
  page.set("data", report_data_json(data));

  const std::filesystem::path file = templates / "batch.html";
  kainjow::mustache::mustache page_template(files::read_text(file));
  if (!page_template.is_valid()) {
    throw files::InputError(file, files::Place::whole_file(), "a valid template",
                            page_template.error_message());
  }
  return page_template.render(page);
}

}  // namespace traverse::batch
