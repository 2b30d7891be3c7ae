#include "traverse/batch/planned_command.hpp"

#include <algorithm>
#include <cctype>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "traverse/files/input_error.hpp"
#include "traverse/files/shell_word.hpp"

#include "plan/command_text.hpp"
#include "plan/container.hpp"

namespace traverse::batch {

namespace {

constexpr std::string_view kFormat = "format:";

/// Whether braces enclose a placeholder rather than something of the shell's or of awk's.
bool is_placeholder(std::string_view name) {
  return !name.empty() && std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '.' || c == ':';
  });
}

std::optional<std::string> value_of_placeholder(const std::string& name,
                                                const PlannedCommand& command,
                                                const CommandPlaces& places) {
  if (name == "recording") return files::in_shell_quotes(places.recording.string());
  if (name == "out") return "\"$PWD\"";
  if (name == "threads") return std::to_string(places.threads);
  if (name == "plan") return files::in_shell_quotes(places.plan_folder.string());
  if (name == "config" && !command.config_file.empty()) {
    return files::in_shell_quotes(command.config_file.string());
  }
  if (name.starts_with(kFormat)) {
    const auto found = places.converted.find(name.substr(kFormat.size()));
    if (found != places.converted.end()) return files::in_shell_quotes(found->second.string());
  }
  for (const std::string& setting : places.settings) {
    if (setting.starts_with(name + "=")) return setting.substr(name.size() + 1);
  }
  return std::nullopt;
}

}  // namespace

void for_each_placeholder(const std::string& text,
                          const std::function<void(std::string_view plain)>& plain,
                          const std::function<void(const std::string& name)>& placeholder) {
  std::size_t done = 0;
  for (std::size_t open = text.find('{'); open != std::string::npos; open = text.find('{', open)) {
    const std::size_t close = text.find('}', open);
    if (close == std::string::npos) break;
    const std::string name = text.substr(open + 1, close - open - 1);
    const bool is_variable = open > 0 && text[open - 1] == '$';  // ${HOME}
    if (is_variable || !is_placeholder(name)) {
      ++open;
      continue;
    }
    plain(std::string_view(text).substr(done, open - done));
    placeholder(name);
    done = close + 1;
    open = done;
  }
  plain(std::string_view(text).substr(done));
}

std::vector<std::string> PlannedCommand::formats() const {
  std::vector<std::string> names;
  for_each_placeholder(
      text, [](std::string_view) {},
      [&](const std::string& name) {
        if (!name.starts_with(kFormat)) return;
        const std::string wanted = name.substr(kFormat.size());
        if (std::find(names.begin(), names.end(), wanted) == names.end()) names.push_back(wanted);
      });
  return names;
}

std::string expanded(const PlannedCommand& command, const CommandPlaces& places) {
  std::string text;
  for_each_placeholder(
      command.text, [&](std::string_view plain) { text += plain; },
      [&](const std::string& name) {
        const auto value = value_of_placeholder(name, command, places);
        if (!value) throw std::invalid_argument(files::in_quotes("{" + name + "}"));
        text += *value;
      });
  if (!command.container) return text;
  std::vector<std::filesystem::path> readable{places.recording, command.config_file};
  if (!places.plan_folder.empty()) readable.push_back(places.plan_folder / "plan");
  for (const auto& [format, path] : places.converted) readable.push_back(path);
  return in_container(command.container, text, readable);
}

}  // namespace traverse::batch
