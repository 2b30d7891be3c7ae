#pragma once

#include <string>

namespace traverse::app {

/// The sentence that tells a user of the exception that is being handled (called in a handler):
/// libraries' own words for lack of memory and for JSON become ours.
/// \param command that was at work: "traverse report"
std::string error_text(const std::string& command);

}  // namespace traverse::app
