#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "figures.hpp"
#include "run_data.hpp"

namespace traverse::report {

/// The whole page. \throws files::InputError if a template is missing or is not a valid one.
std::string make_page(const RunData& run, const std::vector<Figure>& figures,
                      const std::filesystem::path& templates);

}  // namespace traverse::report
