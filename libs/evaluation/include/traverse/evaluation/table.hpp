#pragma once

#include <string>

#include "traverse/evaluation/evaluate.hpp"

namespace traverse::evaluation {

/// The evaluation as a table for the terminal, with units and how each part was made.
std::string to_table(const Evaluation& evaluation);

}  // namespace traverse::evaluation
