#pragma once

#include "traverse/report/budget.hpp"

#include "figures/run_figures.hpp"
#include "run/model.hpp"

namespace traverse::report {

/// `figures` against the limits that `file` states. \throws files::InputError
BudgetResult check_figures(const std::filesystem::path& file,
                           const std::vector<RunFigure>& figures);

/// The lines under "budget" in the JSON and on the page.
void add_budget(const BudgetResult& result, Model& model);

}  // namespace traverse::report
