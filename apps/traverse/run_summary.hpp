#pragma once

#include "traverse/pipeline/run_folder.hpp"
#include "traverse/pipeline/run_record.hpp"

namespace traverse::app {

/// Prints the headline numbers of a run and where its report is.
void print_run_summary(const pipeline::RunRecord& record, const pipeline::RunFolder& folder,
                       bool with_report);

}  // namespace traverse::app
