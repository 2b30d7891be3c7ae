#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "charts/series.hpp"
#include "run/number_texts.hpp"
#include "sections/sections.hpp"

namespace traverse::report {

namespace {

/// A stretch without a frame longer than this many median intervals is told.
constexpr double kGap = 1.5;

std::string skipped_words(std::size_t skipped) {
  return skipped == 0 ? "nothing skipped" : plural(skipped, "record") + " skipped";
}

std::string sentence(const RunData& run, const std::vector<RunFigure>& figures) {
  std::vector<std::string> parts;
  if (run.evaluation.comparison) {
    const double reference_m = run.evaluation.comparison->path.reference_m;
    if (const auto* drift = find_figure(figures, "end_drift_percent")) {
      parts.push_back(fmt::format("Drifts {} % over {} m", short_number(drift->value),
                                  short_number(reference_m)));
    }
    if (const auto* ape = find_figure(figures, "ape_rmse_m")) {
      parts.push_back(fmt::format("{} m APE", short_number(ape->value)));
    }
  } else {
    parts.push_back(fmt::format("Drove {} m, no reference to compare with",
                                short_number(run.estimate.path_length())));
  }
  parts.push_back(
      fmt::format("{} ms per frame", short_number(find_figure(figures, "frame_median_ms")->value)));
  parts.push_back(skipped_words(skipped_records(run.record)));
  return fmt::format("{}.", fmt::join(parts, "; "));
}

struct Notice {
  std::string kind;  // of the CSS: good, warn, fail
  std::string word;
  std::string text;
};

void add_gap_notice(const RunData& run, std::vector<Notice>& list) {
  const std::vector<double> stamps = run.frames.column("stamp_s");
  std::vector<double> intervals;
  for (std::size_t i = 1; i < stamps.size(); ++i) intervals.push_back(stamps[i] - stamps[i - 1]);
  if (intervals.empty()) return;
  const double usual = quantile_or_none(intervals, 0.5);
  const auto longest = std::max_element(intervals.begin(), intervals.end());
  const auto gaps = std::count_if(intervals.begin(), intervals.end(),
                                  [&](double interval) { return interval > kGap * usual; });
  if (gaps == 0) return;
  const auto frame = static_cast<std::size_t>(longest - intervals.begin());
  list.push_back({"warn", "Gap",
                  fmt::format("{} between frames, the longest {} s after frame {} (usual: {} s).",
                              plural(static_cast<std::size_t>(gaps), "gap"), short_number(*longest),
                              frame, short_number(usual))});
}

std::vector<Notice> notices(const RunData& run) {
  std::vector<Notice> list;
  if (run.record.at("status") == "interrupted") {
    list.push_back({"warn", "Interrupted", "The run was stopped; this is what was done so far."});
  }
  if (run.record.at("status") == "failed") {
    list.push_back({"fail", "Failed",
                    fmt::format("The run ended with an error; this is what was done before. {}",
                                run.record.at("reason").get<std::string>())});
  }
  if (!run.record.at("evaluation_error").is_null()) {
    list.push_back({"fail", "Not compared", run.record.at("evaluation_error")});
  }
  for (const auto& [reason, skipped] : run.record.at("skipped_records").items()) {
    list.push_back(
        {"warn", "Skipped",
         fmt::format("{} × {} (first: {})", skipped.at("count").get<std::size_t>(), reason,
                     fmt::join(skipped.at("first").get<std::vector<std::string>>(), ", "))});
  }
  const Registration state = registration_of(run.frames);
  if (state.lost > 0) {
    list.push_back(
        {"fail", "Lost",
         fmt::format("{} could not be registered; {} predicted.", plural(state.lost, "frame"),
                     state.lost == 1 ? "its pose is" : "their poses are")});
  }
  if (state.degenerate > 0) {
    list.push_back({"warn", "Degenerate",
                    fmt::format("{} of {} frames do not determine every direction of motion; along "
                                "those the prediction was kept.",
                                state.degenerate, run.frames.rows().size())});
  }
  add_gap_notice(run, list);
  if (run.jacobians && !run.jacobians->passed()) {
    list.push_back(
        {"fail", "Jacobians", "A factor of this run has a wrong derivative; see Factors."});
  }
  if (list.empty()) {
    list.push_back({"good", "Healthy",
                    "every frame was registered, no direction was degenerate, no record was "
                    "skipped, no gap in time."});
  }
  return list;
}

}  // namespace

void add_verdict(const RunData& run, const std::vector<RunFigure>& figures, Model& model) {
  model.add_text("verdict", sentence(run, figures));
  TemplateData list = TemplateData::list();
  Json json = Json::array();
  for (const Notice& notice : notices(run)) {
    TemplateData entry;
    entry.set("kind", notice.kind);
    entry.set("word", notice.word + ":");
    entry.set("text", notice.text);
    list.push_back(entry);
    json.push_back({{"kind", notice.kind}, {"word", notice.word}, {"text", notice.text}});
  }
  model.page.set("notices", list);
  model.json["notices"] = std::move(json);
}

}  // namespace traverse::report
