// What a batch adds to the time of its runs, and what its results cost to write.
//
//   batch_bench
//
// "overhead_ms" is the time a place for runs is not running one, a run: places x elapsed time less
// the sum of the runs' own wall times, over the number of runs. The runs write a trajectory and
// end.

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "traverse/batch/local_executor.hpp"
#include "traverse/batch/metric.hpp"
#include "traverse/batch/results.hpp"

#include "results/report.hpp"
#include "temporary_folder.hpp"

namespace traverse::batch {
namespace {

Job short_job(std::size_t number) {
  Job job;
  job.id = std::to_string(1'000'000'000'000'000 + number) + std::string(48, '0');
  job.recording = "recording " + std::to_string(number % 4);
  job.pipeline = "pipeline";
  job.settings = {"a=" + std::to_string(number / 4)};
  job.arguments = {"-c", "echo '0 0 0 0 0 0 0 1' > trajectory.tum"};
  return job;
}

void overhead_of_a_run(benchmark::State& state) {
  const auto places = static_cast<int>(state.range(0));
  double overhead_s = 0;
  double runs = 0;
  for (auto _ : state) {
    const testing::TemporaryFolder temporary;
    const BatchFolder folder{temporary / "out"};
    folder.prepare();
    std::vector<Job> jobs;
    for (std::size_t i = 0; i < 200; ++i) jobs.push_back(short_job(i));
    Journal journal(folder.journals());
    const std::atomic<bool> stop{false};
    double own_s = 0;
    ExecutorEvents events;
    events.finished = [&](const Job&, const Completion& completion) { own_s += completion.wall_s; };
    const auto began = std::chrono::steady_clock::now();
    run_locally(jobs, places, {"/bin/sh", folder, journal, stop}, events);
    const double elapsed_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    overhead_s += places * elapsed_s - own_s;
    runs += static_cast<double>(jobs.size());
  }
  state.counters["overhead_ms"] = 1000 * overhead_s / runs;
}
BENCHMARK(overhead_of_a_run)->Arg(1)->Arg(4)->Unit(benchmark::kMillisecond)->Iterations(2);

/// A run's record as it is with all its metrics.
Completion full_completion(const Job& job) {
  Completion completion;
  completion.id = job.id;
  completion.outcome = Outcome::kOk;
  for (const Metric& metric : known_metrics())
    completion.metrics.emplace_back(metric.key, 0.123456);
  return completion;
}

void write_results(benchmark::State& state) {
  const testing::TemporaryFolder folder;
  std::vector<Job> jobs;
  for (std::size_t i = 0; i < static_cast<std::size_t>(state.range(0)); ++i) {
    jobs.push_back(short_job(i));
  }
  Results results(jobs);
  for (const Job& job : jobs) results.add(full_completion(job));
  Plan plan;
  plan.metrics = default_metrics();
  plan.recordings.resize(4);
  for (std::size_t i = 0; i < 4; ++i) plan.recordings[i].name = "recording " + std::to_string(i);
  plan.pipelines.resize(1);
  plan.pipelines[0].name = "pipeline";
  const std::optional<BaselineComparison> baseline;
  for (auto _ : state) {
    const auto variants = summarise(results, plan.budgets, plan.metrics.front());
    write_csv(folder / "results.csv", results);
    write_json(folder / "results.json", plan, results);
    benchmark::DoNotOptimize(batch_page({plan, results, variants, baseline, {}, {}, {}},
                                        std::string(TRAVERSE_SOURCE_DIR) + "/reports/templates"));
  }
}
BENCHMARK(write_results)->Arg(1000)->Arg(10000)->Unit(benchmark::kMillisecond)->Iterations(1);

}  // namespace
}  // namespace traverse::batch
