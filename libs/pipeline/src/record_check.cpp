#include "record_check.hpp"

#include <initializer_list>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace traverse::pipeline {

using files::JsonValue;

namespace {

constexpr std::string_view kImportedPoses = "imported_poses";
constexpr double kLongestTime_ms = 1e12;  // thirty years
constexpr double kMostMegabytes = 1e12;
constexpr std::size_t kMostRecords = 1'000'000'000'000'000;  // doubles count so far, sums fit

void require_texts(const JsonValue& json, std::initializer_list<const char*> keys) {
  for (const char* key : keys) static_cast<void>(json[key].text());
}

void require_count(const JsonValue& json, std::size_t most = kMostRecords) {
  if (json.count() > most) throw json.error(fmt::format("a count of at most {}", most));
}

void require_within(const JsonValue& json, double least, double most) {
  const double number = json.number();
  if (!(number >= least && number <= most)) {
    throw json.error(fmt::format("a number from {} to {}", least, most));
  }
}

void require_point(const JsonValue& json) {
  if (json.numbers().size() != 3) throw json.error("x, y and z");
}

template <typename Check>
void for_each_element(const JsonValue& list, const Check& check) {
  for (std::size_t i = 0; i < list.size(); ++i) check(list[i]);
}

void require_counts(const JsonValue& record) {
  const JsonValue frames = record["frames"];
  for (const char* key : {"read", "used", "first", "sample"}) require_count(frames[key]);
  for (const std::string& reason : frames["skipped"].keys()) {
    require_count(frames["skipped"][reason]);
  }
  const JsonValue skipped = record["skipped_records"];
  for (const std::string& reason : skipped.keys()) {
    require_count(skipped[reason]["count"]);
    static_cast<void>(skipped[reason]["first"].texts());
  }
  if (record.has("contradictions")) {
    for_each_element(record["contradictions"], [](const JsonValue& found) {
      require_texts(found, {"code", "severity", "sensor", "figure", "consequence", "statement"});
      static_cast<void>(found["accepted"].boolean());
    });
  }
  require_count(record["map"]["points"]);
  require_count(record["map"]["keyframes"]);
  require_within(record["map"]["voxel_m"], 0, 1e6);
  if (record["map"].has("north") && !record["map"]["north"].is_null()) {
    require_point(record["map"]["north"]);
  }
}

void require_timing(const JsonValue& timing) {
  for (const char* key : {"frame_median", "frame_p95", "frame_max", "total"}) {
    require_within(timing[key], 0, kLongestTime_ms);
  }
  for_each_element(timing["stages"], [](const JsonValue& stage) {
    require_texts(stage, {"name"});
    for (const char* key : {"median", "mean", "p95", "max"}) {
      require_within(stage[key], 0, kLongestTime_ms);
    }
  });
}

void require_times(const JsonValue& record) {
  // Of poses that another program made any of them need not be known.
  const auto is_known = [&](const char* key) {
    return !(is_foreign_run(record) && record[key].is_null());
  };
  if (is_known("timing_ms")) require_timing(record["timing_ms"]);
  if (is_known("wall_seconds")) {
    require_within(record["wall_seconds"], 0, kLongestTime_ms / 1000);
  }
  if (is_known("peak_memory_mb")) require_within(record["peak_memory_mb"], 0, kMostMegabytes);
  if (!is_known("threads")) return;
  if (record["threads"].count() == 0) throw record["threads"].error("at least one thread");
  require_count(record["threads"], 1'000'000);
}

/// A setting is a number, a text, true or false, or a list of such; nothing is nested.
void require_setting(const JsonValue& value) {
  const auto is_plain = [](const JsonValue& one) {
    return one.is_boolean() || one.is_number() || one.is_text();
  };
  if (is_plain(value)) return;
  if (!value.is_list()) throw value.error("the value of a setting");
  for_each_element(value, [&](const JsonValue& one) {
    if (!is_plain(one)) throw one.error("a plain value in a list");
  });
}

void require_configuration(const JsonValue& configuration) {
  require_texts(configuration, {"sha256"});
  for_each_element(configuration["settings"], [](const JsonValue& setting) {
    require_texts(setting, {"key", "meaning", "allowed"});
    static_cast<void>(setting["changed"].boolean());
    require_setting(setting["value"]);
    require_setting(setting["preset"]);
  });
}

void require_recording(const JsonValue& recording) {
  require_texts(recording, {"path", "name", "format"});
  if (recording.has("reference_refused") && !recording["reference_refused"].is_null()) {
    require_texts(recording, {"reference_refused"});
  }
  static_cast<void>(recording["bytes"].count());
  if (recording.has("statements")) static_cast<void>(recording["statements"].texts());
  if (!recording["sha256"].is_null()) require_texts(recording, {"sha256"});
  for_each_element(recording["sensors"], [](const JsonValue& sensor) {
    require_texts(sensor, {"label", "kind"});
    if (sensor.has("p_body_m")) require_point(sensor["p_body_m"]);
  });
  for_each_element(recording["facts"], [](const JsonValue& fact) {
    require_texts(fact, {"name", "value", "reason"});
  });
}

void require_provenance(const JsonValue& record) {
  static_cast<void>(record["command"].texts());
  const JsonValue program = record["program"];
  require_texts(program, {"version", "commit", "build_type", "compiler"});
  for (const std::string& library : program["libraries"].keys()) {
    static_cast<void>(program["libraries"][library].text());
  }
  const JsonValue host = record["host"];
  require_texts(host, {"name", "system", "cpu"});
  require_count(host["logical_cpus"], 1'000'000);
  require_within(host["memory_gb"], 0, kMostMegabytes);
}

}  // namespace

bool has_health(const JsonValue& record) {
  return record.has("health") && !record["health"].is_null();
}

bool is_foreign_run(const JsonValue& record) {
  const JsonValue configuration = record["configuration"];
  return configuration.has("estimator") && configuration["estimator"].text() == kImportedPoses;
}

void require_run_record(const JsonValue& record) {
  const std::string status = record["status"].text();
  const bool is_assessed = status == "ok" || status == "degraded" || status == "lost";
  if (!is_assessed && status != "failed" && status != "interrupted") {
    throw record["status"].error("ok, degraded, lost, failed or interrupted");
  }
  if (is_assessed && has_health(record) && record["health"]["verdict"].text() != status) {
    throw record["status"].error("the verdict of health, " + record["health"]["verdict"].text());
  }
  require_texts(record, {"reason", "pipeline", "pipeline_description", "started_utc"});
  require_counts(record);
  require_times(record);
  for_each_element(record["decisions"], [](const JsonValue& decision) {
    require_texts(decision, {"name", "value"});
  });
  if (!record["reference"].is_null()) require_texts(record["reference"], {"file", "description"});
  if (!record["evaluation_error"].is_null()) require_texts(record, {"evaluation_error"});
  require_configuration(record["configuration"]);
  require_recording(record["recording"]);
  require_provenance(record);
}

}  // namespace traverse::pipeline
