#pragma once

#include <string>

#include "traverse/dataset/recording_survey.hpp"
#include "traverse/dataset/source.hpp"

namespace traverse::app {

/// What `traverse info` says about a recording after reading it: as text for the terminal, and as
/// JSON.
std::string recording_text(const dataset::Source& source, const dataset::RecordingSurvey& survey);
std::string recording_json(const dataset::Source& source, const dataset::RecordingSurvey& survey);

}  // namespace traverse::app
