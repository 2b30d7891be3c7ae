#include "traverse/plausibility/diagnosis.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "traverse/dataset/foreign_file.hpp"
#include "traverse/dataset/recording_formats.hpp"

namespace traverse::plausibility {

using dataset::Fact;
using sensors::SensorKind;

namespace {

constexpr std::array kDescriptions{
    DiagnosisDescription{"not_found", "there is no such file or folder"},
    DiagnosisDescription{
        "not_a_recording",
        "no reader takes it: its first bytes tell nothing, or it is a folder of recordings"},
    DiagnosisDescription{"cannot_open", "a reader takes it, but it or a statement is wrong"},
    DiagnosisDescription{"no_measurements", "nothing in it can be used"},
    DiagnosisDescription{"no_pipeline", "the pipeline needs what is not in it"},
    DiagnosisDescription{"run_lost", "what was estimated of it is lost, as a run would be"},
    DiagnosisDescription{"deskew_off", "the times of points are not known"},
    DiagnosisDescription{"rings_unknown", "the rings of points are not known"},
    DiagnosisDescription{"records_skipped", "some records cannot be used"},
    DiagnosisDescription{"gaps", "a sensor is silent for more than three intervals"},
    DiagnosisDescription{"clock_step", "the clock was set, or the recording paused"},
    DiagnosisDescription{"reference_refused", "the reference beside it cannot be used"},
    DiagnosisDescription{"not_used", "a file beside it looks as if it belonged to it"},
    DiagnosisDescription{"no_reference", "there is nothing to judge a result by"},
};

bool has_times(const dataset::LidarSurvey& lidar, const sensors::MountedSensor* sensor) {
  if (sensor == nullptr || !sensor->lidar) return true;
  switch (sensor->lidar->time_source) {
    case sensors::TimeSource::kAzimuth:
      return true;
    case sensors::TimeSource::kData:
      return lidar.has_stored_times;
    case sensors::TimeSource::kNone:
      return false;
  }
  return false;
}

/// A fact of that name, or null.
const Fact* fact_called(const dataset::RecordingInfo& info, std::string_view name) {
  const auto found = std::find_if(info.facts.begin(), info.facts.end(),
                                  [&](const Fact& fact) { return fact.name == name; });
  return found == info.facts.end() ? nullptr : &*found;
}

void add_lidar(const dataset::RecordingInfo& info, const dataset::StreamSurvey& stream,
               std::vector<Diagnosis>& diagnoses) {
  const dataset::LidarSurvey& lidar = *stream.lidar;
  const sensors::MountedSensor* sensor = info.rig.find(stream.sensor);
  if (!info.motion_compensated && !has_times(lidar, sensor)) {
    const Fact* field = fact_called(info, "time field");
    diagnoses.push_back(
        {"deskew_off", Effect::kWorse,
         fmt::format("{}: no times of points{}", stream.sensor,
                     field != nullptr ? " (" + field->reason + ")" : ""),
         "run, localize, map: scans are not deskewed and maps are blurred in motion",
         field != nullptr ? "state the field: --recording lidar.time_field=NAME"
                          : "name a profile that tells times: --recording sensor=NAME, or state "
                            "--recording motion_compensated=true"});
  }
  if (!lidar.rings) {
    diagnoses.push_back({"rings_unknown", Effect::kNote,
                         fmt::format("{}: {}", stream.sensor, lidar.why_no_rings),
                         "run: aloam, floam and loam need rings, the others do not",
                         "name a profile that tells rings: --recording sensor=NAME"});
  }
}

void add_streams(const dataset::RecordingInfo& info, const dataset::RecordingSurvey& survey,
                 std::vector<Diagnosis>& diagnoses) {
  for (const dataset::StreamSurvey& stream : survey.streams) {
    if (stream.lidar) add_lidar(info, stream, diagnoses);
    if (stream.gaps.empty()) continue;
    const auto longest =
        std::max_element(stream.gaps.begin(), stream.gaps.end(),
                         [](const auto& a, const auto& b) { return a.seconds < b.seconds; });
    diagnoses.push_back({"gaps", Effect::kWorse,
                         fmt::format("{}: {} gaps, the longest {:.3f} s from {}", stream.sensor,
                                     stream.gaps.size(), longest->seconds, to_text(longest->begin)),
                         "run: the motion within is not known and may begin a new segment",
                         "run a part without them: --first N --last N"});
  }
}

void add_facts(const dataset::Source& source, std::vector<Diagnosis>& diagnoses) {
  const dataset::RecordingInfo& info = source.info();
  for (const Fact& fact : info.facts) {
    if (dataset::is_clock_step(fact)) {
      diagnoses.push_back({"clock_step", Effect::kWorse,
                           fmt::format("{}: {}", fact.name, fact.value), "run: " + fact.reason,
                           "see what was made of it: traverse info " + info.path.string()});
    } else if (fact.name == dataset::kNotUsed) {
      diagnoses.push_back({"not_used", Effect::kNote, fact.value,
                           "run, evaluate: nothing is made of it", fact.reason});
    }
  }
  if (!info.reference_refused.empty()) {
    diagnoses.push_back({"reference_refused", Effect::kWorse, info.reference_refused,
                         "run, evaluate: results are not judged",
                         "mend the file, or name another one: --reference FILE"});
  } else if (!source.reference()) {
    diagnoses.push_back({"no_reference", Effect::kNote, "no reference trajectory",
                         "run, batch, compare: results are not judged",
                         "name one: --reference FILE"});
  }
}

void add_skipped(const dataset::Source& source, std::vector<Diagnosis>& diagnoses) {
  for (const auto& [reason, count] : source.skipped().by_reason()) {
    std::string found = fmt::format("{} x {}", count.count, reason);
    if (!count.first_places.empty()) found += ", first " + count.first_places.front();
    diagnoses.push_back({"records_skipped", Effect::kWorse, std::move(found),
                         "every command: they are left out",
                         "look at the first of them: traverse info " + source.info().path.string() +
                             " --json FILE has ten places"});
  }
}

}  // namespace

std::string_view name_of(Effect effect) {
  switch (effect) {
    case Effect::kFails:
      return "fails";
    case Effect::kWorse:
      return "worse";
    case Effect::kNote:
      return "note";
  }
  return "unknown";
}

std::string to_text(const Diagnosis& diagnosis) {
  std::string text =
      fmt::format("{:<6} {}: {}; {}. Next: {}", name_of(diagnosis.effect), diagnosis.code,
                  diagnosis.found, diagnosis.means, diagnosis.action);
  std::replace(text.begin(), text.end(), '\n', ' ');  // one line, whatever an error says
  return text;
}

Diagnosis diagnose_unopened(const std::filesystem::path& path, const files::InputError& error) {
  std::error_code failure;
  if (!std::filesystem::exists(path, failure)) {
    return {"not_found", Effect::kFails, error.what(), "every command: nothing to open",
            "give the path of a recording"};
  }
  const bool is_unknown = error.expected().starts_with("a recording: ");
  if (is_unknown && std::filesystem::is_directory(path, failure)) {
    const auto recordings = dataset::recordings_in(path);
    if (!recordings.empty()) {
      return {"not_a_recording", Effect::kFails, path.string() + ": a folder with recordings in it",
              "every command: it opens one of them",
              "open one of them: " + recordings.front().string()};
    }
  }
  const auto foreign = dataset::foreign_format(path);
  if (foreign && (is_unknown || std::filesystem::is_regular_file(path, failure))) {
    return {std::string(foreign->code), Effect::kFails,
            fmt::format("{}: {}", path.string(), foreign->name),
            "every command: no reader knows it", std::string(foreign->action)};
  }
  if (is_unknown) {
    return {"not_a_recording", Effect::kFails,
            fmt::format("{}: {}", path.string(), error.found().substr(0, error.found().find("; "))),
            "every command: no reader knows it", "see what is read: traverse info --formats"};
  }
  return {"cannot_open", Effect::kFails, error.what(), "every command: it cannot be opened",
          "mend what is named"};
}

std::vector<Diagnosis> diagnose(const dataset::Source& source,
                                const dataset::RecordingSurvey& survey,
                                const std::vector<Finding>& findings,
                                const std::string& why_no_pipeline) {
  std::vector<Diagnosis> diagnoses;
  if (survey.measurements() == 0) {
    diagnoses.push_back(
        {"no_measurements", Effect::kFails,
         fmt::format("no record that can be used, {} skipped", source.skipped().total()),
         "every command: there is nothing to work on", "mend what is skipped, below"});
  }
  if (!why_no_pipeline.empty()) {
    const bool has_imu = source.info().rig.first(SensorKind::kImu) != nullptr;
    diagnoses.push_back({"no_pipeline", Effect::kFails, why_no_pipeline,
                         "run: this pipeline cannot work on it",
                         has_imu ? "choose one for IMU and GNSS: --pipeline gins-window"
                                 : "see what each needs: traverse pipelines"});
  }
  for (const Finding& finding : findings) {
    const bool refuses = finding.severity == Severity::kRefuse && !finding.is_accepted;
    std::string found = finding.figure;
    if (!finding.sensor.empty()) found = finding.sensor + ": " + found;
    diagnoses.push_back({finding.code, refuses ? Effect::kFails : Effect::kWorse, std::move(found),
                         "run: " + finding.consequence,
                         !finding.statement.empty()
                             ? finding.statement
                             : "if it is right all the same: --accept " + finding.code});
  }
  add_streams(source.info(), survey, diagnoses);
  add_skipped(source, diagnoses);
  add_facts(source, diagnoses);
  std::stable_sort(diagnoses.begin(), diagnoses.end(),
                   [](const Diagnosis& a, const Diagnosis& b) { return a.effect < b.effect; });
  return diagnoses;
}

std::vector<DiagnosisDescription> list_diagnoses() {
  return {kDescriptions.begin(), kDescriptions.end()};
}

}  // namespace traverse::plausibility
