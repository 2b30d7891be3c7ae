#include "batch_plan_text.hpp"

#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "traverse/batch/results.hpp"
#include "traverse/files/number_text.hpp"

namespace traverse::app {

namespace {

std::string recording_text(const batch::PlannedRecording& recording) {
  std::string text = recording.path.string();
  if (recording.generated) {
    text = fmt::format("traverse simulate {}", recording.generated->world);
    for (const std::string& word : recording.generated->arguments) text += " " + word;
  }
  if (!recording.reference.empty()) text += ", reference " + recording.reference.string();
  if (recording.first > 0 || recording.last >= 0) {
    text += fmt::format(", frames {} to {}", recording.first,
                        recording.last < 0 ? "the end" : std::to_string(recording.last));
  }
  return text;
}

}  // namespace

void print_plan(const batch::Plan& plan) {
  if (!plan.description.empty()) fmt::print("{}\n\n", plan.description);
  fmt::print("recordings\n");
  for (const auto& recording : plan.recordings) {
    fmt::print("  {:<24}{}\n", recording.name, recording_text(recording));
  }
  fmt::print("pipelines\n");
  for (const auto& pipeline : plan.pipelines) {
    fmt::print("  {:<24}{}", pipeline.name,
               pipeline.command ? pipeline.command.text : pipeline.preset);
    for (const std::string& assignment : pipeline.assignments) fmt::print(" {}", assignment);
    fmt::print("\n");
    for (const auto& axis : pipeline.grid) {
      fmt::print("  {:<24}{} in {}\n", "", axis.key, fmt::join(axis.values, ", "));
    }
  }
  const batch::RunLimits& limits = plan.limits;
  fmt::print("limits a run\n  {:g} s, {}, {}, {} attempts if killed from outside\n", limits.time_s,
             limits.memory_mb > 0 ? fmt::format("{:g} MB", limits.memory_mb) : "no memory limit",
             files::plural(static_cast<std::size_t>(limits.threads), "thread"), limits.attempts);
  fmt::print("metrics\n  {} (ranks)", plan.metrics.front());
  for (std::size_t i = 1; i < plan.metrics.size(); ++i) fmt::print(", {}", plan.metrics[i]);
  fmt::print("\n");
  for (const auto& budget : plan.budgets) {
    fmt::print("  budget: {} {} {:g}\n", budget.metric, limit_words(budget), budget.most);
  }
  if (!plan.tables.empty()) {
    fmt::print("tables\n");
    for (const auto& table : plan.tables) {
      fmt::print("  {}: {} of {}, {}\n", table.title.empty() ? "(without a title)" : table.title,
                 files::plural(table.columns.size(), "column"),
                 files::plural(table.pipelines.size(), "pipeline"),
                 files::plural(table.recordings.size(), "recording"));
    }
  }
  fmt::print("\n{}\n", batch::describe(plan));
}

}  // namespace traverse::app
