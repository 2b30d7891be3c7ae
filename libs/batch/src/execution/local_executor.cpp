#include "traverse/batch/local_executor.hpp"

#include <algorithm>
#include <deque>
#include <exception>
#include <fstream>
#include <optional>
#include <string>
#include <thread>

#include <fmt/format.h>

#include "traverse/parallel/mutex.hpp"

#include "plan/plan_error.hpp"

namespace traverse::batch {

namespace {

constexpr std::chrono::milliseconds kTick{100};
constexpr double kUsualMemory_mb = 2000;

/// Megabytes on the line `name` of /proc/meminfo.
double memory_mb(const std::string& name) {
  std::ifstream stream("/proc/meminfo");
  std::string key;
  double kilobytes = 0;
  for (std::string rest; stream >> key >> kilobytes; std::getline(stream, rest)) {
    if (key == name + ":") return kilobytes / 1024;
  }
  return 0;
}

/// The queue that the workers share with the thread that waits for them.
class Queue {
 public:
  Queue(const std::vector<Job>& jobs, int slots)
      : jobs_(jobs), running_(static_cast<std::size_t>(slots)), workers_(slots) {}

  /// The next job for `slot`; nullptr when there is no more.
  const Job* take(std::size_t slot) {
    const parallel::Lock lock(mutex_);
    if (next_ == jobs_.size() || failure_) return nullptr;
    const Job& job = jobs_[next_++];
    running_[slot] = {&job, std::chrono::steady_clock::now()};
    return &job;
  }

  void put_back(std::size_t slot, std::optional<Completion> completion) {
    const parallel::Lock lock(mutex_);
    if (completion) done_.emplace_back(running_[slot].job, std::move(*completion));
    running_[slot].job = nullptr;
    changed_.notify_one();
  }

  void fail(std::exception_ptr failure) {
    const parallel::Lock lock(mutex_);
    if (!failure_) failure_ = std::move(failure);
  }

  void worker_ended() {
    const parallel::Lock lock(mutex_);
    --workers_;
    changed_.notify_one();
  }

  /// Waits a tick or until something changes. \returns whether workers are left.
  bool wait(std::deque<std::pair<const Job*, Completion>>& done, std::vector<RunningJob>& running) {
    const parallel::Lock lock(mutex_);
    const auto until = std::chrono::steady_clock::now() + kTick;
    while (done_.empty() && workers_ > 0 &&
           changed_.wait_until(mutex_, until) == std::cv_status::no_timeout) {
    }
    done.swap(done_);
    running.clear();
    for (const RunningJob& job : running_) {
      if (job.job != nullptr) running.push_back(job);
    }
    return workers_ > 0;
  }

  std::exception_ptr failure() const {
    const parallel::Lock lock(mutex_);
    return failure_;
  }

 private:
  const std::vector<Job>& jobs_;
  mutable parallel::Mutex mutex_;
  parallel::Condition changed_;
  std::size_t next_ TRAVERSE_GUARDED_BY(mutex_) = 0;
  std::vector<RunningJob> running_ TRAVERSE_GUARDED_BY(mutex_);
  std::deque<std::pair<const Job*, Completion>> done_ TRAVERSE_GUARDED_BY(mutex_);
  int workers_ TRAVERSE_GUARDED_BY(mutex_);
  std::exception_ptr failure_ TRAVERSE_GUARDED_BY(mutex_);
};

}  // namespace

int concurrent_runs(const RunLimits& limits) {
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const double each = limits.memory_mb > 0 ? limits.memory_mb : kUsualMemory_mb;
  const int by_memory = static_cast<int>(memory_mb("MemAvailable") / each);
  return std::max(1, std::min(cores / limits.threads, by_memory));
}

void check_this_machine(const Plan& plan) {
  const auto cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  if (plan.limits.threads > cores) {
    throw plan_error(
        plan.threads_origin,
        fmt::format("at most the {} cores of this machine for 'limits.threads'", cores),
        std::to_string(plan.limits.threads));
  }
  const double memory = memory_mb("MemTotal");
  if (plan.limits.memory_mb > memory) {
    throw plan_error(
        plan.memory_origin,
        fmt::format("at most the {:.0f} MB of this machine for 'limits.memory_mb'", memory),
        fmt::format("{:g}", plan.limits.memory_mb));
  }
}

void run_locally(const std::vector<Job>& jobs, int slots, const ExecutionContext& context,
                 const ExecutorEvents& events) {
  Queue queue(jobs, slots);
  std::atomic<bool> stop{false};
  const ExecutionContext stoppable{context.program, context.folder, context.journal, stop};
  const auto work = [&](std::size_t slot) {
    try {
      while (const Job* job = stop ? nullptr : queue.take(slot)) {
        queue.put_back(slot, execute(*job, stoppable));
      }
    } catch (...) {
      queue.fail(std::current_exception());
      queue.put_back(slot, std::nullopt);
      stop = true;
    }
    queue.worker_ended();
  };
  std::vector<std::jthread> workers;
  for (std::size_t slot = 0; slot < static_cast<std::size_t>(slots); ++slot) {
    workers.emplace_back(work, slot);
  }
  std::vector<RunningJob> running;
  for (bool busy = true; busy;) {
    std::deque<std::pair<const Job*, Completion>> done;
    busy = queue.wait(done, running);
    if (context.stop) stop = true;
    try {
      for (const auto& [job, completion] : done) events.finished(*job, completion);
      events.tick(running);
    } catch (...) {
      queue.fail(std::current_exception());
      stop = true;
    }
  }
  if (queue.failure()) std::rethrow_exception(queue.failure());
}

}  // namespace traverse::batch
