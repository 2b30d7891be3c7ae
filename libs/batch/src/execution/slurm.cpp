#include "traverse/batch/slurm.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <thread>

#include <fmt/format.h>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/digest.hpp"
#include "traverse/files/numbers.hpp"
#include "traverse/files/shell_word.hpp"
#include "traverse/pipeline/provenance.hpp"

#include "execution/command.hpp"
#include "execution/host_name.hpp"

namespace traverse::batch {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kSlurmTick{200};
constexpr std::chrono::seconds kLookAtRuns{2};
constexpr std::chrono::seconds kLookAtQueue{5};
/// A result may be seen late through a network file system that keeps folders in its cache.
constexpr std::chrono::seconds kLastResults{5};
/// What a run needs beside its own time, and a task beside its run's memory.
constexpr double kMargin_s = 60;
constexpr double kMargin_mb = 200;

/// A controller that is busy or changes over is back within a minute or so.
const Waits kForSubmission{std::chrono::seconds(1),  std::chrono::seconds(2),
                           std::chrono::seconds(4),  std::chrono::seconds(8),
                           std::chrono::seconds(16), std::chrono::seconds(32)};
/// What it knows is not needed for certain.
const Waits kForQuestion{std::chrono::seconds(1), std::chrono::seconds(2)};

/// The largest index of an array is below this.
std::size_t largest_array(const fs::path& scratch, const std::atomic<bool>& stop) {
  std::istringstream lines(
      patient_output({"scontrol", "show", "config"}, scratch, kForSubmission, stop));
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("MaxArraySize")) continue;
    const auto words = files::split_words(line);
    const auto size = files::parse_integer(words.back());
    if (size && *size > 0) return static_cast<std::size_t>(*size);
  }
  return 1001;  // Slurm's own default
}

SlurmQueue queue_of(const BatchFolder& folder, const Waits& waits, const std::atomic<bool>& stop) {
  std::istringstream lines(
      patient_output({"squeue", "--noheader", "--format=%T", "--name=" + slurm_name(folder)},
                     folder.path, waits, stop));
  SlurmQueue queue;
  for (std::string state; std::getline(lines, state);) {
    ++(state == "PENDING" ? queue.pending : queue.running);
  }
  return queue;
}

/// The words of sbatch for an array of `tasks` tasks.
std::vector<std::string> submission(const Plan& plan, const ExecutionContext& context,
                                    const fs::path& list, std::size_t tasks,
                                    std::size_t runs_per_task) {
  const fs::path logs = fs::path(list).replace_extension("");
  // A program that is not ours, and then what it wrote is taken over: each may take as long.
  const bool has_commands = std::any_of(
      plan.pipelines.begin(), plan.pipelines.end(),
      [](const PlannedPipeline& pipeline) { return static_cast<bool>(pipeline.command); });
  const double steps = has_commands ? 2 : 1;
  std::vector<std::string> words{
      "sbatch",
      "--parsable",
      "--requeue",
      "--job-name=" + slurm_name(context.folder),
      fmt::format("--array=0-{}{}", tasks - 1,
                  plan.slurm.max_at_once > 0 ? fmt::format("%{}", plan.slurm.max_at_once) : ""),
      fmt::format("--output={}/%a.log", logs.string()),
      fmt::format("--cpus-per-task={}", plan.limits.threads),
      fmt::format("--time={:.0f}", std::ceil(static_cast<double>(runs_per_task) *
                                             (steps * plan.limits.time_s + kMargin_s) / 60))};
  if (plan.limits.memory_mb > 0) {
    words.push_back(fmt::format("--mem={:.0f}M", plan.limits.memory_mb + kMargin_mb));
  }
  words.insert(words.end(), plan.slurm.sbatch.begin(), plan.slurm.sbatch.end());
  words.push_back("--wrap=exec " + files::in_shell_quotes(context.program.string()) +
                  " batch task " + files::in_shell_quotes(list.string()) + " -o " +
                  files::in_shell_quotes(context.folder.path.string()) +
                  " --task $SLURM_ARRAY_TASK_ID --runs-per-task " + std::to_string(runs_per_task));
  return words;
}

void submit(const std::vector<Job>& jobs, const Plan& plan, const ExecutionContext& context) {
  const fs::path scratch = context.folder.submissions();
  const std::size_t max_tasks = largest_array(scratch, context.stop);
  const std::size_t runs_per_task = plan.slurm.runs_per_task > 0
                                        ? static_cast<std::size_t>(plan.slurm.runs_per_task)
                                        : (jobs.size() + max_tasks - 1) / max_tasks;
  const std::size_t tasks = (jobs.size() + runs_per_task - 1) / runs_per_task;
  // Tasks read their lines when they start: a list is never written over.
  std::string ids;
  for (const Job& job : jobs) ids += job.id;
  const fs::path list =
      scratch /
      fmt::format("{}.jsonl", files::sha256_of_text(ids + pipeline::utc_now()).substr(0, 12));
  files::make_writable_folder(fs::path(list).replace_extension(""));
  write_jobs(list, jobs);
  // A submission that timed out may have been taken all the same. Then two arrays have the same
  // list, which costs time and nothing else: a run that is finished is not made again, and of two
  // that are made at once the first to end stands.
  const std::string answer = patient_output(submission(plan, context, list, tasks, runs_per_task),
                                            scratch, kForSubmission, context.stop);
  context.journal.began(fmt::format("Slurm array {} of {} tasks for {} runs",
                                    answer.substr(0, answer.find_first_of("\n;")), tasks,
                                    jobs.size()));
}

/// Waits for the runs of jobs that tasks on other machines finish.
class Collector {
 public:
  Collector(const std::vector<Job>& jobs, const ExecutionContext& context,
            const ExecutorEvents& events)
      : context_(context), events_(events) {
    for (const Job& job : jobs) waiting_[BatchFolder::run_name(job.id)] = &job;
  }

  std::vector<Job> missing() const {
    std::vector<Job> jobs;
    for (const auto& [name, job] : waiting_) jobs.push_back(*job);
    return jobs;
  }
  bool complete() const { return waiting_.empty(); }

  /// One look into the folder of runs.
  void look() {
    std::error_code failure;
    for (const auto& entry : fs::directory_iterator(context_.folder.runs(), failure)) {
      const auto found = waiting_.find(entry.path().filename().string());
      if (found == waiting_.end()) continue;
      const Job& job = *found->second;
      auto completion = find_completion(context_.folder.completion(job.id));
      if (!completion || is_outdated(*completion, job)) continue;
      waiting_.erase(found);
      events_.finished(job, *completion);
    }
  }

  /// Looks until all is there, the queue is empty or the user stops it.
  void wait() {
    auto next_queue = Clock::now();
    auto next_runs = Clock::now();
    std::optional<Clock::time_point> queue_empty_since;
    while (!complete() && !context_.stop) {
      if (Clock::now() >= next_runs) {
        look();
        next_runs = Clock::now() + kLookAtRuns;
      }
      if (Clock::now() >= next_queue) {
        if (!is_queue_empty()) {
          queue_empty_since.reset();
        } else if (!queue_empty_since) {
          queue_empty_since = Clock::now();
        }
        next_queue = Clock::now() + kLookAtQueue;
      }
      if (queue_empty_since && Clock::now() - *queue_empty_since > kLastResults) break;
      events_.tick({});
      std::this_thread::sleep_for(kSlurmTick);
    }
    look();
  }

 private:
  /// A controller that does not answer for a while still has the array.
  bool is_queue_empty() const {
    try {
      return slurm_queue(context_.folder).empty();
    } catch (const std::runtime_error&) {
      return false;
    }
  }

  const ExecutionContext& context_;
  const ExecutorEvents& events_;
  std::map<std::string, const Job*, std::less<>> waiting_;
};

/// A run that the scheduler never let come to its end.
Completion lost(const Job& job, const ExecutionContext& context) {
  Completion completion;
  completion.id = job.id;
  completion.identity = job.identity;
  completion.outcome = Outcome::kCrashed;
  completion.reason =
      fmt::format("no result after {} submissions: see the logs in {}", job.limits.attempts,
                  context.folder.submissions().filename().string());
  completion.attempts = job.limits.attempts;
  completion.host = host_name();
  completion.started_utc = pipeline::utc_now();
  completion.limits = job.limits;
  files::AtomicFolder folder(context.folder.run(job.id));
  files::write_text(folder.temporary_path() / "result.json", to_json(completion));
  folder.commit();
  context.journal.finished(job, completion);
  return completion;
}

/// Whether an earlier command's array is in the queue. Of a controller that does not say, not: see
/// submit().
bool has_array(const ExecutionContext& context) {
  try {
    return !queue_of(context.folder, kForQuestion, context.stop).empty();
  } catch (const std::runtime_error& error) {
    if (!is_passing(error.what())) throw;
    context.journal.began(fmt::format("Slurm does not say what it has queued: {}", error.what()));
    return false;
  }
}

}  // namespace

std::string slurm_name(const BatchFolder& folder) {
  return "traverse-" +
         files::sha256_of_text(fs::weakly_canonical(folder.path).string()).substr(0, 12);
}

SlurmQueue slurm_queue(const BatchFolder& folder) {
  const std::atomic<bool> stop{false};
  return queue_of(folder, {}, stop);
}

void slurm_cancel(const BatchFolder& folder) {
  const std::atomic<bool> stop{false};
  patient_output({"scancel", "--name=" + slurm_name(folder)}, folder.path, kForSubmission, stop);
}

void run_on_slurm(const std::vector<Job>& jobs, const Plan& plan, const ExecutionContext& context,
                  const ExecutorEvents& events, bool wait) {
  files::make_writable_folder(context.folder.submissions());
  Collector collector(jobs, context, events);
  if (has_array(context)) {
    if (!wait) return;
    collector.wait();
  }
  for (int attempt = 1; !collector.complete() && !context.stop; ++attempt) {
    if (attempt > plan.limits.attempts) {
      for (const Job& job : collector.missing()) events.finished(job, lost(job, context));
      return;
    }
    submit(collector.missing(), plan, context);
    if (!wait) return;
    collector.wait();
  }
}

void run_task(const SlurmTask& task, const ExecutionContext& context) {
  for (const Job& job : read_jobs(task.list, task.task * task.runs_per_task, task.runs_per_task)) {
    if (context.stop) return;
    const auto done = find_completion(context.folder.completion(job.id));
    if (!done || is_outdated(*done, job)) execute(job, context);
  }
}

}  // namespace traverse::batch
