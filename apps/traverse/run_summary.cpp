#include "run_summary.hpp"

#include <string>
#include <vector>

#include <fmt/format.h>

#include "traverse/dataset/source.hpp"
#include "traverse/evaluation/json.hpp"

namespace traverse::app {

namespace {

void print_line(const char* name, const std::string& value) {
  fmt::print("{:<11}{}\n", name, value);
}

/// How far the run can be believed, and why no farther.
void print_status(const pipeline::RunRecord& record) {
  if (record.status == pipeline::RunStatus::kInterrupted) print_line("status", "interrupted");
  if (!record.health) return;
  const pipeline::RunHealth& health = *record.health;
  const char* name = record.status == pipeline::RunStatus::kInterrupted ? "" : "status";
  if (health.reasons.empty()) return;
  print_line(name, std::string(name_of(health.verdict)));
  for (const pipeline::HealthReason& reason : health.reasons) print_line("", reason.text);
}

std::string frames_text(const pipeline::RunRecord& record) {
  std::string text = fmt::format("{} estimated", record.frames_used);
  if (record.health && record.health->registrable > 0) {
    text += fmt::format(", {} of {} {}", record.health->registered, record.health->registrable,
                        record.health->is_navigation ? "by fixes or wheels" : "registered");
  }
  if (record.skipped.empty()) return text + ", no record skipped";
  for (const auto& [reason, count] : record.skipped.by_reason()) {
    text += fmt::format("; {} skipped: {}", count.count, reason);
  }
  return text;
}

/// Of the sensors that the estimator takes, what was not used: scans are told by the frames.
void print_sensors(const pipeline::RunRecord& record) {
  if (!record.health) return;
  const char* name = "sensors";
  for (const pipeline::SensorUse& sensor : record.health->sensors) {
    if (sensor.kind == sensors::SensorKind::kLidar || !sensor.is_taken) continue;
    print_line(name, fmt::format("{}: {} of {} readings used, {} rejected, {} unused", sensor.label,
                                 sensor.used, sensor.read, sensor.rejected, sensor.unused()));
    name = "";
  }
}

void print_accuracy(const evaluation::Comparison& comparison, bool by_fixes) {
  const char* name = "accuracy";
  for (const std::string& line : accuracy_lines(comparison, by_fixes)) {
    print_line(name, line);
    name = "";
  }
}

/// What lies beside the recording and could give an accuracy.
void print_unused(const dataset::RecordingInfo& recording) {
  for (const dataset::Fact& fact : recording.facts) {
    if (fact.name != dataset::kNotUsed) continue;
    print_line(dataset::kNotUsed, fact.value + ": " + fact.reason);
  }
}

/// What was told of the clock: stamps of the trajectory are not those of the recording everywhere.
void print_steps(const dataset::RecordingInfo& recording) {
  for (const dataset::Fact& fact : recording.facts) {
    if (dataset::is_clock_step(fact)) {
      print_line("stamps", fmt::format("{}: {}; {}", fact.name, fact.value, fact.reason));
    }
  }
}

}  // namespace

std::vector<std::string> accuracy_lines(const evaluation::Comparison& comparison, bool by_fixes) {
  std::vector<std::string> lines;
  const auto add_ape = [&](const std::vector<evaluation::Ape>& list, const std::string& alignment) {
    for (const evaluation::Ape& ape : list) {
      if (ape.relation != evaluation::Relation::kTranslation) continue;
      lines.push_back(fmt::format("APE {:.3f} m (rmse over {} poses{})", ape.statistics.rmse,
                                  ape.statistics.count, alignment));
    }
  };
  if (const auto& kitti = comparison.kitti; kitti && !by_fixes) {
    lines.push_back(
        fmt::format("drift {:.2f} %, {:.4f} deg/m (KITTI, mean over {} segments, {} frame)",
                    kitti->translation_percent, kitti->rotation_deg_per_m, kitti->segments.size(),
                    kitti->frame));
  }
  add_ape(comparison.ape, "");
  const evaluation::Alignment& alignment = comparison.alignment;
  if (alignment.undetermined != evaluation::Undetermined::kNothing) {
    add_ape(comparison.ape_at_origin, ", aligned at the first pose");
    lines.push_back(fmt::format("{} of the alignment not determined: {}",
                                name_of(alignment.undetermined), alignment.reason));
  }
  const evaluation::PathFigures& path = comparison.path;
  lines.push_back(
      fmt::format("closing error {:.3f} m{} after {:.1f} m, {:.2f} deg", path.end_error_m,
                  path.end_error_percent ? fmt::format(" ({:.2f} %)", *path.end_error_percent) : "",
                  path.reference_m, path.end_rotation_deg));
  for (const std::string& warning : comparison.warnings) lines.push_back("warning: " + warning);
  return lines;
}

void print_run_summary(const pipeline::RunRecord& record, const pipeline::RunFolder& folder,
                       bool with_report) {
  const evaluation::Evaluation evaluation = evaluation::read_evaluation(folder.evaluation());
  print_status(record);
  print_line("frames", frames_text(record));
  if (const std::string& refused = record.recording.reference_refused; !refused.empty()) {
    print_line("reference", "not used: " + refused);
  }
  for (const plausibility::Finding& finding : record.contradictions) {
    if (finding.is_accepted) {
      print_line("accepted", plausibility::to_text(finding));
    } else if (!finding.statement.empty()) {
      print_line("mended by", finding.statement);
    }
  }
  if (evaluation.comparison) {
    print_accuracy(*evaluation.comparison, record.health && record.health->is_navigation);
  }
  print_sensors(record);
  if (!record.reference_file) print_unused(record.recording);
  print_steps(record.recording);
  if (evaluation.consistency) {
    print_line("map",
               fmt::format("entropy (MME) {:.3f}, {} points ({})", evaluation.consistency->mme,
                           record.map_points, record.points_are));
  }
  for (const pipeline::Decision& decision : record.decisions) {
    if (record.foreign || decision.is_told) print_line(decision.name.c_str(), decision.value);
  }
  if (!record.foreign) {
    print_line("time", fmt::format("{:.1f} ms per frame (median), {:.1f} ms at 95 %, {} thread{}",
                                   record.frame_median_ms, record.frame_p95_ms, record.threads,
                                   record.threads == 1 ? "" : "s"));
  }
  print_line("run", folder.path.string());
  if (with_report) print_line("report", folder.report().string());
}

}  // namespace traverse::app
