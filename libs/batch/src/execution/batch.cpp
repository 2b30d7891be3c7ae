#include "traverse/batch/batch.hpp"

#include <algorithm>
#include <chrono>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "traverse/batch/execute.hpp"
#include "traverse/batch/journal.hpp"
#include "traverse/batch/slurm.hpp"
#include "traverse/files/atomic_file.hpp"
#include "traverse/files/number_text.hpp"
#include "traverse/pipeline/provenance.hpp"

#include "execution/lock.hpp"
#include "plan/own_folder.hpp"
#include "plan/program_id.hpp"
#include "plan/recordings.hpp"
#include "results/baseline.hpp"
#include "results/lead.hpp"
#include "results/report.hpp"
#include "results/summary.hpp"
#include "results/tables.hpp"

namespace traverse::batch {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// Results are written anew at most this often, and never so often that writing takes more than a
/// hundredth of the time.
constexpr std::chrono::seconds kWriteEvery{5};
constexpr int kWritingShare = 100;

/// Writes what came out so far.
class ResultWriter {
 public:
  ResultWriter(const Plan& plan, const BatchFolder& folder, const BatchOptions& options,
               const Results& results)
      : plan_(plan), folder_(folder), options_(options), results_(results) {
    if (!options.baseline.empty()) baseline_.emplace(options.baseline);
  }

  void write() {
    const auto began = Clock::now();
    const auto variants = summarise(results_, plan_.budgets, plan_.metrics.front());
    std::optional<BaselineComparison> baseline;
    if (baseline_) baseline = baseline_->compare(results_, plan_.metrics);
    write_csv(folder_.results_csv(), results_);
    write_json(folder_.results_json(), plan_, results_);
    files::write_text(folder_.leaderboard_tex(),
                      page::to_latex(leaderboard(variants, plan_.metrics)));
    const std::vector<ShownTable> tables = shown_tables(plan_, results_);
    if (!tables.empty()) {
      files::write_text(folder_.tables(), tables_markdown(plan_, tables, made()));
    }
    const RunFolderOf folder_of = [this](const Job& job) { return folder_.run(job.id); };
    std::vector<Lead> leads;
    for (const std::string& metric : plan_.metrics) {
      const auto lead = find_lead(metric, results_, variants, folder_of);
      if (lead) leads.push_back(*lead);
    }
    files::write_text(folder_.report(), batch_page({plan_, results_, variants, baseline, tables,
                                                    leads, options_.command, folder_of},
                                                   options_.templates));
    regressed_ = baseline ? count_regressions(*baseline) : 0;
    next_ = Clock::now() +
            std::max<Clock::duration>(kWriteEvery, kWritingShare * (Clock::now() - began));
  }

  void write_now_and_then() {
    if (Clock::now() >= next_) write();
  }

  std::size_t regressed() const { return regressed_; }

 private:
  std::string made() const {
    const pipeline::BuildInfo build = pipeline::build_info();
    return fmt::format("Made by `{}` with Traverse {}, commit `{}`; {} each run.",
                       fmt::join(options_.command, " "), build.version, build.commit,
                       files::plural(static_cast<std::size_t>(plan_.limits.threads), "thread"));
  }

  static std::size_t count_regressions(const BaselineComparison& baseline) {
    const auto regressed = [](const auto& change) { return change.verdict == Verdict::kRegressed; };
    return static_cast<std::size_t>(
        std::count_if(baseline.ok.begin(), baseline.ok.end(), regressed) +
        std::count_if(baseline.changes.begin(), baseline.changes.end(), regressed));
  }

  const Plan& plan_;
  const BatchFolder& folder_;
  const BatchOptions& options_;
  const Results& results_;
  std::optional<Baseline> baseline_;
  Clock::time_point next_ = Clock::now() + kWriteEvery;
  std::size_t regressed_ = 0;
};

/// The jobs whose place in the plan falls to this shard.
std::vector<Job> of_shard(const std::vector<Job>& pending, const std::vector<Job>& all,
                          const Shard& shard) {
  std::set<std::string_view> mine;
  for (std::size_t i = shard.number - 1; i < all.size(); i += shard.of) mine.insert(all[i].id);
  std::vector<Job> jobs;
  for (const Job& job : pending) {
    if (mine.contains(job.id)) jobs.push_back(job);
  }
  return jobs;
}

fs::path lock_file(const BatchFolder& folder, const Shard& shard) {
  return folder.path / (shard.of == 1 ? std::string("lock")
                                      : fmt::format("lock.{}-of-{}", shard.number, shard.of));
}

std::size_t count_over_budget(const Plan& plan, const Results& results) {
  std::size_t count = 0;
  for (const Job& job : results.jobs()) {
    const Completion* completion = results.find(job);
    if (completion != nullptr && !broken_budgets(*completion, plan.budgets).empty()) ++count;
  }
  return count;
}

/// Keeps the state while runs are finished, without counting everything anew each time.
class StateKeeper {
 public:
  StateKeeper(const Results& results, std::size_t to_do) {
    for (const Job& job : results.jobs()) ++rows_of_[job.id];
    state_.rows = results.jobs().size();
    state_.distinct = rows_of_.size();
    state_.finished = results.finished();
    state_.to_do = to_do;
    state_.outcomes = count_outcomes(results);
  }

  void add(const Completion& completion) {
    ++state_.made;
    ++state_.finished;
    state_.outcomes[completion.outcome] += rows_of_.at(completion.id);
  }
  const BatchState& state() const { return state_; }

 private:
  std::map<std::string, std::size_t> rows_of_;
  BatchState state_;
};

}  // namespace

BatchEnd run_batch(Plan plan, const BatchFolder& folder, const BatchOptions& options,
                   const BatchObserver& observer) {
  static const std::atomic<bool> kNever{false};
  const std::atomic<bool>& stop = observer.stop != nullptr ? *observer.stop : kNever;
  if (options.executor == Executor::kLocal) check_this_machine(plan);
  require_own_folder(folder, plan.text);
  folder.prepare();
  const BatchLock lock(lock_file(folder, options.shard));
  Journal journal(folder.journals());
  remove_abandoned(folder);
  files::write_text(folder.plan(), plan.text);

  const std::string program = program_id(options.program, options.share);
  make_recordings(plan, folder, options.program, program, stop,
                  [&](const std::string& name) { observer.preparing("making " + name); });
  if (stop) return {.stopped = true};
  const RecordingDigests digests = digest_recordings(
      plan, folder, [&](const std::string& name) { observer.preparing("reading " + name); });

  convert_recordings(plan, folder, digests, options.program, stop,
                     [&](const std::string& name) { observer.preparing("converting " + name); });
  if (stop) return {.stopped = true};

  Results results(make_jobs(plan, digests, program, options.share));
  write_jobs(folder.jobs(), results.jobs());
  results.load(folder, [&](const Completion& completion) {
    return options.retry_failed && !is_usable(completion.outcome);
  });
  const std::vector<Job> jobs =
      of_shard(results.pending(), distinct(results.jobs()), options.shard);
  if (options.retry_failed) {
    for (const Job& job : jobs) discard(folder, job);
  }

  ResultWriter writer(plan, folder, options, results);
  StateKeeper keeper(results, jobs.size());
  observer.began(keeper.state());
  journal.began(fmt::format("{}: {} runs to make of {}", describe(plan), jobs.size(),
                            keeper.state().distinct));
  ExecutorEvents events;
  events.finished = [&](const Job& job, const Completion& completion) {
    results.add(completion);
    keeper.add(completion);
    observer.finished(keeper.state(), job, completion);
  };
  events.tick = [&](const std::vector<RunningJob>& running) {
    observer.tick(keeper.state(), running);
    writer.write_now_and_then();
  };
  const ExecutionContext context{options.program, folder, journal, stop};
  if (options.executor == Executor::kSlurm) {
    run_on_slurm(jobs, plan, context, events, options.wait);
  } else {
    const int slots = options.jobs > 0 ? options.jobs : concurrent_runs(plan.limits);
    run_locally(jobs, slots, context, events);
  }
  results.load(folder, [](const Completion&) { return false; });  // what other shards finished
  writer.write();
  BatchEnd end;
  end.state = StateKeeper(results, jobs.size()).state();
  end.state.made = keeper.state().made;
  end.stopped = stop;
  end.over_budget = count_over_budget(plan, results);
  end.regressed = writer.regressed();
  journal.ended(end.stopped ? "stopped by the user" : "");
  return end;
}

}  // namespace traverse::batch
