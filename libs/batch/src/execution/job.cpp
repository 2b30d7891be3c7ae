#include "traverse/batch/job.hpp"

#include <algorithm>
#include <functional>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/digest.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/files/json_document.hpp"
#include "traverse/files/text_file.hpp"
#include "traverse/pipeline/registry.hpp"
#include "traverse/pipeline/run_record.hpp"

#include "execution/run_output.hpp"
#include "plan/plan_error.hpp"

namespace traverse::batch {

namespace {

using nlohmann::json;

constexpr const char* kPrivate = "--private";

/// A pipeline at a point of its grid, and the digest of all its settings.
struct Variant {
  const PlannedPipeline& pipeline;
  std::vector<std::string> settings;
  std::string estimator;
  std::string configuration_sha256;
};

Variant resolve(const PlannedPipeline& pipeline, std::vector<std::string> point,
                const std::filesystem::path& share_folder) {
  if (pipeline.command) {
    const std::string text =
        fmt::format("{}\n{}\n{}", pipeline.command.identity, fmt::join(pipeline.assignments, "\n"),
                    fmt::join(point, "\n"));
    return {pipeline, std::move(point), "command", files::sha256_of_text(text)};
  }
  pipeline::PresetRequest request{pipeline.preset, pipeline.config_files, pipeline.assignments};
  request.assignments.insert(request.assignments.end(), point.begin(), point.end());
  try {
    const pipeline::Preset preset = pipeline::load_preset(request, share_folder);
    std::string digest = pipeline::configuration_sha256(pipeline::resolve_settings(preset));
    return {pipeline, std::move(point), preset.resolved.scalar("estimator").value_or(""),
            std::move(digest)};
  } catch (const files::InputError& error) {
    throw plan_error(pipeline.origin, "settings that the preset takes together", error.what());
  }
}

/// The recording's, and over them the pipeline's.
std::vector<std::string> statements_about(const PlannedRecording& recording,
                                          const Variant& variant) {
  std::vector<std::string> statements = recording.statements;
  const auto& more = variant.pipeline.statements;
  statements.insert(statements.end(), more.begin(), more.end());
  return statements;
}

using AddWords = std::function<void(const char* option, const std::string& value)>;

/// How the poses of a command are taken over.
void add_import(const PlannedPipeline& pipeline, const AddWords& add,
                std::vector<std::string>& words) {
  const PlannedCommand& command = pipeline.command;
  add("--name", pipeline.name);
  add("--format", command.format);
  if (!command.columns.empty()) add("--columns", command.columns);
  if (!command.topic.empty()) add("--topic", command.topic);
  add("--frame", command.frame);
  if (!command.extrinsic.empty()) {
    // With "=": the first number may be negative.
    words.push_back(fmt::format("--extrinsic={}", fmt::join(command.extrinsic, ",")));
  }
  if (!command.time_offset.empty()) words.push_back("--time-offset=" + command.time_offset);
  add("--max-gap", fmt::format("{}", command.max_gap_s));
  if (!command.deskew) words.emplace_back("--no-deskew");
  add("--timing", kCommandCost);
  words.emplace_back("--paths-as-given");  // from the run's folder, which gets its name later
}

void add_preset(const Variant& variant, const AddWords& add) {
  add("--pipeline", variant.pipeline.preset);
  for (const auto& file : variant.pipeline.config_files) add("--config", file.string());
  for (const std::string& assignment : variant.pipeline.assignments) add("--set", assignment);
  for (const std::string& assignment : variant.settings) add("--set", assignment);
}

std::vector<std::string> run_arguments(const Plan& plan, const PlannedRecording& recording,
                                       const Variant& variant) {
  const bool is_command = static_cast<bool>(variant.pipeline.command);
  // The run works inside its own folder, so that its command holds wherever that is moved to.
  std::vector<std::string> words{"run", recording.path.string(), "-o", kRunOutput};
  if (is_command) {
    words = {"import", Job::kTrajectory, "--recording", recording.path.string(), "-o", kRunOutput};
  }
  const auto add = [&](const char* option, const std::string& value) {
    words.insert(words.end(), {option, value});
  };
  if (is_command) {
    add_import(variant.pipeline, add, words);
  } else {
    add_preset(variant, add);
  }
  if (!recording.statements_file.empty()) {
    add("--recording-config", recording.statements_file.string());
  }
  for (const std::string& statement : statements_about(recording, variant)) {
    add("--recording", statement);
  }
  if (!recording.reference.empty()) add("--reference", recording.reference.string());
  if (!recording.reference_frame.empty()) add("--reference-frame", recording.reference_frame);
  if (!recording.checkpoints.empty()) add("--checkpoints", recording.checkpoints.string());
  if (!recording.point.empty()) {
    words.push_back(fmt::format("--point={}", fmt::join(recording.point, ",")));
  }
  if (recording.points_time_offset_s != 0) {
    words.push_back(fmt::format("--points-time-offset={}", recording.points_time_offset_s));
  }
  if (recording.first > 0) add("--first", std::to_string(recording.first));
  if (recording.last >= 0) add("--last", std::to_string(recording.last));
  if (!is_command) add("--threads", std::to_string(plan.limits.threads));
  words.emplace_back("--no-hash");  // the batch has digested each recording, once
  if (!plan.reports) words.emplace_back("--no-report");
  if (plan.is_private) words.emplace_back(kPrivate);
  return words;
}

std::string identity_of(const Plan& plan, const PlannedRecording& recording,
                        const std::string& recording_sha256, const Variant& variant, int repeat,
                        const std::string& program) {
  std::string text = fmt::format(
      "program {}\nrecording {}\nstatements {}\nreference_frame {}\nframes {} {}\nestimator {}\n"
      "configuration {}\nthreads {}\nreport {}\n",
      program, recording_sha256, fmt::join(statements_about(recording, variant), "; "),
      recording.reference_frame, recording.first, recording.last, variant.estimator,
      variant.configuration_sha256, plan.limits.threads, plan.reports);
  if (!recording.checkpoints.empty()) {
    text += fmt::format("checkpoints {} {} {}\n", files::sha256_of_file(recording.checkpoints),
                        fmt::join(recording.point, " "), recording.points_time_offset_s);
  }
  if (plan.is_private) text += "private\n";  // a run that tells more does not serve
  return text + fmt::format("repeat {}\n", repeat);
}

/// What is started first, for a program that is not ours.
void add_command(const Plan& plan, const PlannedRecording& recording, const Variant& variant,
                 Job& job) {
  CommandPlaces places;
  places.recording = recording.path;
  places.converted = recording.converted;
  places.plan_folder = plan.file.parent_path();
  places.threads = plan.limits.threads;
  places.settings = variant.pipeline.assignments;
  places.settings.insert(places.settings.end(), variant.settings.begin(), variant.settings.end());
  job.command = expanded(variant.pipeline.command, places);
  job.trajectory = variant.pipeline.command.trajectory;
  job.in_container = static_cast<bool>(variant.pipeline.command.container);
}

json to_json(const Job& job) {
  json line{{"id", job.id},
            {"identity", job.identity},
            {"recording", job.recording},
            {"pipeline", job.pipeline},
            {"settings", job.settings},
            {"repeat", job.repeat},
            {"arguments", job.arguments},
            {"time_s", job.limits.time_s},
            {"memory_mb", job.limits.memory_mb},
            {"threads", job.limits.threads},
            {"attempts", job.limits.attempts}};
  if (job.command.empty()) return line;
  line["command"] = job.command;
  line["in_container"] = job.in_container;
  line["trajectory"] = job.trajectory;
  return line;
}

Job job_of(const files::JsonValue& line) {
  Job job;
  job.id = line["id"].text();
  job.identity = line["identity"].text();
  job.recording = line["recording"].text();
  job.pipeline = line["pipeline"].text();
  job.settings = line["settings"].texts();
  job.repeat = line["repeat"].small_integer();
  job.arguments = line["arguments"].texts();
  job.limits.time_s = line["time_s"].number();
  job.limits.memory_mb = line["memory_mb"].number();
  job.limits.threads = line["threads"].small_integer();
  job.limits.attempts = line["attempts"].small_integer();
  if (!line.has("command")) return job;
  job.command = line["command"].text();
  job.in_container = line.has("in_container") && line["in_container"].boolean();
  job.trajectory = line["trajectory"].text();
  return job;
}

}  // namespace

bool Job::is_private() const {
  return std::find(arguments.begin(), arguments.end(), kPrivate) != arguments.end();
}

std::string Job::variant() const {
  return settings.empty() ? pipeline : fmt::format("{} {}", pipeline, fmt::join(settings, " "));
}

std::string Job::title() const {
  return fmt::format("{}, {}{}", recording, variant(),
                     repeat > 1 ? fmt::format(", repeat {}", repeat) : "");
}

std::vector<Job> make_jobs(const Plan& plan, const RecordingDigests& recordings,
                           const std::string& program, const std::filesystem::path& share_folder) {
  std::vector<Variant> variants;
  for (const PlannedPipeline& pipeline : plan.pipelines) {
    for (auto& point : grid_points(pipeline.grid)) {
      variants.push_back(resolve(pipeline, std::move(point), share_folder));
    }
  }
  std::vector<Job> jobs;
  for (const PlannedRecording& recording : plan.recordings) {
    for (const Variant& variant : variants) {
      if (!recording.takes(variant.pipeline.name)) continue;
      for (int repeat = 1; repeat <= plan.repeats; ++repeat) {
        Job job;
        job.identity =
            identity_of(plan, recording, recordings.at(recording.name), variant, repeat, program);
        job.id = files::sha256_of_text(job.identity);
        job.recording = recording.name;
        job.pipeline = variant.pipeline.name;
        job.settings = variant.settings;
        job.repeat = repeat;
        job.arguments = run_arguments(plan, recording, variant);
        job.limits = plan.limits;
        if (variant.pipeline.command) add_command(plan, recording, variant, job);
        jobs.push_back(std::move(job));
      }
    }
  }
  return jobs;
}

std::vector<Job> distinct(const std::vector<Job>& jobs) {
  std::set<std::string_view> seen;
  std::vector<Job> first;
  for (const Job& job : jobs) {
    if (seen.insert(job.id).second) first.push_back(job);
  }
  return first;
}

void write_jobs(const std::filesystem::path& file, const std::vector<Job>& jobs) {
  std::string text;
  for (const Job& job : jobs) text += to_json(job).dump() + "\n";
  files::write_text(file, text);
}

std::vector<Job> read_jobs(const std::filesystem::path& file, std::size_t first,
                           std::size_t count) {
  std::vector<Job> jobs;
  files::LineReader reader(file);
  for (std::size_t number = 0; jobs.size() < count && reader.next(); ++number) {
    if (number < first) continue;
    try {
      jobs.push_back(job_of(files::JsonDocument::parse(reader.line()).root()));
    } catch (const files::InputError& error) {
      throw reader.error("a job with " + error.expected() + " (" + error.place().text + ")",
                         error.found());
    }
  }
  return jobs;
}

}  // namespace traverse::batch
