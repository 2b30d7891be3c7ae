#include "traverse/batch/completion.hpp"

#include <nlohmann/json.hpp>

#include "traverse/files/input_error.hpp"
#include "traverse/files/text_file.hpp"

namespace traverse::batch {

namespace {

using Json = nlohmann::ordered_json;

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

RunLimits limits_of(const Json& record) {
  RunLimits limits;
  record.at("time_s").get_to(limits.time_s);
  record.at("memory_mb").get_to(limits.memory_mb);
  record.at("threads").get_to(limits.threads);
  record.at("attempts").get_to(limits.attempts);
  return limits;
}

Completion completion_of(const Json& record) {
  Completion completion;
  record.at("id").get_to(completion.id);
  record.at("identity").get_to(completion.identity);
  completion.outcome = outcome_of(record.at("outcome"));
  record.at("reason").get_to(completion.reason);
  record.at("exit_status").get_to(completion.exit_status);
  record.at("signal").get_to(completion.signal);
  record.at("attempts").get_to(completion.attempts);
  record.at("host").get_to(completion.host);
  record.at("started_utc").get_to(completion.started_utc);
  record.at("wall_s").get_to(completion.wall_s);
  record.at("cpu_s").get_to(completion.cpu_s);
  record.at("peak_memory_mb").get_to(completion.peak_memory_mb);
  completion.limits = limits_of(record.at("limits"));
  record.at("has_report").get_to(completion.has_report);
  record.at("trajectory_sha256").get_to(completion.trajectory_sha256);
  for (const auto& [name, value] : record.at("metrics").items()) {
    completion.metrics.emplace_back(name, value.get<double>());
  }
  record.at("last_lines").get_to(completion.last_lines);
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
  try {
    return completion_of(Json::parse(files::read_text(file)));
  } catch (const Json::exception& error) {
    throw files::InputError(file, files::Place::whole_file(), "the record of a finished run",
                            error.what());
  }
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
