#include "traverse/batch/completion.hpp"

#include <nlohmann/json.hpp>

#include "traverse/files/input_error.hpp"
#include "traverse/files/json_document.hpp"

namespace traverse::batch {

namespace {

using Json = nlohmann::ordered_json;
using files::JsonValue;

Outcome outcome_of(const std::string& name) {
  for (const auto& [known, outcome] : kOutcomeNames) {
    if (known == name) return outcome;
  }
  return Outcome::kFailed;
}

Json to_json(const RunLimits& limits) {
  return {{"time_s", limits.time_s},
          {"memory_mb", limits.memory_mb},
          {"threads", limits.threads},
          {"attempts", limits.attempts}};
}

RunLimits limits_of(const JsonValue& record) {
  RunLimits limits;
  limits.time_s = record["time_s"].number();
  limits.memory_mb = record["memory_mb"].number();
  limits.threads = record["threads"].small_integer();
  limits.attempts = record["attempts"].small_integer();
  return limits;
}

Completion completion_of(const JsonValue& record) {
  Completion completion;
  completion.id = record["id"].text();
  completion.identity = record["identity"].text();
  completion.outcome = outcome_of(record["outcome"].text());
  completion.reason = record["reason"].text();
  completion.exit_status = record["exit_status"].small_integer();
  completion.signal = record["signal"].small_integer();
  completion.attempts = record["attempts"].small_integer();
  completion.host = record["host"].text();
  completion.started_utc = record["started_utc"].text();
  completion.wall_s = record["wall_s"].number();
  completion.cpu_s = record["cpu_s"].number();
  completion.peak_memory_mb = record["peak_memory_mb"].number();
  completion.limits = limits_of(record["limits"]);
  completion.has_report = record["has_report"].boolean();
  completion.trajectory_sha256 = record["trajectory_sha256"].text();
  const JsonValue metrics = record["metrics"];
  for (const std::string& name : metrics.keys()) {
    completion.metrics.emplace_back(name, metrics[name].number());
  }
  completion.last_lines = record["last_lines"].texts();
  return completion;
}

}  // namespace

std::string_view name_of(Outcome outcome) {
  for (const auto& [name, named] : kOutcomeNames) {
    if (named == outcome) return name;
  }
  return "failed";
}

std::string to_json(const Completion& completion) {
  Json metrics = Json::object();
  for (const auto& [name, value] : completion.metrics) metrics[name] = value;
  const Json json{{"id", completion.id},
                  {"identity", completion.identity},
                  {"outcome", name_of(completion.outcome)},
                  {"reason", completion.reason},
                  {"exit_status", completion.exit_status},
                  {"signal", completion.signal},
                  {"attempts", completion.attempts},
                  {"host", completion.host},
                  {"started_utc", completion.started_utc},
                  {"wall_s", completion.wall_s},
                  {"cpu_s", completion.cpu_s},
                  {"peak_memory_mb", completion.peak_memory_mb},
                  {"limits", to_json(completion.limits)},
                  {"has_report", completion.has_report},
                  {"trajectory_sha256", completion.trajectory_sha256},
                  {"metrics", std::move(metrics)},
                  {"last_lines", completion.last_lines}};
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Completion read_completion(const std::filesystem::path& file) {
  return completion_of(files::JsonDocument::read(file).root());
}

std::optional<Completion> find_completion(const std::filesystem::path& file) {
  try {
    return read_completion(file);
  } catch (const files::InputError&) {
    return std::nullopt;
  }
}

bool is_outdated(const Completion& completion, const Job& job) {
  switch (completion.outcome) {
    case Outcome::kTimedOut:
      return completion.limits.time_s != job.limits.time_s;
    case Outcome::kOutOfMemory:
      return completion.limits.memory_mb != job.limits.memory_mb;
    default:
      return false;
  }
}

}  // namespace traverse::batch
