#pragma once

#include <string>
#include <vector>

#include "traverse/evaluation/evaluate.hpp"
#include "traverse/pipeline/run_folder.hpp"
#include "traverse/pipeline/run_record.hpp"

namespace traverse::app {

/// The figures of a comparison in words, the most telling first.
/// \param by_fixes what a run that fixes hold is worth is how far it is off, not how far it drifts
std::vector<std::string> accuracy_lines(const evaluation::Comparison& comparison, bool by_fixes);

/// Prints the headline numbers of a run and where its report is.
void print_run_summary(const pipeline::RunRecord& record, const pipeline::RunFolder& folder,
                       bool with_report);

}  // namespace traverse::app
