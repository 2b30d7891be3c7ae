#include <memory>
#include <string>
#include <variant>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "traverse/dataset/open_recording.hpp"
#include "traverse/dataset/recording_survey.hpp"
#include "traverse/plausibility/stream_checks.hpp"

#include "commands.hpp"
#include "json_output.hpp"
#include "odometry_probe.hpp"
#include "recording_formats_report.hpp"
#include "recording_options.hpp"
#include "recording_progress.hpp"
#include "recording_report.hpp"
#include "run_info.hpp"

namespace traverse::app {

namespace {

struct InfoOptions {
  RecordingOptions recording;
  bool formats = false;
  bool all = false;
  std::string json;  ///< path; empty if not given
};

constexpr const char* kInfoExamples = R"(Examples:
  traverse info 2011_09_26_drive_0001_sync
  traverse info drive.rawlog --json drive.json
  traverse info RUN                                    how a run went, and what can be done with it
  traverse info scans --recording sensor=hdl64e_kitti --recording period_s=0.1
  traverse info --formats)";

void list_formats(const InfoOptions& options) {
  if (!options.json.empty()) write_json_output(options.json, recording_formats_json());
  fmt::print("{}", recording_formats_text());
}

void show_run(const InfoOptions& options) {
  const std::string& folder = options.recording.recording;
  if (!options.recording.config.empty() || !options.recording.statements.empty()) {
    throw CLI::ValidationError("--recording", folder + " is a run, not a recording");
  }
  if (!options.json.empty()) write_json_output(options.json, run_json(folder));
  fmt::print("{}", run_text(folder));
}

/// What a recording tells of itself, and how its first seconds are: no more of it is read.
void show_listed(const InfoOptions& options, dataset::Source& source) {
  constexpr std::size_t kMostScans = 5;
  constexpr std::size_t kMostRecords = 2000;
  std::size_t scans = 0;
  std::size_t records = 0;
  dataset::RecordingSurvey survey = dataset::survey(
      source, [](const auto&) {},
      [&](const sensors::Measurement& measurement) {
        scans += std::holds_alternative<std::shared_ptr<const sensors::LidarScan>>(measurement);
        return scans < kMostScans && ++records < kMostRecords;
      });
  if (!options.json.empty()) write_json_output(options.json, recording_json(source, survey, {}));
  fmt::print("{}", listed_text(source, survey));
}

void run_info(const InfoOptions& options) {
  if (is_run_folder(options.recording.recording)) {
    show_run(options);
    return;
  }
  dataset::OpenOptions open_options = options.recording.open_options();
  open_options.wants_measurements = false;
  const auto source = dataset::open_recording(options.recording.recording, open_options);
  if (source->info().is_listed && !options.all) {
    show_listed(options, *source);
    return;
  }
  RecordingProgress progress("reading", *source);
  plausibility::StreamChecks checks(source->info());
  OdometryProbe probe(*source, checks);
  const dataset::RecordingSurvey survey = dataset::survey(*source, [&](const auto& measurement) {
    progress.update(measurement);
    checks.take(measurement);
    probe.take(measurement);
  });
  progress.finish();
  probe.finish();
  const std::vector<plausibility::Finding> findings = checks.findings();
  if (!options.json.empty()) {
    write_json_output(options.json, recording_json(*source, survey, findings));
  }
  fmt::print("{}", recording_text(*source, survey, findings));
}

}  // namespace

void add_info(CLI::App& app) {
  CLI::App* command = app.add_subcommand("info",
                                         "Shows a run folder, or reads a recording and says what "
                                         "is in it, what is wrong with it, what in it "
                                         "contradicts itself, and what is taken for true about it");
  auto options = std::make_shared<InfoOptions>();
  add_recording_options(*command, options->recording);
  CLI::Option* recording = command->get_option("RECORDING")->required(false);
  command
      ->add_flag("--formats", options->formats,
                 "list the kinds of recording that are read, and how they are recognised")
      ->excludes(recording);
  command->add_flag("--all", options->all,
                    "read all of a bag too, where else its index and first scans are enough");
  command->add_option("--json", options->json, "write all of it to this file too")
      ->option_text("FILE");
  command->footer(kInfoExamples);
  command->callback([options, recording] {
    if (options->formats) {
      list_formats(*options);
      return;
    }
    if (recording->empty()) throw CLI::RequiredError("RECORDING");
    run_info(*options);
  });
}

}  // namespace traverse::app
