#pragma once

#include <CLI/CLI.hpp>

namespace traverse::app {

/// Lets every integer option of `app` and of its subcommands, those that are defined already, take
/// its number as decimal: frames are numbered like their files, 000100, which CLI11 reads as octal.
void read_integers_as_decimal(CLI::App& app);

}  // namespace traverse::app
