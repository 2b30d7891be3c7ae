#pragma once

#include <vector>

#include "traverse/batch/planned_table.hpp"
#include "traverse/config/document.hpp"

namespace traverse::batch {

struct Plan;

/// The tables that `document` asks for, of the recordings and pipelines of `plan`; columns are the
/// plan's metrics where a table does not say. \throws files::InputError with file and line
std::vector<PlannedTable> read_tables(const config::Document& document, const Plan& plan);

}  // namespace traverse::batch
