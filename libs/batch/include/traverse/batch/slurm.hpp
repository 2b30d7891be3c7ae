#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "traverse/batch/local_executor.hpp"
#include "traverse/batch/plan.hpp"

namespace traverse::batch {

/// The name of a batch's arrays in Slurm's queue: from the folder's path, so that the queue itself
/// remembers what was submitted, whoever was killed meanwhile.
std::string slurm_name(const BatchFolder& folder);

/// Tasks of this batch in the queue.
struct SlurmQueue {
  std::size_t running = 0;
  std::size_t pending = 0;  ///< lines of the queue: an array that waits is one
  bool empty() const { return running + pending == 0; }
};

/// \throws std::runtime_error with Slurm's message if squeue cannot be asked.
SlurmQueue slurm_queue(const BatchFolder& folder);

/// Takes all tasks of this batch out of the queue and ends those that run.
/// \throws std::runtime_error with Slurm's message.
void slurm_cancel(const BatchFolder& folder);

/// Submits the jobs as one array, whose tasks run them (run_task()) on any node that sees the
/// folder and the program under the same path, and, with `wait`, tells of each as it is finished.
/// An array of this batch that is in the queue already is waited for first. Runs that the scheduler
/// lost (a node that went down, a task's limit) are submitted again, as often as the limits'
/// attempts say; then they count as crashed.
/// \throws std::runtime_error with Slurm's message if the array is refused
void run_on_slurm(const std::vector<Job>& jobs, const Plan& plan, const ExecutionContext& context,
                  const ExecutorEvents& events, bool wait);

/// The words after "traverse batch" that run_on_slurm() has each task start with.
/// A task runs the jobs of its lines of the list, one after the other, that are not finished.
struct SlurmTask {
  std::filesystem::path list;
  std::size_t task = 0;
  std::size_t runs_per_task = 1;
};
void run_task(const SlurmTask& task, const ExecutionContext& context);

}  // namespace traverse::batch
