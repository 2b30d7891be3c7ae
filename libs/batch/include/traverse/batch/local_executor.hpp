#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "traverse/batch/execute.hpp"

namespace traverse::batch {

/// A job that is being run.
struct RunningJob {
  const Job* job = nullptr;
  std::chrono::steady_clock::time_point since;
};

/// What an executor tells while it works; called from one thread, the caller's.
struct ExecutorEvents {
  std::function<void(const Job&, const Completion&)> finished = [](const auto&, const auto&) {};
  /// A few times a second.
  std::function<void(const std::vector<RunningJob>&)> tick = [](const auto&) {};
};

/// How many runs this machine takes at one time: by its cores, and by its free memory over the
/// memory limit of a run (or over 2 GB, if the plan has none).
int concurrent_runs(const RunLimits& limits);

/// \throws files::InputError with the plan's line if no run within the plan's limits can work on
/// this machine: more threads than cores, more memory than there is.
void check_this_machine(const Plan& plan);

/// Runs the jobs in processes, `slots` at a time, in order.
/// \throws what execute() throws, after the running jobs are ended
void run_locally(const std::vector<Job>& jobs, int slots, const ExecutionContext& context,
                 const ExecutorEvents& events);

}  // namespace traverse::batch
