#include "traverse/pipeline/run_record.hpp"

#include <algorithm>
#include <numeric>
#include <string_view>
#include <type_traits>
#include <variant>

#include <nlohmann/json.hpp>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/digest.hpp"
#include "traverse/files/sealed_json.hpp"
#include "traverse/pipeline/frame_table.hpp"
#include "traverse/pipeline/privacy.hpp"
#include "traverse/pipeline/recording_place.hpp"
#include "traverse/pipeline/run_folder.hpp"
#include "traverse/statistics/quantile.hpp"

#include "run_health_json.hpp"

namespace traverse::pipeline {

namespace {

using Json = nlohmann::ordered_json;

std::string_view name_of(RunStatus status) {
  switch (status) {
    case RunStatus::kOk:
      return "ok";
    case RunStatus::kDegraded:
      return "degraded";
    case RunStatus::kLost:
      return "lost";
    case RunStatus::kFailed:
      return "failed";
    case RunStatus::kInterrupted:
      return "interrupted";
  }
  return "failed";
}

Json to_json(const config::Setting::Value& value) {
  return std::visit([](const auto& held) { return Json(held); }, value);
}

Json to_json(const std::vector<ResolvedSetting>& settings) {
  Json list = Json::array();
  for (const ResolvedSetting& resolved : settings) {
    list.push_back({{"key", resolved.setting.path},
                    {"value", to_json(resolved.setting.value)},
                    {"preset", to_json(resolved.in_preset)},
                    {"changed", resolved.is_changed()},
                    {"meaning", resolved.setting.meaning},
                    {"allowed", resolved.setting.allowed}});
  }
  return list;
}

Json to_json(const dataset::RecordingInfo& info, const std::filesystem::path& run_folder) {
  Json facts = Json::array();
  for (const dataset::Fact& fact : info.facts) {
    facts.push_back({{"name", fact.name}, {"value", fact.value}, {"reason", fact.reason}});
  }
  Json sensors = Json::array();
  for (const sensors::MountedSensor& sensor : info.rig.sensors) {
    const Eigen::Vector3d& p = sensor.T_body_sensor.translation;
    Json entry{{"label", sensor.label},
               {"kind", sensors::name_of(sensor.kind)},
               {"p_body_m", {p.x(), p.y(), p.z()}}};
    if (sensor.lidar) entry["profile"] = sensor.lidar->name;
    sensors.push_back(std::move(entry));
  }
  const RecordingPlace place = recording_place(info.path, run_folder);
  Json json{{"path", place.path.string()},
            {"path_from_run", nullptr},
            {"name", info.name},
            {"format", info.format},
            {"motion_compensated", info.motion_compensated},
            {"sensors", std::move(sensors)},
            {"facts", std::move(facts)},
            {"reference_refused",
             info.reference_refused.empty() ? Json() : Json(info.reference_refused)}};
  if (!run_folder.empty()) json["path_from_run"] = place.from_run.string();
  return json;
}

Json to_json(const dataset::SkippedRecords& skipped) {
  Json by_reason = Json::object();
  for (const auto& [reason, count] : skipped.by_reason()) {
    by_reason[reason] = {{"count", count.count}, {"first", count.first_places}};
  }
  return by_reason;
}

Json to_json(const std::vector<FileDigest>& files) {
  Json by_name = Json::object();
  for (const FileDigest& file : files) {
    by_name[file.name] = {{"bytes", file.bytes}, {"sha256", file.sha256}};
  }
  return by_name;
}

Json to_json(const std::vector<plausibility::Finding>& findings) {
  Json list = Json::array();
  for (const plausibility::Finding& finding : findings) {
    list.push_back({{"code", finding.code},
                    {"severity", plausibility::name_of(finding.severity)},
                    {"accepted", finding.is_accepted},
                    {"sensor", finding.sensor},
                    {"figure", finding.figure},
                    {"consequence", finding.consequence},
                    {"statement", finding.statement}});
  }
  return list;
}

/// Of poses that another program made: what is known of that one's run.
void set_foreign_cost(const ForeignTiming& foreign, Json& json) {
  const auto known = [](const auto& value) { return value ? Json(*value) : Json(nullptr); };
  if (foreign.frame_ms.empty()) json["timing_ms"] = nullptr;
  json["threads"] = known(foreign.threads);
  json["wall_seconds"] = known(foreign.wall_s);
  json["peak_memory_mb"] = known(foreign.peak_memory_mb);
}

Json timing(const RunRecord& record) {
  Json stages = Json::array();
  for (const StageTiming& stage : record.stages) {
    stages.push_back({{"name", stage.name},
                      {"median", stage.median},
                      {"mean", stage.mean},
                      {"p95", stage.p95},
                      {"max", stage.max}});
  }
  return {{"frame_median", record.frame_median_ms},
          {"frame_p95", record.frame_p95_ms},
          {"frame_max", record.frame_max_ms},
          {"total", record.frames_total_ms},
          {"stages", std::move(stages)}};
}

}  // namespace

void summarise_timing(const FrameTable& frames, RunRecord& record) {
  constexpr std::string_view kSuffix = "_ms";
  if (frames.rows().empty()) return;
  for (const std::string& name : frames.columns()) {
    if (!std::string_view(name).ends_with(kSuffix)) continue;
    const std::vector<double> values = frames.column(name);
    const double sum = std::accumulate(values.begin(), values.end(), 0.0);
    const StageTiming stage{
        name.substr(0, name.size() - kSuffix.size()), statistics::quantile(values, 0.5),
        sum / static_cast<double>(values.size()), statistics::quantile(values, 0.95),
        *std::max_element(values.begin(), values.end())};
    if (stage.name == "total") {
      record.frame_median_ms = stage.median;
      record.frame_p95_ms = stage.p95;
      record.frame_max_ms = stage.max;
      record.frames_total_ms = sum;
    } else {
      record.stages.push_back(stage);
    }
  }
}

std::string configuration_sha256(const std::vector<ResolvedSetting>& settings) {
  std::string text;
  for (const ResolvedSetting& resolved : settings) {
    text += resolved.setting.path + ": " + config::to_text(resolved.setting.value) + "\n";
  }
  return files::sha256_of_text(text);
}

std::string to_json(const RunRecord& record, const BuildInfo& build, const HostInfo& host) {
  Json json{{"status", name_of(record.status)},
            {"reason", record.reason},
            {"health", record.health ? to_json(*record.health) : Json(nullptr)},
            {"pipeline", record.pipeline},
            {"pipeline_description", record.pipeline_description},
            {"estimator", record.estimator_kind},
            {"frames",
             {{"read", record.frames_read},
              {"used", record.frames_used},
              {"first", record.first_frame},
              {"sample", record.sample_frame}}},
            {"skipped_records", to_json(record.skipped)},
            {"timing_ms", timing(record)},
            {"threads", record.threads},
            {"body_frame", record.recording.rig.body_frame},
            {"points_used", record.points_are}};
  // ARCHITECTURE promises the counts by reason below "frames" too.
  Json& skipped = json["frames"]["skipped"] = Json::object();
  for (const auto& [reason, count] : record.skipped.by_reason()) skipped[reason] = count.count;

  json["contradictions"] = to_json(record.contradictions);
  Json decisions = Json::array();
  for (const Decision& decision : record.decisions) {
    decisions.push_back({{"name", decision.name}, {"value", decision.value}});
  }
  json["decisions"] = std::move(decisions);
  json["map"] = {{"points", record.map_points},
                 {"voxel_m", record.map_voxel_m},
                 {"keyframes", record.keyframes},
                 {"north", nullptr}};
  if (const auto& north = record.north_map) {
    json["map"]["north"] = {north->x(), north->y(), north->z()};
  }
  json["reference"] = nullptr;
  if (record.reference_file) {
    json["reference"] = {{"file", *record.reference_file},
                         {"description", record.reference_description}};
  }
  json["evaluation_error"] =
      record.evaluation_error.empty() ? Json(nullptr) : Json(record.evaluation_error);
  json["configuration"] = {{"estimator", record.estimator_kind},
                           {"sha256", configuration_sha256(record.settings)},
                           {"settings", to_json(record.settings)}};
  json["recording"] = to_json(record.recording, record.place);
  json["recording"]["statements"] = record.statements;
  json["recording"]["bytes"] = record.recording_bytes;
  json["recording"]["sha256"] =
      record.recording_sha256.empty() ? Json(nullptr) : Json(record.recording_sha256);
  json["command"] = record.command;
  json["program"] = {{"version", build.version},
                     {"commit", build.commit},
                     {"build_type", build.build_type},
                     {"compiler", build.compiler}};
  for (const auto& [name, version] : build.libraries) json["program"]["libraries"][name] = version;
  json["host"] = {{"name", host.name},
                  {"system", host.system},
                  {"cpu", host.cpu},
                  {"logical_cpus", host.logical_cpus},
                  {"memory_gb", host.memory_gb}};
  if (!record.files.empty()) json["files"] = to_json(record.files);
  json["started_utc"] = record.started_utc;
  json["wall_seconds"] = record.wall_seconds;
  json["peak_memory_mb"] = record.peak_memory_mb;
  if (record.foreign) set_foreign_cost(*record.foreign, json);
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

void write_record(const RunFolder& folder, const RunRecord& record) {
  const std::string json = to_json(record, build_info(), host_info());
  files::write_text(
      folder.record(),
      files::sealed_json(record.is_private ? Privacy(record.place).record(json) : json));
}

}  // namespace traverse::pipeline
