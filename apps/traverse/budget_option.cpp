#include "budget_option.hpp"

#include <stdexcept>

#include <fmt/format.h>

namespace traverse::app {

void add_budget_option(CLI::App& command, std::optional<std::filesystem::path>& file) {
  command
      .add_option("--budget", file,
                  "YAML file of figures and their limits; prints pass or fail for each, exit "
                  "status 1 if one is not kept")
      ->type_name("FILE")
      ->check(CLI::ExistingFile);
}

void require_kept(const report::BudgetResult& result) {
  fmt::print("{}", result.table());
  if (!result.passed()) throw std::runtime_error("the budget is not kept");
}

}  // namespace traverse::app
