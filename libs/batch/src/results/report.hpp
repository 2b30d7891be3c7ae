#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "traverse/batch/plan.hpp"
#include "traverse/batch/results.hpp"

#include "results/baseline.hpp"
#include "results/lead.hpp"
#include "results/summary.hpp"
#include "results/tables.hpp"

namespace traverse::batch {

/// All that a batch's page shows.
struct ReportData {
  const Plan& plan;
  const Results& results;
  const std::vector<VariantSummary>& variants;
  const std::optional<BaselineComparison>& baseline;
  const std::vector<ShownTable>& tables;
  std::vector<Lead> leads;  ///< by the metrics of the plan that the best variants have
  std::vector<std::string> command;
};

/// batch.html as text: one page that needs no network. Its tables and charts are made in the
/// browser from the numbers it carries, so that a thousand runs open at once.
/// \throws files::InputError if a template is missing or is not a valid one.
std::string batch_page(const ReportData& data, const std::filesystem::path& templates);

}  // namespace traverse::batch
