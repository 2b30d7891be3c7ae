#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "traverse/batch/plan.hpp"
#include "traverse/batch/results.hpp"

#include "results/baseline.hpp"
#include "results/lead.hpp"
#include "results/run_series.hpp"
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
  RunFolderOf folder_of = {};  ///< where the runs are, for what varies along their drives
  /// From the page to a run's folder; nothing: as in a batch's folder. Empty: there is no way.
  std::function<std::string(const Job&)> link_of = {};
  /// Of runs that no batch made: how they were compared, in place of what the plan says.
  std::optional<page::Table> fairness = {};

  bool is_of_a_batch() const { return !fairness; }
  std::string link(const Job& job) const;
};

/// batch.html as text: one page that needs no network. Its tables and charts are made in the
/// browser from the numbers it carries, so that a thousand runs open at once.
/// \throws files::InputError if a template is missing or is not a valid one.
std::string batch_page(const ReportData& data, const std::filesystem::path& templates);

}  // namespace traverse::batch
