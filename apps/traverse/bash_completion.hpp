#pragma once

#include <string>

namespace CLI {
class App;
}

namespace traverse::app {

/// The script that lets bash complete the program's command lines: its subcommands, their options,
/// and what these take: words of a list, files, folders, names of presets, worlds and sensors.
std::string bash_completion(const CLI::App& program);

/// Adds --bash-completion, which prints that script. After all subcommands and options are added.
void add_bash_completion(CLI::App& program);

}  // namespace traverse::app
