#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "traverse/batch/planned_command.hpp"
#include "traverse/batch/planned_table.hpp"
#include "traverse/config/document.hpp"

namespace traverse::batch {

/// What a run may take. A run that takes more is ended and reported as such.
struct RunLimits {
  double time_s = 3600;
  double memory_mb = 0;  ///< resident; 0: as much as the machine has
  int threads = 1;
  int attempts = 5;  ///< of a run that something outside killed, before it counts as crashed

  bool operator==(const RunLimits&) const = default;
};

/// A recording that `traverse simulate` makes before the runs begin.
struct GeneratedRecording {
  std::string world;                   ///< as `traverse simulate WORLD`
  std::vector<std::string> arguments;  ///< "--length", "60"; --output is added
};

struct PlannedRecording {
  std::string name;            ///< once in the plan
  std::string text;            ///< above its tables; may be empty
  std::filesystem::path path;  ///< absolute; empty as long as a generated one is not made
  std::optional<GeneratedRecording> generated;
  std::filesystem::path statements_file;   ///< absolute, or empty
  std::vector<std::string> statements;     ///< "motion_compensated=true"
  std::filesystem::path reference;         ///< absolute, or empty
  std::string reference_frame;             ///< body, lidar, camera, or empty
  std::filesystem::path checkpoints = {};  ///< absolute, or empty
  std::vector<double> point = {};          ///< what stood over them, body frame; or empty
  double points_time_offset_s = 0;         ///< added to their stamps
  std::int64_t first = 0;
  std::int64_t last = -1;              ///< included; -1: to the end
  std::vector<std::string> pipelines;  ///< that it goes through, by name; empty: all
  config::Origin origin;
  /// What commands read of it, by the format: made by `traverse convert`.
  std::map<std::string, std::filesystem::path> converted = {};

  bool takes(const std::string& pipeline) const {
    return pipelines.empty() ||
           std::find(pipelines.begin(), pipelines.end(), pipeline) != pipelines.end();
  }
};

/// A setting and the values it takes in turn.
struct GridAxis {
  std::string key;                  ///< "solver.huber_m"
  std::vector<std::string> values;  ///< as YAML on one line
  config::Origin origin;
};

struct PlannedPipeline {
  std::string name;        ///< once in the plan
  PlannedCommand command;  ///< a program that is not ours; then there is no preset
  std::string preset;      ///< of share/pipelines, or the absolute path of a YAML file
  std::vector<std::filesystem::path> config_files;
  std::vector<std::string> assignments;  ///< "solver.huber_m=0.2"
  std::vector<std::string> statements;   ///< about each recording, over the recording's own
  std::vector<GridAxis> grid;            ///< the plan's axes, then its own
  config::Origin origin;
};

/// The most that a metric may be in any run, as "pass" and "fail" in the report.
struct Budget {
  std::string metric;
  double most = 0;
};

struct SlurmOptions {
  std::vector<std::string> sbatch;  ///< "--partition=main"
  int runs_per_task = 0;            ///< 0: as few as the size of the largest array allows
  int max_at_once = 0;              ///< tasks; 0: as many as the scheduler likes
};

/// Recordings x pipelines x grid x repeats, and how to run them; docs/batch.md describes the file.
struct Plan {
  std::filesystem::path file;
  std::string text;   ///< of the file, for the report
  std::string title;  ///< of what it is made for; may be empty
  std::string description;
  std::vector<PlannedRecording> recordings;
  std::vector<PlannedPipeline> pipelines;
  int repeats = 1;
  bool reports = true;               ///< pictures and report.html of each run
  bool is_private = false;           ///< results do not tell whose machines made them
  std::vector<std::string> metrics;  ///< the report's columns; the first ranks
  std::vector<Budget> budgets;
  RunLimits limits;
  config::Origin threads_origin;  ///< where limits.threads stands, if it does
  config::Origin memory_origin;
  std::vector<PlannedTable> tables;  ///< beside the leaderboard
  SlurmOptions slurm;
  std::vector<std::string> notes;  ///< for the user: keys that were given by former names
};

/// Says what is wrong with `traverse simulate WORDS`, or nothing if it would begin.
using SimulationCheck =
    std::function<std::optional<std::string>(const std::vector<std::string>& words)>;

/// Reads and checks a plan: known keys, files that are there, presets and settings that exist,
/// limits that can be kept, names that are there once, at most kMostRuns runs.
/// \throws files::InputError with file and line.
Plan load_plan(const std::filesystem::path& file, const std::filesystem::path& share_folder,
               const SimulationCheck& simulation_error);

/// Lets no run go on after frame `last`, counted from 0.
void stop_after(std::int64_t last, Plan& plan);

/// The numbers that multiply to the number of runs, in words: "2 recordings x 3 pipelines ...".
std::string describe(const Plan& plan);

/// More runs than this are refused: a batch keeps some kilobytes of each in memory.
inline constexpr std::size_t kMostRuns = 200'000;

/// How many runs the plan has, counted without making their list; the largest number of all for
/// more than that.
std::size_t count_runs(const Plan& plan);

/// The points of a pipeline's grid: one list of "key=value" a point; one empty list without grid.
std::vector<std::vector<std::string>> grid_points(const std::vector<GridAxis>& grid);

}  // namespace traverse::batch
