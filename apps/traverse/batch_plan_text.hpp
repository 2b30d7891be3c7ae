#pragma once

#include "traverse/batch/plan.hpp"

namespace traverse::app {

/// Explains a plan on stdout, for `traverse batch --check`.
void print_plan(const batch::Plan& plan);

}  // namespace traverse::app
