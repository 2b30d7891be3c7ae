#pragma once

#include <string>
#include <vector>

#include "traverse/dataset/recording_survey.hpp"
#include "traverse/dataset/source.hpp"
#include "traverse/plausibility/finding.hpp"

namespace traverse::app {

/// What `traverse info` says about a recording after reading it: as text for the terminal, and as
/// JSON.
std::string recording_text(const dataset::Source& source, const dataset::RecordingSurvey& survey,
                           const std::vector<plausibility::Finding>& findings);
std::string recording_json(const dataset::Source& source, const dataset::RecordingSurvey& survey,
                           const std::vector<plausibility::Finding>& findings);

/// The same of a recording that tells by itself what it holds, of which `survey` has read the first
/// scans.
std::string listed_text(const dataset::Source& source, const dataset::RecordingSurvey& survey);

}  // namespace traverse::app
