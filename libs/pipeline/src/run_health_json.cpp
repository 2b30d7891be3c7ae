#include "run_health_json.hpp"

#include <array>
#include <string>
#include <utility>

namespace traverse::pipeline {

namespace {

using files::JsonValue;
using Json = nlohmann::ordered_json;

Json optional(const auto& value) { return value ? Json(*value) : Json(nullptr); }

Json spells_json(const Spells& spells) {
  return {{"frames", spells.frames},
          {"spells", spells.count},
          {"longest_s", spells.longest.seconds},
          {"longest_frames", spells.longest.frames},
          {"longest_first_frame", spells.longest.first_frame},
          {"longest_begin_s", spells.longest.begin_s}};
}

Json reason_json(const HealthReason& reason) {
  return {{"severity", name_of(reason.severity)}, {"code", reason.code}, {"text", reason.text}};
}

Json sensor_json(const SensorUse& sensor) {
  return {{"label", sensor.label},     {"kind", sensors::name_of(sensor.kind)},
          {"taken", sensor.is_taken},  {"read", sensor.read},
          {"used", sensor.used},       {"rejected", sensor.rejected},
          {"unused", sensor.unused()}, {"longest_rejected_s", sensor.longest_rejected_s},
          {"reason", sensor.reason}};
}

Json contradiction_json(const Contradiction& found) {
  return {{"severity", name_of(found.severity)},
          {"code", found.code},
          {"text", found.text},
          {"statement", found.statement}};
}

template <typename List, typename ToJson>
Json list_json(const List& list, const ToJson& to) {
  Json json = Json::array();
  for (const auto& element : list) json.push_back(to(element));
  return json;
}

Health health_named(const JsonValue& json) {
  const std::string name = json.text();
  for (const Health health : {Health::kOk, Health::kDegraded, Health::kLost}) {
    if (name == name_of(health)) return health;
  }
  throw json.error("ok, degraded or lost");
}

sensors::SensorKind kind_named(const JsonValue& json) {
  using sensors::SensorKind;
  const std::string name = json.text();
  for (const SensorKind kind : {SensorKind::kLidar, SensorKind::kPlanarLaser, SensorKind::kImu,
                                SensorKind::kGnss, SensorKind::kWheels}) {
    if (name == sensors::name_of(kind)) return kind;
  }
  throw json.error("a kind of sensor");
}

double amount(const JsonValue& json) {
  constexpr double kMost = 1e15;
  const double value = json.number();
  if (!(value >= 0 && value <= kMost)) throw json.error("a number from 0 to 1e15");
  return value;
}

std::optional<double> optional_amount(const JsonValue& json) {
  return json.is_null() ? std::nullopt : std::optional(amount(json));
}

Spells spells_from(const JsonValue& json) {
  Spells spells;
  spells.frames = json["frames"].count();
  spells.count = json["spells"].count();
  spells.longest = {json["longest_frames"].count(), json["longest_first_frame"].count(),
                    amount(json["longest_begin_s"]), amount(json["longest_s"])};
  return spells;
}

SensorUse sensor_from(const JsonValue& json) {
  SensorUse sensor;
  sensor.label = json["label"].text();
  sensor.kind = kind_named(json["kind"]);
  sensor.is_taken = json["taken"].boolean();
  sensor.read = json["read"].count();
  sensor.used = json["used"].count();
  sensor.rejected = json["rejected"].count();
  sensor.longest_rejected_s = amount(json["longest_rejected_s"]);
  sensor.reason = json["reason"].text();
  return sensor;
}

template <typename Element>
std::vector<Element> list_from(const JsonValue& json, Element (*from)(const JsonValue&)) {
  std::vector<Element> list;
  for (std::size_t i = 0; i < json.size(); ++i) list.push_back(from(json[i]));
  return list;
}

HealthReason reason_from(const JsonValue& json) {
  return {health_named(json["severity"]), json["code"].text(), json["text"].text()};
}

Contradiction contradiction_from(const JsonValue& json) {
  return {json["code"].text(), health_named(json["severity"]), json["text"].text(),
          json["statement"].text()};
}

/// What an estimator knows of its frames.
constexpr std::array<const char*, 6> kOfItsFrames{"registrable", "registered",  "lost",
                                                  "degenerate",  "unsupported", "restarts"};

void take_frames(const JsonValue& json, RunHealth& health) {
  health.registrable = json["registrable"].count();
  health.registered = json["registered"].count();
  health.lost = spells_from(json["lost"]);
  health.degenerate = spells_from(json["degenerate"]);
  health.unsupported = json["unsupported"].count();
  health.restarts = json["restarts"].count();
  if (health.registered > health.registrable) {
    throw json["registered"].error("at most as many as registrable");
  }
}

}  // namespace

nlohmann::ordered_json to_json(const RunHealth& health) {
  Json json{{"verdict", name_of(health.verdict)},
            {"reasons", list_json(health.reasons, reason_json)},
            {"navigation", health.is_navigation},
            {"frames", health.frames},
            {"registrable", health.registrable},
            {"registered", health.registered},
            {"registered_share", optional(health.registered_share())},
            {"located", optional(health.located)},
            {"lost", spells_json(health.lost)},
            {"degenerate", spells_json(health.degenerate)},
            {"unsupported", health.unsupported},
            {"restarts", health.restarts},
            {"first_pose",
             {{"after_s", optional(health.first_pose_after_s)},
              {"share", optional(health.first_pose_share)}}},
            {"covered_share", optional(health.covered_share)},
            {"gaps",
             {{"count", health.gaps.count},
              {"usual_s", health.gaps.usual_s},
              {"longest_s", health.gaps.longest_s},
              {"after_frame", health.gaps.after_frame}}},
            {"leaps",
             {{"count", health.leaps.count},
              {"largest_m", health.leaps.largest_m},
              {"seconds", health.leaps.seconds},
              {"frame", health.leaps.frame}}},
            {"skipped_records", health.skipped_records},
            {"skipped_share", health.skipped_share},
            {"error_share", optional(health.error_share)},
            {"sensors", list_json(health.sensors, sensor_json)},
            {"contradictions", list_json(health.contradictions, contradiction_json)}};
  if (!health.is_foreign) return json;
  json["foreign"] = true;
  for (const char* key : kOfItsFrames) json[key] = nullptr;
  return json;
}

RunHealth health_from_json(const JsonValue& json) {
  RunHealth health;
  health.verdict = health_named(json["verdict"]);
  health.reasons = list_from(json["reasons"], reason_from);
  health.is_navigation = json["navigation"].boolean();
  health.frames = json["frames"].count();
  health.is_foreign = json.has("foreign") && json["foreign"].boolean();
  if (!health.is_foreign) take_frames(json, health);
  if (!json["located"].is_null()) health.located = json["located"].count();
  const JsonValue first = json["first_pose"];
  if (!first["after_s"].is_null()) health.first_pose_after_s = first["after_s"].number();
  if (!first["share"].is_null()) health.first_pose_share = first["share"].number();
  health.covered_share = optional_amount(json["covered_share"]);
  const JsonValue gaps = json["gaps"];
  health.gaps = {gaps["count"].count(), amount(gaps["usual_s"]), amount(gaps["longest_s"]),
                 gaps["after_frame"].count()};
  const JsonValue leaps = json["leaps"];
  health.leaps = {leaps["count"].count(), amount(leaps["largest_m"]), amount(leaps["seconds"]),
                  leaps["frame"].count()};
  health.skipped_records = json["skipped_records"].count();
  health.skipped_share = amount(json["skipped_share"]);
  health.error_share = optional_amount(json["error_share"]);
  health.sensors = list_from(json["sensors"], sensor_from);
  health.contradictions = list_from(json["contradictions"], contradiction_from);
  return health;
}

}  // namespace traverse::pipeline
