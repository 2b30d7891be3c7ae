#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "traverse/batch/batch_folder.hpp"
#include "traverse/batch/local_executor.hpp"
#include "traverse/batch/plan.hpp"
#include "traverse/batch/results.hpp"

namespace traverse::batch {

/// One part of a plan's runs, for schedulers that Traverse does not know: "2/8".
struct Shard {
  std::size_t number = 1;  ///< from 1
  std::size_t of = 1;
};

enum class Executor { kLocal, kSlurm };

struct BatchOptions {
  std::filesystem::path program;  ///< this program, absolute
  std::filesystem::path share;
  std::filesystem::path templates;
  std::vector<std::string> command;  ///< for the report
  Executor executor = Executor::kLocal;
  int jobs = 0;  ///< runs at one time; 0: as many as the machine takes
  Shard shard;
  bool wait = true;                ///< slurm: false submits and returns
  bool retry_failed = false;       ///< runs that are finished but not ok are made again
  std::filesystem::path baseline;  ///< folder or results.json of an earlier batch, or empty
};

/// How far a batch is.
struct BatchState {
  std::size_t rows = 0;                     ///< of the plan
  std::size_t distinct = 0;                 ///< of them, different runs
  std::size_t finished = 0;                 ///< distinct runs that are finished, now or before
  std::size_t to_do = 0;                    ///< distinct runs that this batch has to make
  std::size_t made = 0;                     ///< of them, made
  std::map<Outcome, std::size_t> outcomes;  ///< of the finished rows
};

struct BatchObserver {
  /// What is done before the runs: "making street", "reading drive_0001".
  std::function<void(const std::string& text)> preparing = [](const auto&) {};
  /// Everything is known: the runs begin.
  std::function<void(const BatchState&)> began = [](const auto&) {};
  std::function<void(const BatchState&, const Job&, const Completion&)> finished =
      [](const auto&, const auto&, const auto&) {};
  std::function<void(const BatchState&, const std::vector<RunningJob>&)> tick = [](const auto&,
                                                                                   const auto&) {};
  const std::atomic<bool>* stop = nullptr;
};

/// What came out of a batch.
struct BatchEnd {
  BatchState state{};
  bool stopped = false;
  std::size_t over_budget = 0;  ///< rows that break a budget
  std::size_t regressed = 0;    ///< against the baseline
};

/// Runs what is not finished of the plan and writes results.csv, results.json, leaderboard.tex,
/// tables.md and batch.html, now and then on the way and at the end. \throws files::InputError,
/// files::OutputError; std::runtime_error if another batch is at work in the folder
BatchEnd run_batch(Plan plan, const BatchFolder& folder, const BatchOptions& options,
                   const BatchObserver& observer);

}  // namespace traverse::batch
