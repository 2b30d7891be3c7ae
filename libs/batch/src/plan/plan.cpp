#include "traverse/batch/plan.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "traverse/files/number_text.hpp"
#include "traverse/files/text_file.hpp"

#include "plan/plan_error.hpp"
#include "plan/plan_metrics.hpp"
#include "plan/plan_pipelines.hpp"
#include "plan/plan_recordings.hpp"
#include "plan/plan_tables.hpp"

namespace traverse::batch {

namespace {

using config::Binder;
using config::Document;
using config::Range;

/// Less than this the program itself takes.
constexpr double kLeastMemory_mb = 100;

void bind(Binder& b, RunLimits& limits) {
  b.number("time_s", limits.time_s, Range::between(0.1, 1e7), "longest duration of a run, seconds");
  b.number("memory_mb", limits.memory_mb, Range::between(kLeastMemory_mb, 1e7),
           "resident memory of a run, MB");
  b.integer("threads", limits.threads, Range::between(1, 256), "of a run");
  b.integer("attempts", limits.attempts, Range::between(1, 100),
            "tries of a run that was killed from outside");
}

SlurmOptions read_slurm(const Document& document, std::vector<std::string>& notes) {
  SlurmOptions slurm;
  const Document section = document.child("slurm");
  static constexpr std::array<std::string_view, 1> kOptions{"options"};
  notes = config::read(
      section,
      [&](Binder& b) {
        b.integer("runs_per_task", slurm.runs_per_task, Range::between(1, 1e6),
                  "runs of one array task, one after the other");
        b.integer("max_at_once", slurm.max_at_once, Range::between(1, 1e6),
                  "array tasks that run at the same time");
      },
      kOptions);
  const Document options = section.child("options");
  static const std::set<std::string, std::less<>> kOurs{"array",    "output", "error", "job-name",
                                                        "parsable", "wrap",   "wait"};
  for (const config::Leaf& leaf : options.leaves()) {
    const auto value = options.scalar(leaf.path);
    if (!value) throw plan_error(leaf.origin, "one value for '" + leaf.path + "'", leaf.text);
    if (kOurs.contains(leaf.path)) {
      throw plan_error(leaf.origin, "options that the batch does not set itself",
                       files::in_quotes(leaf.path));
    }
    slurm.sbatch.push_back("--" + leaf.path + (*value == "true" ? "" : "=" + *value));
  }
  return slurm;
}

void read_settings(const Document& document, Plan& plan) {
  static constexpr std::array<std::string_view, 7> kOthers{
      "recordings", "pipelines", "grid", "metrics", "budgets", "slurm", "tables"};
  config::read(
      document,
      [&](Binder& b) {
        b.text("title", plan.title, "of what the batch is made for");
        b.text("description", plan.description, "purpose of the batch");
        b.integer("repeats", plan.repeats, Range::between(1, 10000), "runs of each combination");
        b.flag("reports", plan.reports, "pictures and report.html of each run");
        b.flag("private", plan.is_private, "results do not tell whose machines made them");
        b.group("limits", "of each run", [&](Binder& limits) { bind(limits, plan.limits); });
      },
      kOthers);
  plan.threads_origin = document.origin("limits.threads").value_or(document.origin());
  plan.memory_origin = document.origin("limits.memory_mb").value_or(document.origin());
}

constexpr std::size_t kBeyondCount = std::numeric_limits<std::size_t>::max();

std::size_t product(std::size_t a, std::size_t b) {
  std::size_t result = 0;
  return __builtin_mul_overflow(a, b, &result) ? kBeyondCount : result;
}

std::size_t sum(std::size_t a, std::size_t b) {
  std::size_t result = 0;
  return __builtin_add_overflow(a, b, &result) ? kBeyondCount : result;
}

std::size_t count_points(const PlannedPipeline& pipeline) {
  std::size_t points = 1;
  for (const GridAxis& axis : pipeline.grid) points = product(points, axis.values.size());
  return points;
}

/// Of all pipelines with each point of their grids.
std::size_t count_variants(const Plan& plan) {
  std::size_t variants = 0;
  for (const PlannedPipeline& pipeline : plan.pipelines) {
    variants = sum(variants, count_points(pipeline));
  }
  return variants;
}

/// Recordings name pipelines that are there.
void check_choices(const Plan& plan) {
  for (const PlannedRecording& recording : plan.recordings) {
    for (const std::string& name : recording.pipelines) {
      const bool is_there =
          std::any_of(plan.pipelines.begin(), plan.pipelines.end(),
                      [&](const PlannedPipeline& pipeline) { return pipeline.name == name; });
      if (is_there) continue;
      throw plan_error(recording.origin, "names of the plan's pipelines", files::in_quotes(name));
    }
  }
}

}  // namespace

Plan load_plan(const std::filesystem::path& file, const std::filesystem::path& share_folder,
               const SimulationCheck& simulation_error) {
  Plan plan;
  plan.file = std::filesystem::absolute(file).lexically_normal();
  plan.text = files::read_text(file);
  const Document document = Document::parse(plan.text, file.string());
  read_settings(document, plan);
  plan.metrics = read_metrics(document);
  plan.budgets = read_budgets(document);
  plan.slurm = read_slurm(document, plan.notes);
  plan.recordings = read_recordings(document, plan.file.parent_path(), simulation_error);
  plan.pipelines = read_pipelines(document, plan.file.parent_path(), share_folder, plan.notes);
  check_choices(plan);
  plan.tables = read_tables(document, plan);
  if (count_runs(plan) > kMostRuns) {
    const char* key = document.has("grid") ? "grid" : "pipelines";
    throw plan_error(*document.origin(key),
                     fmt::format("at most {} runs (make it several plans)", kMostRuns),
                     describe(plan));
  }
  return plan;
}

void stop_after(std::int64_t last, Plan& plan) {
  for (PlannedRecording& recording : plan.recordings) {
    const std::int64_t there = recording.first + last;
    recording.last = recording.last < 0 ? there : std::min(recording.last, there);
  }
}

std::string describe(const Plan& plan) {
  const std::size_t variants = count_variants(plan);
  const std::size_t recordings = plan.recordings.size();
  const std::size_t runs = count_runs(plan);
  const auto number = [](std::size_t n) {
    return n == kBeyondCount ? "more than can be counted" : fmt::format("{}", n);
  };
  const auto noun = [&](std::size_t n, const char* word) {
    return fmt::format("{} {}", number(n), files::noun(n, word));
  };
  const bool all =
      std::all_of(plan.recordings.begin(), plan.recordings.end(),
                  [](const PlannedRecording& recording) { return recording.pipelines.empty(); });
  return fmt::format("{} x {} ({} with the grid{}) x {} = {}", noun(recordings, "recording"),
                     noun(plan.pipelines.size(), "pipeline"), number(variants),
                     all ? "" : ", where they are chosen",
                     noun(static_cast<std::size_t>(plan.repeats), "repeat"), noun(runs, "run"));
}

std::size_t count_runs(const Plan& plan) {
  std::size_t pairs = 0;
  for (const PlannedRecording& recording : plan.recordings) {
    for (const PlannedPipeline& pipeline : plan.pipelines) {
      if (recording.takes(pipeline.name)) pairs = sum(pairs, count_points(pipeline));
    }
  }
  return product(pairs, static_cast<std::size_t>(plan.repeats));
}

std::vector<std::vector<std::string>> grid_points(const std::vector<GridAxis>& grid) {
  std::vector<std::vector<std::string>> points{{}};
  for (const GridAxis& axis : grid) {
    std::vector<std::vector<std::string>> extended;
    for (const auto& point : points) {
      for (const std::string& value : axis.values) {
        extended.push_back(point);
        extended.back().push_back(axis.key + "=" + value);
      }
    }
    points = std::move(extended);
  }
  return points;
}

}  // namespace traverse::batch
