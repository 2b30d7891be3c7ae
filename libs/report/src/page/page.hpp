#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "figures/figures.hpp"
#include "run/report_model.hpp"

namespace traverse::report {

/// The whole page of a run from its filled model: report.json, the packed points of the map and the
/// pictures stand in it. \throws files::InputError if a template is missing or is not a valid one.
std::string make_page(ReportModel& report, const std::vector<Figure>& figures,
                      const std::filesystem::path& templates);

}  // namespace traverse::report
