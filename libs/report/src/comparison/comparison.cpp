#include "comparison/comparison.hpp"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

#include "charts/paired_series.hpp"
#include "charts/series.hpp"

namespace traverse::report {

namespace {

constexpr std::size_t kStretches = 20;

std::vector<std::string> with_names(std::vector<std::string> head,
                                    const std::vector<ComparedRun>& runs) {
  for (const ComparedRun& run : runs) head.push_back(run.name);
  return head;
}

Table figures_table(const std::vector<ComparedRun>& runs) {
  Table table("figures", "Figures of each run", with_names({"figure", "unit"}, runs));
  for (const FigureKind& kind : figure_kinds()) {
    std::vector<Cell> cells{std::string(kind.label), std::string(kind.unit)};
    bool any = false;
    for (const ComparedRun& run : runs) {
      const RunFigure* figure = find_figure(run.figures, kind.id);
      any = any || figure != nullptr;
      cells.emplace_back(figure != nullptr ? figure->value : kNone);
    }
    if (any) table.add_row(std::move(cells));
  }
  std::vector<Cell> verdicts{"status", ""};
  for (const ComparedRun& run : runs) {
    verdicts.emplace_back(std::string(pipeline::name_of(run.data.health.verdict)));
  }
  table.add_row(std::move(verdicts));
  return table;
}

Table differences_table(const std::vector<ComparedRun>& runs, double threshold_percent) {
  Table table("differences", "Differences from " + runs.front().name,
              {"run", "figure", "unit", "difference", "ratio", "95 % from", "95 % to",
               "threshold ±", "moments", "verdict"});
  const ComparedRun& baseline = runs.front();
  for (std::size_t k = 1; k < runs.size(); ++k) {
    for (const SeriesFigure& item : series_figures()) {
      const RunFigure* figure = find_figure(baseline.figures, item.id);
      if (figure == nullptr) continue;
      const CommonValues common =
          common_values(series_of(baseline.data, item.id), series_of(runs[k].data, item.id));
      if (common.first.empty()) continue;
      const double before = evaluation::figure_of(common.first, item.figure);
      const double after = evaluation::figure_of(common.second, item.figure);
      const double threshold = threshold_percent / 100 * before;
      const auto paired =
          evaluation::bootstrap_difference(common.first, common.second, item.figure);
      const bool is_lost = baseline.is_lost() || runs[k].is_lost();
      const Change change = is_lost  ? Change::kLost
                            : paired ? judge(paired->interval, threshold)
                                     : Change::kUnknown;
      table.add_row({runs[k].name, figure->label, figure->unit, after - before, after / before,
                     paired ? paired->interval.low : kNone, paired ? paired->interval.high : kNone,
                     threshold, Cell::count(common.first.size()), to_text(change)},
                    change == Change::kImproved || change == Change::kRegressed);
    }
  }
  return table;
}

/// Mean error of a run on each stretch; NaN where it has none.
std::vector<double> means_by_stretch(const RunData& run, const std::vector<std::int64_t>& ends) {
  if (run.health.verdict == pipeline::Health::kLost) return std::vector(ends.size(), kNone);
  std::vector<double> sums(ends.size(), 0);
  std::vector<std::size_t> counts(ends.size(), 0);
  for (const auto& [stamp, value] : series_of(run, "rpe_10_frames_rmse_m")) {
    const auto end = std::lower_bound(ends.begin(), ends.end(), stamp);
    if (end == ends.end()) continue;
    const auto k = static_cast<std::size_t>(end - ends.begin());
    sums[k] += value;
    ++counts[k];
  }
  for (std::size_t k = 0; k < sums.size(); ++k) {
    sums[k] = counts[k] > 0 ? sums[k] / static_cast<double>(counts[k]) : kNone;
  }
  return sums;
}

/// The drive in stretches of equal length along the reference of the baseline.
struct Stretches {
  std::vector<double> from_m, to_m;
  std::vector<std::int64_t> ends;  ///< stamps
};

Stretches stretches_of(const RunData& run) {
  Stretches result;
  if (!run.evaluation.comparison || run.evaluation.comparison->stamps.empty()) return result;
  const auto& comparison = *run.evaluation.comparison;
  const auto& path_m = comparison.distances_m;
  const double each_m = path_m.back() / kStretches;
  for (std::size_t k = 0; k < kStretches; ++k) {
    const double end_m = k + 1 == kStretches ? path_m.back() : each_m * static_cast<double>(k + 1);
    const auto end = std::upper_bound(path_m.begin(), path_m.end(), end_m) - 1;
    result.from_m.push_back(each_m * static_cast<double>(k));
    result.to_m.push_back(end_m);
    result.ends.push_back(
        comparison.stamps[static_cast<std::size_t>(end - path_m.begin())].nanoseconds);
  }
  return result;
}

struct Wins {
  Table stretches;
  Table wins;
};

Wins wins_by_stretch(const std::vector<ComparedRun>& runs) {
  Wins result{Table("stretches", "RPE over 10 frames on each stretch, mean in m",
                    with_names({"from [m]", "to [m]"}, runs)),
              Table("wins", "Stretches on which each run was best", {"run", "wins", "of"})};
  const Stretches stretches = stretches_of(runs.front().data);
  std::vector<std::vector<double>> means;
  for (const ComparedRun& run : runs) means.push_back(means_by_stretch(run.data, stretches.ends));
  std::vector<std::size_t> wins(runs.size(), 0);
  std::size_t compared = 0;
  for (std::size_t k = 0; k < stretches.ends.size(); ++k) {
    std::vector<Cell> cells{stretches.from_m[k], stretches.to_m[k]};
    std::size_t best = 0;
    bool all = true;
    bool tie = false;
    for (std::size_t r = 0; r < runs.size(); ++r) {
      cells.emplace_back(means[r][k]);
      all = all && means[r][k] == means[r][k];
      if (r > 0 && means[r][k] == means[best][k]) tie = true;
      if (means[r][k] < means[best][k]) {
        best = r;
        tie = false;
      }
    }
    result.stretches.add_row(std::move(cells));
    if (!all) continue;
    ++compared;
    if (!tie) ++wins[best];
  }
  if (compared == 0) return result;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    result.wins.add_row({runs[r].name, Cell::count(wins[r]), Cell::count(compared)});
  }
  return result;
}

Table settings_table(const std::vector<ComparedRun>& runs) {
  Table table("settings", "Settings that differ", with_names({"setting"}, runs));
  std::vector<std::map<std::string, std::string>> settings;
  std::set<std::string> keys;
  for (const ComparedRun& run : runs) {
    auto& values = settings.emplace_back();
    values["pipeline"] = run.data.pipeline_name();
    const auto& threads = run.data.record.at("threads");
    values["threads"] = threads.is_null() ? "not known" : threads.dump();
    for (const auto& setting : run.data.record.at("configuration").at("settings")) {
      const auto& value = setting.at("value");
      values[setting.at("key")] = value.is_string() ? value.get<std::string>() : value.dump();
    }
    for (const auto& [key, value] : values) keys.insert(key);
  }
  for (const std::string& key : keys) {
    std::vector<Cell> cells{key};
    std::set<std::string> different;
    for (const auto& values : settings) {
      const auto found = values.find(key);
      cells.emplace_back(found == values.end() ? std::string("–") : found->second);
      different.insert(cells.back().text);
    }
    if (different.size() > 1) table.add_row(std::move(cells));
  }
  return table;
}

}  // namespace

Change judge(const evaluation::Interval& interval, double threshold) {
  if (interval.high < -threshold) return Change::kImproved;
  if (interval.low > threshold) return Change::kRegressed;
  return Change::kNoChange;
}

std::string to_text(Change change) {
  switch (change) {
    case Change::kImproved:
      return "improved";
    case Change::kNoChange:
      return "no change";
    case Change::kRegressed:
      return "regressed";
    case Change::kUnknown:
      return "too few values";
    case Change::kLost:
      return "a run is lost";
  }
  return {};
}

std::vector<Table> comparison_tables(const std::vector<ComparedRun>& runs,
                                     double threshold_percent) {
  Wins wins = wins_by_stretch(runs);
  return {figures_table(runs), differences_table(runs, threshold_percent), std::move(wins.wins),
          std::move(wins.stretches), settings_table(runs)};
}

void add_comparison_charts(const std::vector<ComparedRun>& runs, Model& model) {
  const RunData& baseline = runs.front().data;
  std::vector<std::int64_t> moments;
  for (const auto stamp : baseline.estimate.stamps()) moments.push_back(stamp.nanoseconds);
  const std::vector<double> numbers = baseline.frames.column("frame");
  Json charts = Json::array();
  for (const auto& [id, title, unit, by_frame] :
       {std::tuple{"ape_rmse_m", "APE, position", "m", false},
        std::tuple{"rpe_10_frames_rmse_m", "RPE over 10 frames", "m", false},
        std::tuple{"frame_median_ms", "Time per frame", "ms", true}}) {
    Json list = Json::array();
    for (const ComparedRun& run : runs) {
      const Series series = series_of(run.data, id);
      if (series.empty()) continue;
      Json values = Json::array();
      for (std::size_t i = 0; i < moments.size(); ++i) {
        const auto found =
            series.find(by_frame ? static_cast<std::int64_t>(numbers[i]) : moments[i]);
        values.push_back(found == series.end() ? Json() : series_number(found->second));
      }
      list.push_back({{"name", run.name}, {"values", std::move(values)}});
    }
    if (list.empty()) continue;
    charts.push_back({{"id", id},
                      {"section", "comparison"},
                      {"title", title},
                      {"unit", unit},
                      {"pose", nullptr},
                      {"x", nullptr},
                      {"x_name", nullptr},
                      {"log", by_frame},
                      {"stacked", false},
                      {"points", false},
                      {"level", nullptr},
                      {"series", std::move(list)}});
  }
  model.json["charts"] = std::move(charts);
  Json time_s = Json::array();
  Json distance_m = Json::array();
  Json frame = Json::array();
  for (const double value : seconds_from_start(baseline)) time_s.push_back(series_number(value));
  for (const double value : baseline.estimate.accumulated_distances()) {
    distance_m.push_back(series_number(value));
  }
  for (const double value : numbers) frame.push_back(value);
  model.json["poses"] = {{"frame", std::move(frame)},
                         {"time_s", std::move(time_s)},
                         {"distance_m", std::move(distance_m)}};
}

}  // namespace traverse::report
