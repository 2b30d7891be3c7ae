#pragma once

#include <string>

namespace traverse::app {

/// Shows a message in a window of its own until it is closed. Without a display it shows nothing.
void show_message(const std::string& title, const std::string& message);

}  // namespace traverse::app
