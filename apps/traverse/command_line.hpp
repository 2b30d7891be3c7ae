#pragma once

#include <string>
#include <vector>

namespace traverse::app {

/// The words this program was started with, the program's own first.
std::vector<std::string> command_line();

}  // namespace traverse::app
