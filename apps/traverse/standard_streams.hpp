#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace traverse::app {

/// For the whole program, called in main before anything is opened. Standard streams that were
/// closed become /dev/null, so that no file of ours gets their numbers. A pipe that nobody reads
/// any more makes a write fail and does not kill.
void prepare_standard_streams();

/// To stderr, whatever has become of it: nobody's work ends because its messages are not taken.
void print_message(std::string_view text);
template <typename... Values>
void print_message(fmt::format_string<Values...> format, Values&&... values) {
  print_message(std::string_view(fmt::format(format, std::forward<Values>(values)...)));
}

/// What the user should know of what was asked for, a line each: "note: ...".
void print_notes(const std::vector<std::string>& notes);

/// Whether stdout took all that was printed; called when a command is through.
/// If its reader has gone (`| head -1`) the program ends here as others do, silently by SIGPIPE.
/// \throws files::OutputError otherwise (a full disk)
void require_printed();

}  // namespace traverse::app
