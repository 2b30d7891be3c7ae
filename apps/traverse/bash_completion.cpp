#include "bash_completion.hpp"

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace traverse::app {

namespace {

/// What is the same for every program: finds the place of the word at the cursor and offers what
/// the functions made from the program's options say of it. PROGRAM stands for the program's name.
constexpr std::string_view kScript = R"bash(
_PROGRAM_offer() {  # KIND: adds those words of the kind that begin like $word
  local folder file
  case $1 in
    'of '*) COMPREPLY+=($(compgen -W "${1#of }" -- "$word")) ;;
    folders) compopt -o filenames 2>/dev/null
             mapfile -t -O ${#COMPREPLY[@]} COMPREPLY < <(compgen -d -- "$word") ;;
    files) compopt -o filenames 2>/dev/null
           mapfile -t -O ${#COMPREPLY[@]} COMPREPLY < <(compgen -f -- "$word") ;;
    pipelines | worlds | sensors)
      folder=$(readlink -f "$(type -P -- "${COMP_WORDS[0]}")")
      folder=${TRAVERSE_SHARE:-${folder%/*/*}/share/traverse}/$1
      for file in "$folder"/*.yaml; do
        file=${file##*/}
        [[ ${file%.yaml} == "$word"* ]] && COMPREPLY+=("${file%.yaml}")
      done
      [ ${#COMPREPLY[@]} -gt 0 ] || _PROGRAM_offer files ;;
  esac
}

_PROGRAM() {
  local word=${COMP_WORDS[COMP_CWORD]} command='' given=0 takes='' words i before
  COMPREPLY=()
  for ((i = 1; i < COMP_CWORD; ++i)); do
    before=${COMP_WORDS[i]}
    if [ "$before" = = ]; then
      continue  # bash cuts --option=value into three words
    elif [ -n "$takes" ]; then
      takes=''
    elif [[ $before == -* ]]; then
      _PROGRAM_takes "$command:$before"
    else
      _PROGRAM_commands "$command"
      if [[ " $words " == *" $before "* ]]; then
        command=${command:+$command }$before
      else
        given=$((given + 1))
      fi
    fi
  done
  [ "$word" != = ] || word=''
  if [ -n "$takes" ]; then
    _PROGRAM_offer "$takes"
  elif [[ $word == -* ]]; then
    _PROGRAM_options "$command"
    _PROGRAM_offer "of $words"
  else
    _PROGRAM_commands "$command"
    _PROGRAM_offer "of $words"
    _PROGRAM_takes "$command:$((given + 1))"
    [ -n "$takes" ] || _PROGRAM_takes "$command:further"
    _PROGRAM_offer "$takes"
  fi
}
complete -F _PROGRAM -- PROGRAM_AS_TYPED
)bash";

/// The choices in "TEXT:{none,se3}", with blanks between; empty if there are none.
std::string choices(const std::string& type) {
  const std::size_t begin = type.find('{');
  const std::size_t end = type.find('}', begin);
  if (begin == std::string::npos || end == std::string::npos) return "";
  std::string words = type.substr(begin + 1, end - begin - 1);
  std::replace(words.begin(), words.end(), ',', ' ');
  return words;
}

/// What an option or an argument takes, as the script's offer() knows it; empty for a flag.
std::string kind_of(const CLI::Option& option) {
  if (option.get_items_expected_max() == 0) return "";
  const std::string type = option.get_type_name();
  if (const std::string words = choices(type); !words.empty()) return "of " + words;
  const std::string& name = option.get_single_name();
  if (name == "pipeline" || name == "PRESET") return "pipelines";
  if (name == "WORLD") return "worlds";
  if (name == "sensor") return "sensors";

  const std::string shown = option.get_option_text().empty() ? type : option.get_option_text();
  const auto holds = [&](std::string_view part) { return shown.find(part) != std::string::npos; };
  if (holds("DIR") || shown == "RUN") return "folders";
  const bool is_path = holds("FILE") || holds("PATH") || holds("OUT") || shown == "TEXT";
  return is_path || option.get_positional() ? "files" : "of ";  // anything: nothing to offer
}

/// The bodies of the three functions that tell of the program's options: branches of a `case`.
struct Branches {
  std::string commands;
  std::string options;
  std::string takes;

  void add(const CLI::App& app, const std::string& command) {
    std::vector<std::string> words;
    for (const CLI::Option* option : app.get_options()) {
      if (!option->get_group().empty()) add(*option, command, words);
    }
    options += fmt::format("    '{}') words='{}' ;;\n", command, fmt::join(words, " "));

    const auto below =
        app.get_subcommands([](const CLI::App* sub) { return !sub->get_group().empty(); });
    words.clear();
    for (const CLI::App* sub : below) words.push_back(sub->get_name());
    commands += fmt::format("    '{}') words='{}' ;;\n", command, fmt::join(words, " "));
    places_ = 0;
    for (const CLI::App* sub : below) {
      add(*sub, command + (command.empty() ? "" : " ") + sub->get_name());
      places_ = 0;
    }
  }

 private:
  void add(const CLI::Option& option, const std::string& command, std::vector<std::string>& words) {
    std::vector<std::string> names;
    for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option.get_snames()) names.push_back("-" + name);
    words.insert(words.end(), names.begin(), names.end());
    if (option.get_positional()) {
      names = {option.get_items_expected_max() > 1 ? "further" : std::to_string(++places_)};
    }
    const std::string kind = kind_of(option);
    if (kind.empty()) return;
    for (std::string& name : names) name = fmt::format("'{}:{}'", command, name);
    takes += fmt::format("    {}) takes='{}' ;;\n", fmt::join(names, " | "), kind);
  }

  int places_ = 0;  ///< positional arguments of the command so far
};

std::string replaced(std::string text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at)) {
    text.replace(at, from.size(), to);
    at += to.size();
  }
  return text;
}

}  // namespace

std::string bash_completion(const CLI::App& program) {
  Branches branches;
  branches.add(program, "");
  std::string script = fmt::format(
      "# Completion of {0} in bash, made by `{0} --bash-completion`.\n", program.get_name());
  const auto add = [&](std::string_view name, std::string_view what, const std::string& body) {
    script +=
        fmt::format("\n_PROGRAM_{}() {{\n  {}=''\n  case $1 in\n{}  esac\n}}\n", name, what, body);
  };
  add("commands", "words", branches.commands);
  add("options", "words", branches.options);
  add("takes", "takes", branches.takes);
  script += kScript;
  script = replaced(script, "PROGRAM_AS_TYPED", program.get_name());
  return replaced(script, "PROGRAM", replaced(program.get_name(), "-", "_"));
}

void add_bash_completion(CLI::App& program) {
  program.add_flag_callback(
      "--bash-completion",
      [&program] {
        fmt::print("{}", bash_completion(program));
        throw CLI::Success();
      },
      "print the script that completes command lines in bash, and exit");
}

}  // namespace traverse::app
