#include "results/report.hpp"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "traverse/batch/batch_folder.hpp"
#include "traverse/batch/metric.hpp"
#include "traverse/files/number_text.hpp"
#include "traverse/page/html_page.hpp"
#include "traverse/page/table.hpp"
#include "traverse/pipeline/privacy.hpp"
#include "traverse/pipeline/provenance.hpp"

#include "results/ranking.hpp"
#include "results/report_data.hpp"

namespace traverse::batch {

namespace {

using files::plural;
using files::short_number;
using page::Data;

constexpr std::size_t kMostListedRuns = 200;

struct Counts {
  std::size_t ok = 0;
  std::size_t degraded = 0;
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
    if (completion->outcome == Outcome::kDegraded) ++counts.degraded;
    if (!broken_budgets(*completion, data.plan.budgets).empty()) ++counts.over_budget;
    counts.run_seconds += completion->wall_s;
  }
  return counts;
}

std::string verdict(const ReportData& data, const Counts& counts) {
  std::string text =
      fmt::format("{} of {} ok", counts.ok, plural(data.results.jobs().size(), "run"));
  if (counts.degraded > 0) text += fmt::format(", {} degraded", counts.degraded);
  const bool has_lead =
      !data.leads.empty() && data.leads.front().metric == data.plan.metrics.front();
  if (has_lead) text += "; " + to_text(data.leads.front());
  if (counts.over_budget > 0) text += fmt::format("; {} over budget", counts.over_budget);
  return text + ".";
}

void add_headline(Data& list, const std::string& label, const std::string& value,
                  const std::string& unit, const std::string& how) {
  Data entry;
  entry.set("label", label);
  entry.set("value", value);
  entry.set("unit", unit);
  entry.set("how", how);
  list.push_back(entry);
}

Data headlines(const ReportData& data, const Counts& counts) {
  Data list = Data::list();
  add_headline(list, "Runs ok", std::to_string(counts.ok),
               fmt::format("of {}", data.results.jobs().size()),
               counts.finished < data.results.jobs().size()
                   ? fmt::format("{} not made yet", data.results.jobs().size() - counts.finished)
                   : "all made");
  add_headline(list, "Recordings", std::to_string(data.plan.recordings.size()), "",
               data.is_of_a_batch() ? "of the plan" : "told apart by their digests");
  add_headline(list, "Pipelines", std::to_string(data.variants.size()), "",
               data.is_of_a_batch() ? fmt::format("at every point of the grid, {} of the plan",
                                                  data.plan.pipelines.size())
                                    : std::string("with other settings counted anew"));
  if (!data.is_of_a_batch()) return list;
  add_headline(list, "Work", short_number(counts.run_seconds / 60), "min",
               "wall time of all runs together");
  return list;
}

void add_notice(Data& list, const std::string& kind, const std::string& word,
                const std::string& text) {
  Data entry;
  entry.set("kind", kind);
  entry.set("word", word + ":");
  entry.set("text", text);
  list.push_back(entry);
}

void add_baseline_notice(const BaselineComparison& baseline, Data& list) {
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

/// ": drive, floam: APE 0.31 to 0.36 m"
std::string spread_words(const RepeatCheck& repeats, const std::string& metric) {
  constexpr std::size_t kMostNamed = 5;
  const Metric* shown = find_metric(metric);
  std::string text;
  for (std::size_t i = 0; i < std::min(kMostNamed, repeats.spreads.size()); ++i) {
    const RepeatCheck::Spread& spread = repeats.spreads[i];
    text += fmt::format("{} {}: {} {} to {} {}", i == 0 ? ":" : ";", spread.title, shown->title,
                        short_number(spread.least), short_number(spread.most), shown->unit);
  }
  if (repeats.spreads.size() > kMostNamed) {
    text += fmt::format("; and {} more", repeats.spreads.size() - kMostNamed);
  }
  return text;
}

Data notices(const ReportData& data, const Counts& counts) {
  Data list = Data::list();
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
    const bool all_usable = counts.finished == counts.ok + counts.degraded;
    add_notice(list, all_usable ? "warn" : "fail", "Not ok",
               fmt::format("{}.", fmt::join(parts, ", ")));
  }
  if (!data.plan.budgets.empty()) {
    std::vector<std::string> parts;
    for (const Budget& budget : data.plan.budgets) {
      parts.push_back(
          fmt::format("{} {} {}", budget.metric, limit_words(budget), short_number(budget.most)));
    }
    add_notice(list, counts.over_budget > 0 ? "fail" : "good",
               counts.over_budget > 0 ? "Fail" : "Pass",
               fmt::format("{} over budget ({}).", plural(counts.over_budget, "run"),
                           fmt::join(parts, ", ")));
  }
  if (data.baseline) add_baseline_notice(*data.baseline, list);
  const std::string& rank_by = data.plan.metrics.front();
  const RepeatCheck repeats = check_repeats(data.results, rank_by);
  if (repeats.different > 0) {
    add_notice(list, "warn", "Repeats differ",
               fmt::format("{} of {} gave other trajectories when repeated{}.", repeats.different,
                           plural(repeats.groups, "combination"), spread_words(repeats, rank_by)));
  } else if (repeats.groups > 0) {
    add_notice(list, "good", "Repeats",
               fmt::format("all {} gave the same trajectory, bit for bit, on every repeat.",
                           plural(repeats.groups, "combination")));
  }
  return list;
}

/// Runs that ended the same way for the same reason.
Data failures(const ReportData& data) {
  std::map<std::tuple<Outcome, std::string>, std::vector<const Job*>> groups;
  for (const Job& job : data.results.jobs()) {
    const Completion* completion = data.results.find(job);
    if (completion == nullptr || completion->outcome == Outcome::kOk) continue;
    groups[{completion->outcome, completion->reason}].push_back(&job);
  }
  Data list = Data::list();
  for (const auto& [group, jobs] : groups) {
    Data runs = Data::list();
    const std::size_t listed = std::min(jobs.size(), kMostListedRuns);
    for (std::size_t i = 0; i < listed; ++i) {
      Data run;
      const std::string link = data.link(*jobs[i]);
      run.set("link", link.empty()
                          ? Data(false)
                          : Data(link + (data.is_of_a_batch()                      ? "/log.txt"
                                         : data.results.find(*jobs[i])->has_report ? "/report.html"
                                                                                   : "/run.json")));
      run.set("title", jobs[i]->title());
      run.set("separator", i + 1 < listed ? "; "
                           : listed < jobs.size()
                               ? fmt::format(" and {} more", jobs.size() - listed)
                               : "");
      runs.push_back(run);
    }
    Data entry;
    entry.set("outcome", std::string(name_of(std::get<0>(group))));
    entry.set("reason", std::get<1>(group));
    entry.set("count", plural(jobs.size(), "run"));
    entry.set("runs", runs);
    const auto& last_lines = data.results.find(*jobs.front())->last_lines;
    entry.set("last_lines", last_lines.empty()
                                ? Data(false)
                                : Data(fmt::format("{}", fmt::join(last_lines, "\n"))));
    list.push_back(entry);
  }
  return list;
}

void add_plan(const ReportData& data, page::Table& table) {
  const RunLimits& limits = data.plan.limits;
  table.add_row({"plan", data.plan.is_private ? data.plan.file.filename().string()
                                              : data.plan.file.string()});
  table.add_row({"runs", describe(data.plan)});
  table.add_row({"limits of a run",
                 fmt::format("{:g} s, {}, {}", limits.time_s,
                             limits.memory_mb > 0 ? fmt::format("{:g} MB", limits.memory_mb)
                                                  : "no memory limit",
                             plural(static_cast<std::size_t>(limits.threads), "thread"))});
}

page::Table made(const ReportData& data) {
  const pipeline::BuildInfo build = pipeline::build_info();
  page::Table table("made", "How this was made", {"what", "value"});
  if (data.is_of_a_batch()) {
    add_plan(data, table);
  } else {
    table.add_row({"runs", plural(data.results.jobs().size(), "run")});
  }
  table.add_row({"program", fmt::format("Traverse {}, commit {}, {}, {}", build.version,
                                        build.commit, build.build_type, build.compiler)});
  if (!data.plan.is_private) {
    const pipeline::HostInfo host = pipeline::host_info();
    table.add_row({"report made on",
                   fmt::format("{}: {}, {} logical CPUs", host.name, host.cpu, host.logical_cpus)});
  }
  return table;
}

/// The tables that the plan asks for, on the page one heading lower than in their document.
Data planned_tables(const ReportData& data) {
  Data list = Data::list();
  for (const ShownTable& shown : data.tables) {
    Data entry;
    entry.set("above", shown.level == 2 && !shown.heading.empty());
    entry.set("below", shown.level == 3 && !shown.heading.empty());
    entry.set("heading", shown.heading);
    entry.set("text", shown.text.empty() ? Data(false) : Data(shown.text));
    entry.set("table_planned", shown.table ? shown.table->data() : Data(false));
    list.push_back(std::move(entry));
  }
  return list;
}

std::vector<page::Section> sections(const ReportData& data, const Counts& counts) {
  const bool has_grid = std::any_of(data.variants.begin(), data.variants.end(),
                                    [](const auto& variant) { return !variant.settings.empty(); });
  std::vector<page::Section> sections{{"verdict", "Verdict"}, {"leaderboard", "Leaderboard"}};
  if (data.variants.size() > 1) sections.push_back({"ranking", "Ranking"});
  if (!data.tables.empty()) sections.push_back({"tables", "Tables"});
  if (data.baseline) sections.push_back({"baseline", "Against the baseline"});
  sections.push_back({"recordings", "Recordings and pipelines"});
  sections.push_back({"distribution", "Distribution"});
  if (has_grid && data.is_of_a_batch()) sections.push_back({"sweep", "Parameter sweep"});
  if (counts.finished > counts.ok) sections.push_back({"failures", "Runs that are not ok"});
  sections.push_back({"runs", "Runs"});
  sections.push_back({"provenance", "Provenance"});
  return sections;
}

}  // namespace

std::string ReportData::link(const Job& job) const {
  return link_of ? link_of(job) : "runs/" + BatchFolder::run_name(job.id);
}

std::string batch_page(const ReportData& data, const std::filesystem::path& templates) {
  const Counts counts = count(data);
  const auto ranking = rank_variants(data.results, data.plan.metrics.front(), data.folder_of);
  const pipeline::Privacy privacy(data.plan.file.parent_path());
  const auto told = [&](const std::string& text) {
    return data.plan.is_private ? privacy.text(text) : text;
  };
  const std::string name = data.plan.file.stem().string();
  Data parts;
  parts.set("name", name);
  parts.set("date", pipeline::utc_now().substr(0, 10));
  parts.set("verdict", verdict(data, counts));
  parts.set("description",
            data.plan.description.empty() ? Data(false) : Data(data.plan.description));
  parts.set("headlines", headlines(data, counts));
  parts.set("notices", notices(data, counts));
  parts.set("rank_title", find_metric(data.plan.metrics.front())->title);
  const page::Table leads = leads_table(data.leads);
  parts.set("table_leads", leads.empty() ? Data(false) : leads.data());
  parts.set("table_ranking", ranking ? ranking_table(*ranking).data() : Data(false));
  parts.set("table_fairness",
            (data.fairness ? *data.fairness : fairness_table(data.plan, data.results)).data());
  parts.set("kind", data.is_of_a_batch() ? "batch" : "comparison");
  parts.set("is_of_a_batch", data.is_of_a_batch());
  parts.set("limits",
            data.is_of_a_batch()
                ? fmt::format("Each run had {} and at most {:g} s.",
                              plural(static_cast<std::size_t>(data.plan.limits.threads), "thread"),
                              data.plan.limits.time_s)
                : std::string("Threads, machine and what is known of times stand below."));
  if (data.baseline) {
    parts.set("baseline_source", told(data.baseline->source));
    parts.set("baseline_rule", kBaselineRule);
  }
  parts.set("tables", planned_tables(data));
  parts.set("failures", failures(data));
  parts.set("table_made", made(data).data());
  parts.set("plan", data.plan.text.empty() ? Data(false) : Data(told(data.plan.text)));
  parts.set("command", told(fmt::format("{}", fmt::join(data.command, " "))));

  page::HtmlPage page;
  page.kind = "batch";
  page.title = name + (data.is_of_a_batch() ? " · batch" : " · comparison");
  page.program_version = pipeline::build_info().version;
  page.sections = sections(data, counts);
  page.report_json = page::text_for_script(report_data_json(data, ranking));
  page.scripts = {"dygraphs", "plot", "tables", "batch_tables", "batch_charts"};
  page.styles = {"batch"};
  return page::render(page, std::move(parts), templates);
}

}  // namespace traverse::batch
