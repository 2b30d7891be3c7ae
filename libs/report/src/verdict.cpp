#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "traverse/evaluation/titles.hpp"

#include "number_text.hpp"
#include "sections.hpp"

namespace traverse::report {

namespace {

using evaluation::Relation;

/// A stretch without a frame longer than this many median intervals is told.
constexpr double kGap = 1.5;

const evaluation::Ape* find_ape(const evaluation::Comparison& comparison, Relation relation) {
  for (const auto& ape : comparison.ape) {
    if (ape.relation == relation) return &ape;
  }
  return nullptr;
}

const evaluation::Rpe* find_rpe(const evaluation::Comparison& comparison, Relation relation,
                                double frames) {
  for (const auto& rpe : comparison.rpe) {
    if (rpe.relation == relation && rpe.options.delta.unit == evaluation::DeltaUnit::kFrames &&
        rpe.options.delta.value == frames) {
      return &rpe;
    }
  }
  return nullptr;
}

double end_error_percent(const evaluation::Comparison& comparison) {
  return comparison.path.end_error_percent.value_or(std::numeric_limits<double>::quiet_NaN());
}

std::size_t skipped_records(const RunData& run) {
  std::size_t total = 0;
  for (const auto& [reason, count] : run.record.at("frames").at("skipped").items()) {
    total += count.get<std::size_t>();
  }
  return total;
}

std::string skipped_words(std::size_t skipped) {
  return skipped == 0 ? "nothing skipped" : plural(skipped, "record") + " skipped";
}

std::string sentence(const RunData& run) {
  const double ms = run.record.at("timing_ms").at("frame_median");
  std::vector<std::string> parts;
  if (const auto& comparison = run.evaluation.comparison) {
    parts.push_back(fmt::format("Drifts {} % over {} m",
                                short_number(end_error_percent(*comparison)),
                                short_number(comparison->path.reference_m)));
    if (const auto* ape = find_ape(*comparison, Relation::kTranslation)) {
      parts.push_back(fmt::format("{} m APE", short_number(ape->statistics.rmse)));
    }
  } else {
    parts.push_back(fmt::format("Drove {} m, no reference to compare with",
                                short_number(run.estimate.path_length())));
  }
  parts.push_back(fmt::format("{} ms a frame", short_number(ms)));
  parts.push_back(skipped_words(skipped_records(run)));
  return fmt::format("{}.", fmt::join(parts, "; "));
}

struct Headline {
  std::string label;
  std::string value;
  std::string full;
  std::string unit;
  std::string how;
};

Headline headline(const std::string& label, double value, const std::string& unit,
                  const std::string& how) {
  return {label, short_number(value), full_number(value), unit, how};
}

void add_comparison_headlines(const evaluation::Comparison& comparison,
                              std::vector<Headline>& headlines) {
  headlines.push_back(headline("Drift", end_error_percent(comparison), "%",
                               fmt::format("end point {} m off after {} m, from the first pose on",
                                           short_number(comparison.path.end_error_m),
                                           short_number(comparison.path.reference_m))));
  if (const auto* ape = find_ape(comparison, Relation::kTranslation)) {
    headlines.push_back(
        headline("APE", ape->statistics.rmse, "m",
                 fmt::format("rmse, {}, {} pairs",
                             evaluation::describe(comparison.alignment, ape->statistics.count),
                             ape->statistics.count)));
  }
  if (comparison.kitti) {
    headlines.push_back(
        headline("KITTI drift", comparison.kitti->translation_percent, "%",
                 fmt::format("mean of {} segments of 100 to 800 m, {} frame",
                             comparison.kitti->segments.size(), comparison.kitti->frame)));
  } else if (const auto* rpe = find_rpe(comparison, Relation::kTranslation, 10)) {
    headlines.push_back(headline("RPE over 10 frames", rpe->statistics.rmse, "m",
                                 fmt::format("rmse, {} pairs", rpe->statistics.count)));
  }
}

std::vector<Headline> headlines(const RunData& run) {
  std::vector<Headline> list;
  if (run.evaluation.comparison) add_comparison_headlines(*run.evaluation.comparison, list);
  if (const auto& score = run.evaluation.consistency) {
    list.push_back(headline("Map entropy", score->mme, "nats",
                            fmt::format("mean of {} queries, lower is sharper; points {}",
                                        count_text(score->queries), score->points_are)));
  }
  const auto& timing = run.record.at("timing_ms");
  list.push_back(headline("Time a frame", timing.at("frame_median"), "ms",
                          fmt::format("median, {} at 95 %, {} thread{}",
                                      short_number(timing.at("frame_p95").get<double>()),
                                      run.record.at("threads").get<int>(),
                                      run.record.at("threads").get<int>() == 1 ? "" : "s")));
  const std::size_t used = run.record.at("frames").at("used");
  list.push_back(
      {"Frames", count_text(used), std::to_string(used), "", skipped_words(skipped_records(run))});
  return list;
}

struct Notice {
  std::string kind;  // of the CSS: good, warn, fail
  std::string word;
  std::string text;
};

std::size_t count_where(const std::vector<double>& values, bool (*test)(double)) {
  return static_cast<std::size_t>(std::count_if(values.begin(), values.end(), test));
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void add_gap_notice(const RunData& run, std::vector<Notice>& list) {
  const std::vector<double> stamps = run.frames.column("stamp_s");
  std::vector<double> intervals;
  for (std::size_t i = 1; i < stamps.size(); ++i) intervals.push_back(stamps[i] - stamps[i - 1]);
  if (intervals.empty()) return;
  const double usual = median(intervals);
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
  if (!run.record.at("evaluation_error").is_null()) {
    list.push_back({"fail", "Not compared", run.record.at("evaluation_error")});
  }
  for (const auto& [reason, skipped] : run.record.at("skipped_records").items()) {
    list.push_back(
        {"warn", "Skipped",
         fmt::format("{} × {} (first: {})", skipped.at("count").get<std::size_t>(), reason,
                     fmt::join(skipped.at("first").get<std::vector<std::string>>(), ", "))});
  }
  const std::vector<double> registered = run.frames.column("registered");
  // The first frame defines the map: it has nothing to be registered in.
  const std::size_t lost = count_where(registered, [](double v) { return v == 0; });
  if (lost > 1) {
    list.push_back(
        {"fail", "Lost",
         fmt::format("{} frames could not be registered; their poses are predictions.", lost - 1)});
  }
  const std::size_t degenerate =
      count_where(run.frames.column("degenerate_directions"), [](double v) { return v > 0; });
  if (degenerate > 0) {
    list.push_back({"warn", "Degenerate",
                    fmt::format("{} of {} frames do not determine every direction of motion; along "
                                "those the prediction was kept.",
                                degenerate, run.frames.rows().size())});
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

void add_verdict(const RunData& run, TemplateData& page) {
  page.set("verdict", sentence(run));
  TemplateData headline_list{TemplateData::type::list};
  for (const Headline& item : headlines(run)) {
    TemplateData entry;
    entry.set("label", item.label);
    entry.set("value", item.value);
    entry.set("full", item.full);
    entry.set("unit", item.unit);
    entry.set("how", item.how);
    headline_list.push_back(entry);
  }
  page.set("headlines", headline_list);
  TemplateData notice_list{TemplateData::type::list};
  for (const Notice& notice : notices(run)) {
    TemplateData entry;
    entry.set("kind", notice.kind);
    entry.set("word", notice.word + ":");
    entry.set("text", notice.text);
    notice_list.push_back(entry);
  }
  page.set("notices", notice_list);
}

}  // namespace traverse::report
