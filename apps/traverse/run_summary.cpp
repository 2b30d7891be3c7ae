#include "run_summary.hpp"

#include <string>

#include <fmt/format.h>

#include "traverse/evaluation/json.hpp"

namespace traverse::app {

namespace {

void print_line(const char* name, const std::string& value) {
  fmt::print("{:<11}{}\n", name, value);
}

std::string frames_text(const pipeline::RunRecord& record) {
  std::string text = fmt::format("{} estimated", record.frames_used);
  if (record.skipped.empty()) return text + ", nothing skipped";
  for (const auto& [reason, count] : record.skipped.by_reason()) {
    text += fmt::format("; {} skipped: {}", count.count, reason);
  }
  return text;
}

void print_accuracy(const evaluation::Comparison& comparison) {
  for (const evaluation::Ape& ape : comparison.ape) {
    if (ape.relation != evaluation::Relation::kTranslation) continue;
    print_line("accuracy", fmt::format("APE {:.3f} m rmse over {} poses", ape.statistics.rmse,
                                       ape.statistics.count));
  }
  const evaluation::PathFigures& path = comparison.path;
  print_line(
      "",
      fmt::format("end error {:.3f} m{} of {:.1f} m, {:.2f} deg", path.end_error_m,
                  path.end_error_percent ? fmt::format(", {:.2f} %", *path.end_error_percent) : "",
                  path.reference_m, path.end_rotation_deg));
  if (comparison.kitti) {
    print_line(
        "", fmt::format("KITTI drift {:.2f} %, {:.4f} deg/m over {} segments ({} frame)",
                        comparison.kitti->translation_percent, comparison.kitti->rotation_deg_per_m,
                        comparison.kitti->segments.size(), comparison.kitti->frame));
  }
}

}  // namespace

void print_run_summary(const pipeline::RunRecord& record, const pipeline::RunFolder& folder,
                       bool with_report) {
  const evaluation::Evaluation evaluation = evaluation::read_evaluation(folder.evaluation());
  if (record.status == pipeline::RunStatus::kInterrupted) print_line("status", "interrupted");
  print_line("frames", frames_text(record));
  if (evaluation.comparison) print_accuracy(*evaluation.comparison);
  if (evaluation.consistency) {
    print_line("map",
               fmt::format("entropy (MME) {:.3f}, {} points ({})", evaluation.consistency->mme,
                           record.map_points, record.points_are));
  }
  print_line("time", fmt::format("{:.1f} ms per frame (median), {:.1f} ms at 95 %, {} thread{}",
                                 record.frame_median_ms, record.frame_p95_ms, record.threads,
                                 record.threads == 1 ? "" : "s"));
  print_line("run", folder.path.string());
  if (with_report) print_line("report", folder.report().string());
}

}  // namespace traverse::app
