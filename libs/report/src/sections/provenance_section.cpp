#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "traverse/files/shell_word.hpp"

#include "run/number_texts.hpp"
#include "sections/sections.hpp"

namespace traverse::report {

namespace {

using nlohmann::json;

std::string value_text(const json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

Table configuration_table(const json& settings) {
  Table table("configuration", "Configuration",
              {"setting", "value", "preset", "meaning", "allowed"});
  for (const bool changed : {true, false}) {
    for (const json& setting : settings) {
      if (setting.at("changed").get<bool>() != changed) continue;
      table.add_row({setting.at("key").get<std::string>(), value_text(setting.at("value")),
                     value_text(setting.at("preset")), setting.at("meaning").get<std::string>(),
                     setting.at("allowed").get<std::string>()},
                    changed);
    }
  }
  return table;
}

std::string configuration_summary(const json& record) {
  std::size_t changed = 0;
  for (const json& setting : record.at("configuration").at("settings")) {
    if (setting.at("changed").get<bool>()) ++changed;
  }
  const std::string differences =
      changed == 0 ? "as shipped"
                   : fmt::format("with {} of its settings changed (marked)", changed);
  return fmt::format("Preset {}, {}. {}.", record.at("pipeline").get<std::string>(), differences,
                     record.at("pipeline_description").get<std::string>());
}

Table facts_table(const json& record) {
  Table table("facts", "What was taken for true", {"fact", "value", "because"});
  for (const json& fact : record.at("recording").at("facts")) {
    table.add_row({fact.at("name").get<std::string>(), fact.at("value").get<std::string>(),
                   fact.at("reason").get<std::string>()});
  }
  for (const json& decision : record.at("decisions")) {
    table.add_row({decision.at("name").get<std::string>(), decision.at("value").get<std::string>(),
                   "decided by the estimator"});
  }
  return table;
}

Table skipped_table(const json& record) {
  Table table("skipped", "Skipped records", {"reason", "records", "first places"});
  for (const auto& [reason, skipped] : record.at("skipped_records").items()) {
    table.add_row(
        {reason, Cell::count(skipped.at("count").get<std::size_t>()),
         fmt::format("{}", fmt::join(skipped.at("first").get<std::vector<std::string>>(), ", "))});
  }
  return table;
}

Table made_table(const json& record) {
  const json& recording = record.at("recording");
  const json& program = record.at("program");
  const json& host = record.at("host");
  std::vector<std::string> libraries;
  for (const auto& [name, version] : program.at("libraries").items()) {
    libraries.push_back(fmt::format("{} {}", name, version.get<std::string>()));
  }
  Table table("made", "How this was made", {"what", "value"});
  table.add_row({"recording", fmt::format("{} ({})", recording.at("path").get<std::string>(),
                                          recording.at("format").get<std::string>())});
  if (!recording.at("sha256").is_null()) {
    table.add_row({"its content",
                   fmt::format("{}, SHA-256 {}", bytes_text(recording.at("bytes").get<double>()),
                               recording.at("sha256").get<std::string>())});
  }
  if (!record.at("reference").is_null()) {
    table.add_row(
        {"reference", fmt::format("{} ({})", record.at("reference").at("file").get<std::string>(),
                                  record.at("reference").at("description").get<std::string>())});
  }
  table.add_row(
      {"configuration",
       fmt::format("SHA-256 {}", record.at("configuration").at("sha256").get<std::string>())});
  table.add_row({"program", fmt::format("Traverse {}, commit {}, {}, {}",
                                        program.at("version").get<std::string>(),
                                        program.at("commit").get<std::string>(),
                                        program.at("build_type").get<std::string>(),
                                        program.at("compiler").get<std::string>())});
  table.add_row({"libraries", fmt::format("{}", fmt::join(libraries, ", "))});
  table.add_row(
      {"machine",
       fmt::format("{}: {}, {} logical CPUs, {} GB, {}", host.at("name").get<std::string>(),
                   host.at("cpu").get<std::string>(), host.at("logical_cpus").get<int>(),
                   short_number(host.at("memory_gb").get<double>()),
                   host.at("system").get<std::string>())});
  table.add_row({"started", record.at("started_utc").get<std::string>()});
  return table;
}

/// The command line with the words quoted that a shell would take apart.
std::string command_text(const json& command) {
  std::vector<std::string> words;
  for (const json& part : command) {
    const std::string word = part;
    const bool plain =
        !word.empty() &&
        word.find_first_not_of(
            "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./:,@%") ==
            std::string::npos;
    words.push_back(plain ? word : files::in_shell_quotes(word));
  }
  return fmt::format("{}", fmt::join(words, " "));
}

}  // namespace

void add_configuration(const RunData& run, Model& model) {
  model.add_text("configuration_summary", configuration_summary(run.record));
  model.add_table(configuration_table(run.record.at("configuration").at("settings")));
}

void add_provenance(const RunData& run, Model& model) {
  model.add_table(facts_table(run.record));
  model.add_table(skipped_table(run.record));
  model.add_table(made_table(run.record));
  model.add_text("command", command_text(run.record.at("command")));
}

}  // namespace traverse::report
