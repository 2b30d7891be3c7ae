#pragma once

#include <string>
#include <vector>

#include "run/model.hpp"
#include "run/report_input.hpp"

namespace traverse::report {

struct ReportSection;

/// Everything of a report but its pictures.
struct ReportModel {
  Model model;
  std::vector<const ReportSection*> sections;  ///< that apply, in the order of the page
  std::string packed_points;                   ///< of the 3-D view
};

ReportModel make_model(const ReportInput& input);

}  // namespace traverse::report
