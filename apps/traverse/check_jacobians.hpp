#pragma once

#include <vector>

#include "traverse/optimization/factor_kind.hpp"

namespace CLI {
class App;
}

namespace traverse::app {

/// The command for any factors; commands.hpp has it for those of Traverse.
void add_check_jacobians(CLI::App& app, std::vector<optimization::FactorKind> kinds);

}  // namespace traverse::app
