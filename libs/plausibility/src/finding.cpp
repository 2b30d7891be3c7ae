#include "traverse/plausibility/finding.hpp"

#include <algorithm>

namespace traverse::plausibility {

std::string_view name_of(Severity severity) {
  return severity == Severity::kRefuse ? "refuse" : "warn";
}

void mark_accepted(const std::vector<std::string>& codes, std::vector<Finding>& findings) {
  for (Finding& finding : findings) {
    finding.is_accepted = std::find(codes.begin(), codes.end(), finding.code) != codes.end();
  }
}

std::string to_text(const Finding& finding) {
  std::string text = finding.code;
  if (!finding.sensor.empty()) text += " (" + finding.sensor + ")";
  text += ": " + finding.figure + ". " + finding.consequence + ".";
  if (!finding.statement.empty()) text += " Mended by " + finding.statement + ".";
  return text;
}

}  // namespace traverse::plausibility
