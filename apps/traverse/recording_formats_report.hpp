#pragma once

#include <string>

namespace traverse::app {

/// The kinds of recording that are read, for `traverse info --formats`: as text for the terminal,
/// and as JSON.
std::string recording_formats_text();
std::string recording_formats_json();

}  // namespace traverse::app
