#include "traverse/pipeline/run.hpp"

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "traverse/config/settings.hpp"
#include "traverse/dataset/trajectory_files.hpp"
#include "traverse/evaluation/checkpoints.hpp"
#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/files/number_text.hpp"
#include "traverse/mapping/las_export.hpp"
#include "traverse/pipeline/imported_poses.hpp"
#include "traverse/pipeline/run_destination.hpp"
#include "traverse/pipeline/run_digests.hpp"
#include "traverse/pipeline/run_keyframes.hpp"
#include "traverse/pipeline/utm_trajectory.hpp"
#include "traverse/plausibility/stream_checks.hpp"

#include "budget_option.hpp"
#include "command_line.hpp"
#include "commands.hpp"
#include "factor_measurement.hpp"
#include "installed_files.hpp"
#include "interruption.hpp"
#include "progress_bar.hpp"
#include "report_progress.hpp"
#include "run_arguments.hpp"
#include "run_summary.hpp"
#include "standard_streams.hpp"

namespace traverse::app {

namespace {

std::size_t expected_frames(const dataset::Source& source, const pipeline::RunOptions& options) {
  const std::size_t scans = source.info().expected_scans;
  if (scans <= options.first) return 0;
  return std::min(scans - 1, options.last) - options.first + 1;
}

/// What the derivatives of the factors cost on a frame of the run that has a map behind it.
void measure_factors(dataset::Source& source, const pipeline::RunRecord& record,
                     const pipeline::RunFolder& folder) {
  if (record.frames_used < 2) return;
  const std::size_t frame = record.first_frame + std::min(kFramesBefore, record.frames_used - 1);
  source.rewind();
  files::write_text(folder.factor_bench(), to_json(measure_on_recording(source, record.first_frame,
                                                                        frame, kFactorRepeats)));
}

void write_utm(const pipeline::Estimator& estimator, const pipeline::RunFolder& folder) {
  const auto origin = estimator.map_origin();
  if (!origin)
    throw std::runtime_error("--utm: no GNSS fix gives the position of this trajectory on Earth");
  const auto path = dataset::read_trajectory(folder.trajectory(), dataset::TrajectoryFormat::kTum);
  const pipeline::UtmTrajectory utm = pipeline::to_utm(path, *origin);
  dataset::write_tum(folder.utm_trajectory(), utm.T_utm_body);
  fmt::print("UTM        zone {}{}, {}\n", utm.zone, utm.is_north ? 'N' : 'S',
             folder.utm_trajectory().filename().string());
}

/// The points of the map, if it has any, in the frame that is the most use elsewhere.
void write_las(const pipeline::RunFolder& folder) {
  if (!std::filesystem::exists(folder.map_points())) {
    fmt::print("no {}: the run has no map\n", folder.las().filename().string());
    return;
  }
  const auto result = mapping::export_las(folder.map_points(), pipeline::read_origin(folder),
                                          mapping::LasFrame::kGrid, folder.las());
  fmt::print("{}: {} points, {}\n", folder.las().filename().string(), result.points, result.frame);
}

/// With a map, the preset's odometry is followed in it.
pipeline::PresetRequest preset_request(const RunArguments& arguments,
                                       const std::filesystem::path& share) {
  if (arguments.map.empty()) return arguments.preset;
  const pipeline::RunFolder map{std::filesystem::absolute(arguments.map)};
  return pipeline::localizing_in(map.keyframes(), arguments.start, arguments.preset, share);
}

/// A wrong preset or setting is wrong usage, told before anything is opened.
pipeline::Preset checked_preset(const RunArguments& arguments, const std::filesystem::path& share) {
  if (arguments.imported) return pipeline::imported_preset(arguments.imported->name, {});
  try {
    pipeline::Preset preset = pipeline::load_preset(preset_request(arguments, share), share);
    print_notes(pipeline::settings_notes(preset));
    return preset;
  } catch (const files::InputError& error) {
    throw CLI::ValidationError(error.what());
  }
}

/// How far a run is, for who asks it to end.
class RunStage {
 public:
  void set_frames(std::size_t done) { frames_ = done; }
  void set_writing() { is_writing_ = true; }
  void set_drawing() { is_drawing_ = true; }

  /// What it does when it is asked; called by another thread.
  std::string on_stop() const {
    const char* what = is_drawing_   ? "the run is complete; its report is left out"
                       : is_writing_ ? "writing what was estimated, without pictures"
                                     : "writing what is done so far, without pictures";
    return fmt::format("stopping: {}, {}; Ctrl-C again ends at once", what,
                       files::plural(frames_, "frame"));
  }

 private:
  std::atomic<std::size_t> frames_{0};
  std::atomic<bool> is_writing_{false};
  std::atomic<bool> is_drawing_{false};
};

/// What is made of a run's folder before it gets its name. What fails is kept in mind and the rest
/// is done all the same.
class RunExtras {
 public:
  RunExtras(const RunArguments& arguments, const pipeline::RunFolder& folder,
            const OrderlyStop& stop)
      : arguments_(arguments), folder_(folder), stop_(stop) {}

  void make(dataset::Source& source, const pipeline::Estimator& estimator,
            pipeline::RunRecord& record, const std::filesystem::path& templates,
            const std::filesystem::path& place) {
    if (arguments_.utm || arguments_.las) {
      attempt([&] {
        if (arguments_.utm) write_utm(estimator, folder_);
        if (arguments_.las) write_las(folder_);
        pipeline::add_digests(folder_, record.files);
        pipeline::write_record(folder_, record);
      });
    }
    if (arguments_.bench_factors && is_complete(record.status)) {
      attempt([&] { measure_factors(source, record, folder_); });
    }
    if (arguments_.report) {
      attempt([&] { write_report(templates, place); });
    } else if (arguments_.budget) {
      attempt([&] { budget_ = report::check_budget(*arguments_.budget, folder_.path); });
    }
  }

  bool has_report() const { return has_report_; }
  const std::optional<report::BudgetResult>& budget() const { return budget_; }
  /// Why something is missing; empty if nothing is.
  const std::string& failure() const { return failure_; }

 private:
  template <typename Step>
  void attempt(const Step& step) {
    if (stop_.requested()) return;
    try {
      step();
    } catch (const report::ReportStopped&) {  // NOLINT(bugprone-empty-catch): as it was asked to
    } catch (const std::bad_alloc&) {
      if (failure_.empty()) failure_ = "out of memory: the system gave no more";
    } catch (const std::exception& error) {
      if (failure_.empty()) failure_ = error.what();
    }
  }

  void write_report(const std::filesystem::path& templates, const std::filesystem::path& place) {
    report::RunReportOptions options;
    options.budget = arguments_.budget;
    options.folder_on_page = place;
    options.stop = &stop_.requested();
    budget_ = write_report_with_progress(folder_.path, templates, options);
    has_report_ = true;
  }

  const RunArguments& arguments_;
  const pipeline::RunFolder& folder_;
  const OrderlyStop& stop_;
  bool has_report_ = false;
  std::optional<report::BudgetResult> budget_;
  std::string failure_;
};

/// Options that are statements and settings by other names.
void add_statements_and_settings(RunArguments& arguments) {
  if (!arguments.reference.empty()) {
    const std::string file = std::filesystem::absolute(arguments.reference).string();
    arguments.recording.statements.push_back("reference.file=" + config::to_text(file));
  }
  if (!arguments.reference_frame.empty()) {
    arguments.recording.statements.push_back("reference.frame=" + arguments.reference_frame);
  }
  if (!arguments.accepted.empty()) {
    arguments.recording.statements.push_back(
        fmt::format("accept={}", fmt::join(arguments.accepted, " ")));
  }
  if (!arguments.gnss_outages.empty()) {
    arguments.preset.assignments.push_back("outage.spells_s=[" + arguments.gnss_outages + "]");
  }
  if (arguments.slam) {
    arguments.preset.assignments.push_back(*arguments.slam ? "slam.use=true" : "slam.use=false");
  }
}

std::vector<pipeline::RunDestination::Input> inputs_of(const RunArguments& arguments) {
  std::vector<pipeline::RunDestination::Input> inputs{
      {"the recording", arguments.recording.recording}};
  if (!arguments.map.empty()) inputs.push_back({"the map", arguments.map});
  if (arguments.imported) inputs.push_back({"the trajectory", arguments.imported->trajectory});
  return inputs;
}

pipeline::RunOptions run_options(const RunArguments& arguments,
                                 const std::vector<std::string>& command) {
  pipeline::RunOptions options;
  options.first = arguments.first;
  if (arguments.last) options.last = *arguments.last;
  options.threads = arguments.threads;
  options.hash_recording = arguments.hash;
  options.is_private = arguments.is_private;
  options.command = command;
  return options;
}

/// Writes the residuals at surveyed points; these are read at once, so that what is wrong with them
/// is told before the run.
std::function<void(const geometry::Trajectory&, const pipeline::RunFolder&)> writer_of_checkpoints(
    const RunArguments& arguments) {
  evaluation::CheckpointOptions options;
  if (!arguments.point.empty()) {
    options.p_body = {arguments.point[0], arguments.point[1], arguments.point[2]};
  }
  options.time_offset_s = arguments.points_time_offset_s;
  return [options, points = evaluation::read_checkpoints(*arguments.checkpoints)](
             const geometry::Trajectory& T_map_body, const pipeline::RunFolder& folder) {
    files::write_text(
        folder.path / evaluation::kCheckpointsFile,
        evaluation::to_json(evaluation::evaluate_checkpoints(T_map_body, points, options)));
  };
}

/// With `-o .` the working directory is replaced: this program enters it again, and the user's
/// shell has to.
class WorkingDirectory {
 public:
  void enter_again_if_replaced() const {
    std::error_code failure;
    if (std::filesystem::exists(std::filesystem::current_path(failure), failure)) return;
    std::filesystem::current_path(path_, failure);
    print_message("traverse: the working directory was replaced by the new run: `cd \"$PWD\"`\n");
  }

 private:
  std::filesystem::path path_ = std::filesystem::current_path();
};

/// A run that is lost came to its end all the same: that it is lost is what it has to tell.
pipeline::RunDestination::Outcome outcome_of(const pipeline::RunRecord& record) {
  using Outcome = pipeline::RunDestination::Outcome;
  return is_complete(record.status) ? Outcome::kComplete : Outcome::kPartial;
}

/// Gives the run its name, says what came of it, and throws what the exit status is to tell.
void finish_run(const RunArguments& arguments, pipeline::RunDestination& destination,
                const pipeline::RunRecord& record, const RunExtras& extras,
                const OrderlyStop& stop) {
  using pipeline::RunStatus;
  using Outcome = pipeline::RunDestination::Outcome;
  const bool has_frames = record.frames_used > 0;
  const bool had_run = destination.has_earlier_run();
  const Outcome outcome = outcome_of(record);
  const std::string earlier = destination.given().string();
  if (!has_frames && had_run) {
    const std::string kept = fmt::format("; {} is the earlier run, as it was", earlier);
    if (!stop.requested()) throw std::runtime_error(record.reason + kept);
    fmt::print("interrupted: {}{}\n", record.reason, kept);
    throw CLI::RuntimeError(stop.exit_status());
  }
  const WorkingDirectory working_directory;
  const pipeline::RunFolder folder = destination.finish(outcome, arguments.force);
  working_directory.enter_again_if_replaced();
  const bool beside = folder.path != destination.given();
  if (has_frames && record.status != RunStatus::kFailed) {
    print_run_summary(record, folder, extras.has_report());
  }
  const std::string stands =
      beside ? fmt::format("this run stands in {}; {} is the earlier one, as it was",
                           folder.path.string(), earlier)
             : fmt::format("it stands in {}", folder.path.string());
  if (stop.requested()) {
    if (has_frames && arguments.report) {
      fmt::print("no report was made: `traverse report {}` makes it\n", folder.path.string());
    }
    fmt::print("interrupted: {}, {}; {}\n",
               is_complete(record.status) ? "the run is complete" : record.reason,
               files::plural(record.frames_used, "frame"), stands);
    throw CLI::RuntimeError(stop.exit_status());
  }
  if (record.status == RunStatus::kFailed) {
    if (!has_frames) throw std::runtime_error(record.reason);
    throw std::runtime_error(fmt::format("{}; {} before that {} kept: {}", record.reason,
                                         files::plural(record.frames_used, "frame"),
                                         record.frames_used == 1 ? "is" : "are", stands));
  }
  if (!destination.why_beside().empty()) {
    throw std::runtime_error(
        fmt::format("the run is complete, but could not take its place ({}); {}",
                    destination.why_beside(), stands));
  }
  if (record.status == RunStatus::kLost) {
    throw std::runtime_error(
        fmt::format("the run is lost. {} Everything is written: {}",
                    record.health ? record.health->reasons.front().text : record.reason, stands));
  }
  if (!record.evaluation_error.empty()) {
    throw std::runtime_error("the run is complete, but it could not be compared with " +
                             record.reference_file.value_or("its reference") + ": " +
                             record.evaluation_error);
  }
  if (extras.budget()) require_kept(*extras.budget());
}

constexpr const char* kRunExamples = R"(Examples:
  traverse run 2011_09_26_drive_0001 -o RUN            a recording that states its own facts
  traverse run sequences/00 -o RUN --last 499          the first 500 frames of KITTI odometry 00
  traverse run drive.rawlog -o RUN --pipeline floam --set solver.line_residual=vector
  traverse run drive -o RUN --no-slam                  odometry alone, no loops
  traverse run log.txt -o RUN --pipeline gins-window --drop-gnss 10,30
                                                       GNSS, IMU and wheels; what it is worth without
  traverse run drive -o RUN --reference truth.tum --threads 4
Ctrl-C ends the run in order: what is done so far is written and evaluated, without pictures; the exit
status is 130. An earlier run in RUN is replaced when the new one is complete; one that was interrupted
or failed stands beside it as RUN.interrupted (--force: replaces it). Files in RUN that are not a
run's own stay, and a folder that is not an earlier run is refused.
`traverse pipelines` lists the presets, `traverse pipelines traverse` their settings.)";

constexpr const char* kLocalizeExamples = R"(Examples:
  traverse run drive.rawlog -o MAP                              a map, with its keyframes
  traverse localize other.rawlog --map MAP -o RUN               searched for in all of the map
  traverse localize other.rawlog --map MAP -o RUN --start 12,0,1.5,90
The trajectory is in the map's frame. Where the place was found or lost stands in the report (what was
decided) and in frames.csv, columns located and fits_map.)";

std::vector<std::string> contradiction_codes() {
  std::vector<std::string> codes;
  for (const auto& check : plausibility::list_checks()) codes.push_back(check.code);
  return codes;
}

/// The options that every command has which estimates a recording.
CLI::App* add_estimating(CLI::App& app, const std::string& name, const std::string& description,
                         const std::shared_ptr<RunArguments>& arguments) {
  CLI::App* run = app.add_subcommand(name, description);
  add_recording_options(*run, arguments->recording);
  add_run_folder_options(*run, *arguments);
  run->add_option("--pipeline", arguments->preset.name, "preset, or a YAML file in its form")
      ->capture_default_str();
  run->add_option("--config", arguments->preset.config_files, "YAML file laid over the preset")
      ->type_name("FILE")
      ->check(CLI::ExistingFile)
      ->allow_extra_args(false);
  run->add_option("--set", arguments->preset.assignments, "one setting, stronger than any file")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  run->add_option("--threads", arguments->threads, "threads; the result does not depend on it")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  run->add_flag("--utm", arguments->utm,
                "write the trajectory in UTM coordinates too (RUN/trajectory_utm.tum)");
  run->add_flag(
      "--las", arguments->las,
      "the map's points as LAS 1.4 too (RUN/map.las), in the UTM zone of a run with GNSS");
  run->callback([arguments] { make_run(*arguments, command_line()); });
  return run;
}

}  // namespace

void add_run_folder_options(CLI::App& command, RunArguments& arguments) {
  command.add_option("-o,--output", arguments.folder, "run folder to write")
      ->required()
      ->type_name("RUN");
  command.add_flag("--force", arguments.force,
                   "replace an earlier run even if this one is interrupted or fails");
  command.add_option("--first", arguments.first, "first frame, counted from 0")
      ->capture_default_str();
  command.add_option("--last", arguments.last, "last frame, included");
  command
      .add_option(
          "--accept", arguments.accepted,
          "go on although the recording contradicts itself in this way; the code is in the message")
      ->type_name("CODE")
      // Without a description: of --help the list of all codes would be the longest part.
      ->check(CLI::IsMember(contradiction_codes()).description(""))
      ->allow_extra_args(false);
  command
      .add_option("--checkpoints", arguments.checkpoints,
                  "surveyed points, a prism that was followed or fixes: a CSV file as of evaluate")
      ->type_name("FILE")
      ->check(CLI::ExistingFile);
  command
      .add_option("--point", arguments.point,
                  "what stood over the checkpoints, in the body: an antenna, a prism")
      ->type_name("X,Y,Z")
      ->delimiter(',')
      ->expected(3);
  command
      .add_option("--points-time-offset", arguments.points_time_offset_s,
                  "added to the stamps of the checkpoints")
      ->type_name("SECONDS")
      ->check(CLI::Range(-9.2e9, 9.2e9).description(""));
  command.add_flag("!--no-report", arguments.report, "no pictures and no report.html");
  add_budget_option(command, arguments.budget);
  command.add_flag("--private", arguments.is_private,
                   "run.json and the page do not tell whose machine made the run, nor paths on it");
  command.add_flag("!--no-hash", arguments.hash, "do not compute the recording's SHA-256");
}

void make_run(RunArguments& arguments, const std::vector<std::string>& command) {
  if (arguments.last && *arguments.last < arguments.first) {
    throw CLI::ValidationError("--last", "is before --first");
  }
  add_statements_and_settings(arguments);
  const InstalledFiles installed = find_installed_files();
  pipeline::Preset preset = checked_preset(arguments, installed.share);
  if (arguments.budget && report::require_valid_budget(*arguments.budget)) {
    arguments.is_private = true;
  }
  pipeline::RunDestination destination(arguments.folder, inputs_of(arguments));
  const std::unique_ptr<dataset::Source> source = arguments.recording.open();
  if (arguments.imported) {
    preset = pipeline::imported_preset(arguments.imported->name,
                                       arguments.imported->assignments(*source));
  }
  pipeline::Pipeline pipeline = pipeline::make_pipeline(preset, source->info(), arguments.threads);
  pipeline::RunOptions options = run_options(arguments, command);
  options.statements = arguments.recording.lasting_statements();
  options.place = destination.given();
  if (arguments.checkpoints) options.also_write = writer_of_checkpoints(arguments);

  RunStage stage;
  const OrderlyStop stop([&] { return stage.on_stop(); });
  const pipeline::RunFolder folder = destination.begin();
  ProgressBar bar(pipeline.name, expected_frames(*source, options), "frames");
  pipeline::RunObserver observer;
  observer.stop = &stop.requested();
  observer.frame = [&](std::size_t done) {
    stage.set_frames(done);
    bar.update(done, source->info().expected_scans > 0 ? std::nullopt : source->share_read());
  };
  observer.stage = [&](const std::string&) {
    stage.set_writing();
    bar.finish();
  };
  pipeline::RunRecord record = pipeline::run(*source, pipeline, folder, options, observer);

  const auto place = [&] { return destination.place(outcome_of(record), arguments.force); };
  const std::string reason = record.reason;
  record.reason = destination.in_words(reason, place());
  if (record.reason != reason) pipeline::write_record(folder, record);
  RunExtras extras(arguments, folder, stop);
  if (record.frames_used > 0) {
    if (is_complete(record.status)) stage.set_drawing();
    extras.make(*source, *pipeline.estimator, record, installed.templates, place());
  }
  if (!extras.failure().empty() && is_complete(record.status)) {
    record.status = pipeline::RunStatus::kFailed;
    record.reason = destination.in_words(extras.failure(), place());
    pipeline::write_record(folder, record);
  }
  finish_run(arguments, destination, record, extras, stop);
}

void add_run(CLI::App& app) {
  auto arguments = std::make_shared<RunArguments>();
  CLI::App* run = add_estimating(
      app, "run", "estimate the trajectory of a recording; write map, pictures and report",
      arguments);
  run->footer(kRunExamples);
  run->add_option("--reference", arguments->reference, "reference trajectory (TUM, KITTI, EuRoC)")
      ->type_name("FILE")
      ->check(CLI::ExistingFile);
  run->add_option("--reference-frame", arguments->reference_frame,
                  "what moves along the reference: body, lidar or camera")
      ->check(CLI::IsMember({"body", "lidar", "camera"}));
  run->add_flag_function(
      "--slam,!--no-slam", [arguments](std::int64_t times) { arguments->slam = times > 0; },
      "close loops over the odometry, or not; else as the preset says");
  run->add_flag("--bench-factors", arguments->bench_factors,
                "measure analytic, automatic and numeric derivatives on a frame of the run");
  run->add_option("--drop-gnss", arguments->gnss_outages,
                  "withhold fixes for GNSS outages of these lengths in seconds, and report the "
                  "error after each")
      ->type_name("10,30,60");
}

void add_localize(CLI::App& app) {
  auto arguments = std::make_shared<RunArguments>();
  CLI::App* localize = add_estimating(
      app, "localize", "follow a recording in the map of an earlier run; write a run folder",
      arguments);
  localize->footer(kLocalizeExamples);
  localize->add_option("--map", arguments->map, "run folder with keyframes.simplemap")
      ->required()
      ->type_name("RUN")
      ->check(CLI::ExistingDirectory);
  localize
      ->add_option("--start", arguments->start,
                   "where the vehicle is at the first scan; without it: searched for")
      ->type_name("X,Y,Z,YAW_DEG")
      ->delimiter(',')
      ->expected(4);
}

}  // namespace traverse::app
