#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "traverse/batch/batch_folder.hpp"
#include "traverse/batch/completion.hpp"
#include "traverse/batch/job.hpp"
#include "traverse/batch/plan.hpp"

namespace traverse::batch {

/// The plan's runs and the records of those that are finished.
class Results {
 public:
  explicit Results(std::vector<Job> jobs) : jobs_(std::move(jobs)) {}

  /// Reads the records that are there. \param again finished runs for which this is true are not
  /// taken, to be made again
  void load(const BatchFolder& folder, const std::function<bool(const Completion&)>& again);
  void add(Completion completion) { completions_[completion.id] = std::move(completion); }

  const std::vector<Job>& jobs() const { return jobs_; }
  /// The record of a job; nullptr if it is not finished.
  const Completion* find(const Job& job) const;
  std::size_t finished() const { return completions_.size(); }
  /// Each run that is not finished, once.
  std::vector<Job> pending() const;

 private:
  std::vector<Job> jobs_;
  std::map<std::string, Completion> completions_;
};

/// The value of a metric; nothing if the run does not have it.
std::optional<double> value_of(const Completion& completion, const std::string& metric);

/// How many of the finished rows ended how.
std::map<Outcome, std::size_t> count_outcomes(const Results& results);

/// "at most", or "at least" where more is better.
std::string_view limit_words(const Budget& budget);

/// The budgets that the run breaks, as metric names.
std::vector<std::string> broken_budgets(const Completion& completion,
                                        const std::vector<Budget>& budgets);

/// results.csv: one row a run of the plan, every metric that any run has. \throws
/// files::OutputError
void write_csv(const std::filesystem::path& file, const Results& results);

/// results.json: the same with settings, identities and last lines of logs; a baseline for later.
void write_json(const std::filesystem::path& file, const Plan& plan, const Results& results);

}  // namespace traverse::batch
