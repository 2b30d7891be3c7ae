#pragma once

#include <optional>

#include <CLI/CLI.hpp>

#include "traverse/report/budget.hpp"

namespace traverse::app {

/// `--budget FILE`, checked to exist.
void add_budget_option(CLI::App& command, std::optional<std::filesystem::path>& file);

/// Prints each limit. \throws std::runtime_error if one is not kept, so that the exit status is 1.
void require_kept(const report::BudgetResult& result);

}  // namespace traverse::app
