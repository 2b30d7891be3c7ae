#pragma once

#include <string>
#include <vector>

#include "traverse/batch/plan.hpp"
#include "traverse/config/document.hpp"

namespace traverse::batch {

/// \throws files::InputError for a name that no metric has
void check_metric(const std::string& name, const config::Origin& origin);

/// The plan's `metrics`, or the usual ones. \throws files::InputError with file and line
std::vector<std::string> read_metrics(const config::Document& document);
/// The plan's `budgets`. \throws files::InputError with file and line
std::vector<Budget> read_budgets(const config::Document& document);

}  // namespace traverse::batch
