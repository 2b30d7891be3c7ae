#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "traverse/dataset/source.hpp"
#include "traverse/evaluation/titles.hpp"
#include "traverse/pipeline/rejections_text.hpp"

#include "charts/navigation_series.hpp"
#include "charts/series.hpp"
#include "run/number_texts.hpp"
#include "sections/sections.hpp"

namespace traverse::report {

namespace {

using pipeline::Health;
using pipeline::RunHealth;

/// "nothing skipped" is said of a run of which all is well, and of no other.
std::string skipped_words(const RunData& run) {
  const std::size_t skipped = skipped_records(run.record);
  if (skipped > 0) return plural(skipped, "record") + " skipped";
  return run.health.verdict == Health::kOk ? "nothing skipped" : "no record skipped";
}

std::string drift_words(const RunFigure& drift, const evaluation::KittiDrift& kitti) {
  const std::string interval = drift.interval
                                   ? fmt::format(", {} to {} %", short_number(drift.interval->low),
                                                 short_number(drift.interval->high))
                                   : "";
  return fmt::format("Drift {} % ({}{})", short_number(drift.value),
                     plural(kitti.segments.size(), "segment"), interval);
}

/// What is known of the accuracy: what the field calls drift where it is defined, else less.
void add_accuracy_words(const RunData& run, const std::vector<RunFigure>& figures,
                        std::vector<std::string>& parts) {
  if (!run.evaluation.comparison) {
    parts.push_back(fmt::format("Drove {} m, no reference to compare with",
                                short_number(run.estimate.path_length())));
    return;
  }
  const evaluation::Comparison& comparison = *run.evaluation.comparison;
  const bool by_fixes = is_navigation(run.frames);
  const auto* drift = find_figure(figures, "kitti_translation_percent");
  if (drift != nullptr && !by_fixes) parts.push_back(drift_words(*drift, *comparison.kitti));
  if (const auto* ape = find_figure(figures, "ape_rmse_m")) {
    parts.push_back(fmt::format("APE {} m", short_number(ape->value)));
  }
  if (const auto* outages = find_figure(figures, "outage_error_rms_m")) {
    parts.push_back(fmt::format("{} m after GNSS outages", short_number(outages->value)));
  }
  const auto* closing = find_figure(figures, "closing_error_m");
  if (drift == nullptr && !by_fixes && closing != nullptr) {
    parts.push_back(fmt::format("{}losing error {} m after {} m", parts.empty() ? "C" : "c",
                                short_number(closing->value),
                                short_number(comparison.path.reference_m)));
  }
}

/// Begins with what speaks against the run; of a lost one there is nothing else to say.
std::string sentence(const RunData& run, const std::vector<RunFigure>& figures) {
  const RunHealth& health = run.health;
  if (health.verdict == Health::kLost) return "Lost: " + health.reasons.front().text;
  std::vector<std::string> parts;
  add_accuracy_words(run, figures, parts);
  if (const auto* median = find_figure(figures, "frame_median_ms")) {
    parts.push_back(fmt::format("{} ms per frame", short_number(median->value)));
  }
  parts.push_back(skipped_words(run));
  const std::string figures_text = fmt::format("{}.", fmt::join(parts, "; "));
  if (health.verdict == Health::kOk) return figures_text;
  return fmt::format("Degraded: {} {}", health.reasons.front().text, figures_text);
}

struct Notice {
  std::string kind;  // of the CSS: good, warn, fail
  std::string word;
  std::string text;
};

bool has_reason(const RunHealth& health, std::string_view code) {
  return std::any_of(health.reasons.begin(), health.reasons.end(),
                     [&](const pipeline::HealthReason& reason) { return reason.code == code; });
}

void add_end_notices(const RunData& run, std::vector<Notice>& list) {
  if (run.record.at("status") == "interrupted") {
    list.push_back({"warn", "Interrupted", "The run was stopped; this is what was done so far."});
  }
  if (run.record.at("status") == "failed") {
    list.push_back({"fail", "Failed",
                    fmt::format("The run ended with an error; this is what was done before. {}",
                                run.record.at("reason").get<std::string>())});
  }
}

void add_health_notices(const RunData& run, std::vector<Notice>& list) {
  const RunHealth& health = run.health;
  for (const pipeline::HealthReason& reason : health.reasons) {
    const bool is_lost = reason.severity == Health::kLost;
    list.push_back({is_lost ? "fail" : "warn", is_lost ? "Lost" : "Degraded", reason.text});
  }
  for (const pipeline::Contradiction& found : health.contradictions) {
    if (found.statement.empty()) continue;
    list.push_back({"warn", "Mended by", found.statement});
  }
  if (health.verdict == Health::kLost && run.map.size() > 0) {
    list.push_back({"fail", "No score",
                    "The sharpness of the map is not told: of points that nothing moves no map is "
                    "sharper."});
  }
}

void add_recording_notices(const RunData& run, std::vector<Notice>& list) {
  if (!run.record.at("evaluation_error").is_null()) {
    list.push_back({"fail", "Not compared", run.record.at("evaluation_error")});
  }
  const auto& recording = run.record.at("recording");
  const auto refused = recording.find("reference_refused");
  if (refused != recording.end() && !refused->is_null()) {
    list.push_back({"warn", "Reference not used", refused->get<std::string>()});
  }
  if (run.evaluation.comparison) {
    for (const std::string& warning : run.evaluation.comparison->warnings) {
      list.push_back({"warn", "Comparison", warning});
    }
  }
  for (const Json& fact : recording.value("facts", Json::array())) {
    const std::string name = fact.at("name");
    if (!dataset::is_clock_step(dataset::Fact{name, "", ""})) continue;
    list.push_back({"warn", "Clock set",
                    fmt::format("{}; {}.", fact.at("value").get<std::string>(),
                                fact.at("reason").get<std::string>())});
  }
  for (const auto& [reason, skipped] : run.record.at("skipped_records").items()) {
    list.push_back(
        {"warn", "Skipped",
         fmt::format("{} × {} (first: {})", skipped.at("count").get<std::size_t>(), reason,
                     fmt::join(skipped.at("first").get<std::vector<std::string>>(), ", "))});
  }
}

/// What in the recording contradicts itself, and the user has accepted.
void add_accepted(const RunData& run, std::vector<Notice>& list) {
  for (const Json& found : run.record.value("contradictions", Json::array())) {
    if (!found.at("accepted").get<bool>()) continue;
    list.push_back({"warn", "Accepted",
                    fmt::format("{}: {}. {}.", found.at("code").get<std::string>(),
                                found.at("figure").get<std::string>(),
                                found.at("consequence").get<std::string>())});
  }
}

/// What is told although the run is no worse for it.
void add_smaller_notices(const RunData& run, std::vector<Notice>& list) {
  const RunHealth& health = run.health;
  const bool by_fixes = is_navigation(run.frames);
  if (health.lost.frames > 0 && !has_reason(health, "not_registered") &&
      !has_reason(health, "ends_lost")) {
    list.push_back({"warn", by_fixes ? "Dead reckoning" : "Not registered",
                    fmt::format("{} of {}, the longest stretch {} s.",
                                count_text(health.lost.frames), plural(health.registrable, "frame"),
                                short_number(health.lost.longest.seconds))});
  }
  for (const pipeline::SensorUse& sensor : health.sensors) {
    const bool is_lidar = sensor.kind == sensors::SensorKind::kLidar;
    if (is_lidar || sensor.rejected == 0 || has_reason(health, "sensor_rejected")) continue;
    list.push_back(
        {"good", "Rejected",
         fmt::format("{} of {} of {}, {}: outliers, as far as one can tell.",
                     count_text(sensor.rejected), plural(sensor.used + sensor.rejected, "reading"),
                     sensor.label, pipeline::rejections_text(sensor))});
  }
  if (health.degenerate.frames > 0 && !has_reason(health, "degenerate")) {
    list.push_back({"warn", "Degenerate",
                    fmt::format("{} of {} frames do not determine every direction of motion; along "
                                "those the prediction was kept.",
                                health.degenerate.frames, run.frames.rows().size())});
  }
  if (health.gaps.count > 0 && !has_reason(health, "gap")) {
    list.push_back(
        {"warn", "Gap",
         fmt::format("{} between frames, the longest {} s after frame {} (usual: {} s).",
                     plural(health.gaps.count, "gap"), short_number(health.gaps.longest_s),
                     health.gaps.after_frame, short_number(health.gaps.usual_s))});
  }
  if (run.evaluation.comparison) {
    const std::string note = evaluation::alternation_note(*run.evaluation.comparison);
    if (!note.empty()) list.push_back({"warn", "Jitter", note});
  }
  if (run.jacobians && !run.jacobians->passed()) {
    list.push_back(
        {"fail", "Jacobians", "A factor of this run has a wrong derivative; see Factors."});
  }
}

/// Of a run against which nothing speaks.
std::string health_words(const RunData& run) {
  if (run.health.is_foreign) {
    return "no leap of the path, no record was skipped, no gap in time; how the other program "
           "found "
           "its poses is not known.";
  }
  return is_navigation(run.frames)
             ? "no sensor was rejected, nothing was begun again, no record was skipped, no gap in "
               "time."
             : "every frame was registered, no direction was degenerate, no record was skipped, no "
               "gap in time.";
}

std::vector<Notice> notices(const RunData& run) {
  std::vector<Notice> list;
  add_end_notices(run, list);
  add_health_notices(run, list);
  add_recording_notices(run, list);
  add_accepted(run, list);
  add_smaller_notices(run, list);
  if (list.empty()) {
    list.push_back(
        {"good", run.health.is_foreign ? "Nothing against it" : "Healthy", health_words(run)});
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
