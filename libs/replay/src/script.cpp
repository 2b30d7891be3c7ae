#include "traverse/replay/script.hpp"

#include <algorithm>

#include "traverse/files/input_error.hpp"
#include "traverse/files/text_file.hpp"

namespace traverse::replay {

namespace {

constexpr std::string_view kBlank = " \t\r";

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kBlank);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlank) - begin + 1);
}

}  // namespace

std::vector<ScriptCommand> read_script(const std::filesystem::path& file) {
  std::vector<ScriptCommand> commands;
  files::LineReader reader(file);
  while (reader.next()) {
    const std::string_view line = reader.line();
    const std::string_view text = trimmed(line.substr(0, line.find('#')));
    if (text.empty()) continue;
    const std::size_t blank = text.find_first_of(kBlank);
    ScriptCommand command{reader.number(), std::string(text.substr(0, blank)), ""};
    if (blank != std::string_view::npos) command.argument = trimmed(text.substr(blank));
    const auto word = std::find_if(kScriptWords.begin(), kScriptWords.end(),
                                   [&](const auto& known) { return known.name == command.name; });
    if (word == kScriptWords.end()) {
      throw reader.error("a command of `traverse-replay --help-script`",
                         files::in_quotes(command.name));
    }
    if (word->argument.empty() != command.argument.empty()) {
      throw reader.error(word->argument.empty() ? command.name + " alone"
                                                : command.name + " " + std::string(word->argument),
                         files::in_quotes(text));
    }
    commands.push_back(std::move(command));
  }
  return commands;
}

}  // namespace traverse::replay
