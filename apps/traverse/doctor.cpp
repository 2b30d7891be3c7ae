#include <algorithm>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "traverse/files/input_error.hpp"
#include "traverse/pipeline/preset.hpp"
#include "traverse/pipeline/registry.hpp"
#include "traverse/plausibility/diagnosis.hpp"
#include "traverse/plausibility/stream_checks.hpp"

#include "commands.hpp"
#include "installed_files.hpp"
#include "json_output.hpp"
#include "odometry_probe.hpp"
#include "recording_options.hpp"
#include "recording_progress.hpp"

namespace traverse::app {

namespace {

using plausibility::Diagnosis;
using plausibility::Effect;

struct DoctorOptions {
  RecordingOptions recording;
  std::string pipeline;  ///< empty: the one that `run` takes
  std::string json;      ///< path; empty if not given
};

constexpr const char* kDoctorExamples = R"(Examples:
  traverse doctor DRIVE                                what keeps a run from working, and what to do next
  traverse doctor drive.rawlog --pipeline gins-window
  traverse doctor scans --recording lidar.time_unit=us   whether a statement mends it
  traverse doctor DRIVE --json findings.json

A line a finding: fails (run would fail), worse or note; its code; what it means for which command; what to do
next. Exit status: 1 if run would fail, else 0. Nothing is written to the recording.)";

/// What a run's estimator weighs the findings by; why it cannot be made, if it cannot.
struct Estimation {
  std::unique_ptr<pipeline::Estimator> estimator;
  std::string why_not;
};

Estimation make_estimation(const DoctorOptions& options, const dataset::RecordingInfo& recording) {
  pipeline::PresetRequest request;
  if (!options.pipeline.empty()) request.name = options.pipeline;
  const pipeline::Preset preset = pipeline::load_preset(request, find_installed_files().share);
  try {
    return {pipeline::make_pipeline(preset, recording, 1).estimator, ""};
  } catch (const std::runtime_error& error) {
    return {nullptr, error.what()};
  }
}

Diagnosis lost_beginning(const OdometryProbe::Lost& lost) {
  return {"run_lost", lost.is_whole ? Effect::kFails : Effect::kWorse,
          fmt::format("{}: {}",
                      lost.is_whole ? "a run of it is lost"
                                    : fmt::format("its first {} frames are lost", lost.frames),
                      lost.why),
          "run: the path is not one that the vehicle drove",
          "see docs/run-folder.md#health, and what stands below; another pipeline may hold: "
          "traverse pipelines"};
}

std::vector<Diagnosis> examine(const DoctorOptions& options) {
  std::unique_ptr<dataset::Source> source;
  try {
    source = options.recording.open();
  } catch (const files::InputError& error) {
    return {plausibility::diagnose_unopened(options.recording.recording, error)};
  }
  RecordingProgress progress("reading", *source);
  plausibility::StreamChecks checks(source->info());
  OdometryProbe probe(*source, checks, options.pipeline);
  const dataset::RecordingSurvey survey = dataset::survey(*source, [&](const auto& measurement) {
    progress.update(measurement);
    checks.take(measurement);
    probe.take(measurement);
  });
  progress.finish();
  probe.finish();
  const Estimation estimation = make_estimation(options, source->info());
  std::vector<plausibility::Finding> findings = checks.findings();
  for (plausibility::Finding& finding : findings) {
    const sensors::MountedSensor* sensor = source->info().rig.find(finding.sensor);
    const bool matters = sensor == nullptr || estimation.estimator == nullptr ||
                         estimation.estimator->depends_on(sensor->kind);
    if (!matters) finding.severity = plausibility::Severity::kWarn;
  }
  std::vector<Diagnosis> diagnoses =
      plausibility::diagnose(*source, survey, findings, estimation.why_not);
  if (const auto lost = probe.lost(); lost && estimation.why_not.empty()) {
    diagnoses.insert(diagnoses.begin(), lost_beginning(*lost));
    std::stable_sort(diagnoses.begin(), diagnoses.end(),
                     [](const auto& a, const auto& b) { return a.effect < b.effect; });
  }
  return diagnoses;
}

std::string diagnoses_json(const std::vector<Diagnosis>& diagnoses) {
  nlohmann::ordered_json findings = nlohmann::ordered_json::array();
  for (const Diagnosis& diagnosis : diagnoses) {
    findings.push_back({{"code", diagnosis.code},
                        {"effect", name_of(diagnosis.effect)},
                        {"found", diagnosis.found},
                        {"means", diagnosis.means},
                        {"action", diagnosis.action}});
  }
  return nlohmann::ordered_json{{"findings", std::move(findings)}}.dump(
             2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) +
         "\n";
}

void run_doctor(const DoctorOptions& options) {
  const std::vector<Diagnosis> diagnoses = examine(options);
  if (!options.json.empty()) write_json_output(options.json, diagnoses_json(diagnoses));
  for (const Diagnosis& diagnosis : diagnoses) fmt::print("{}\n", to_text(diagnosis));
  if (diagnoses.empty()) fmt::print("nothing found\n");
  const bool fails =
      std::any_of(diagnoses.begin(), diagnoses.end(),
                  [](const Diagnosis& diagnosis) { return diagnosis.effect == Effect::kFails; });
  if (fails) throw CLI::RuntimeError(1);
}

}  // namespace

void add_doctor(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "doctor",
      "Reads a recording and says in a line a finding what is wrong with it, for which command, "
      "and what to do next; exit status 1 if a run would fail");
  auto options = std::make_shared<DoctorOptions>();
  add_recording_options(*command, options->recording);
  command->add_option("--pipeline", options->pipeline, "the pipeline that would run")
      ->option_text("NAME");
  command->add_option("--json", options->json, "write the findings to this file too")
      ->option_text("FILE");
  command->footer(kDoctorExamples);
  command->callback([options] { run_doctor(*options); });
}

}  // namespace traverse::app
