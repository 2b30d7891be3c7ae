#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace traverse::evaluation {
struct Evaluation;
}

namespace traverse::report {

/// One limit of a budget and what was found.
struct BudgetLine {
  std::string figure;  ///< "frame_median_ms"
  std::string label;   ///< "Time per frame"
  std::string unit;    ///< "ms"; empty for counts
  double limit = 0;
  bool is_least = false;        ///< the limit is the least that the figure may be, else the most
  std::optional<double> value;  ///< nothing where the run does not define the figure

  /// A figure that is not defined does not keep a limit.
  bool passed() const { return value && (is_least ? *value >= limit : *value <= limit); }
  const char* limit_words() const { return is_least ? "at least" : "at most"; }
};

struct BudgetResult {
  std::filesystem::path file;
  std::vector<BudgetLine> lines;
  bool is_private = false;  ///< asks for pages that do not tell whose machine made the run

  bool passed() const;
  /// A line a limit: "pass  frame_median_ms  22.3 ms, at most 100", and the verdict below.
  std::string table() const;
};

/// Reads a budget without a run, to tell early what is wrong with it.
/// \throws files::InputError for an unknown figure, a value that is no number, or no limit at all.
/// \returns whether it asks for results that do not tell whose machine made them (`private: true`)
bool require_valid_budget(const std::filesystem::path& budget);

/// A run against a budget: a YAML file of "figure: at most", or at least for what is better when
/// it is more (registered_share). share/budgets/ has examples;
/// docs/report-json.md lists the figures.
/// \throws files::InputError for a budget with an unknown figure, and as write_run_report() does.
BudgetResult check_budget(const std::filesystem::path& budget,
                          const std::filesystem::path& run_folder);
/// The same for an evaluation alone; figures of the run are not defined there.
BudgetResult check_budget(const std::filesystem::path& budget,
                          const evaluation::Evaluation& evaluation);

}  // namespace traverse::report
