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
#include "traverse/files/atomic_file.hpp"

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
/// The page of 20 systems x 30 recordings x so many repeats; `TRAVERSE_BENCH_PAGES=FOLDER` keeps
/// it.
void page_of_many(benchmark::State& state) {
  Plan plan;
  plan.file = "many.yaml";
  plan.metrics = default_metrics();
  plan.recordings.resize(30);
  plan.pipelines.resize(20);
  std::vector<Job> jobs;
  std::vector<Completion> completions;
  for (std::size_t r = 0; r < plan.recordings.size(); ++r) {
    plan.recordings[r].name = "recording " + std::to_string(r);
    for (std::size_t p = 0; p < plan.pipelines.size(); ++p) {
      plan.pipelines[p].name = "system " + std::to_string(p);
      for (int repeat = 1; repeat <= state.range(0); ++repeat) {
        Job job;
        job.recording = plan.recordings[r].name;
        job.pipeline = plan.pipelines[p].name;
        job.repeat = repeat;
        job.id = std::to_string(jobs.size()) + std::string(60, 'a');
        Completion completion = full_completion(job);
        for (auto& [key, value] : completion.metrics) {
          value = 0.01 * static_cast<double>(1 + (7 * r + 13 * p + jobs.size() % 11) % 97);
        }
        if (jobs.size() % 41 == 40) {
          completion.outcome = Outcome::kFailed;
          completion.reason = "no scan fits the map";
          completion.last_lines = {"one", "two"};
        }
        completions.push_back(std::move(completion));
        jobs.push_back(std::move(job));
      }
    }
  }
  Results results(jobs);
  for (const Completion& completion : completions) results.add(completion);
  const std::optional<BaselineComparison> baseline;
  std::string page;
  for (auto _ : state) {
    const auto variants = summarise(results, plan.budgets, plan.metrics.front());
    page = batch_page({plan, results, variants, baseline, {}, {}, {}},
                      std::string(TRAVERSE_SOURCE_DIR) + "/reports/templates");
  }
  state.counters["megabytes"] = static_cast<double>(page.size()) / 1e6;
  if (const char* folder = std::getenv("TRAVERSE_BENCH_PAGES")) {
    files::write_text(std::filesystem::path(folder) / (std::to_string(jobs.size()) + ".html"),
                      page);
  }
}
BENCHMARK(page_of_many)->Arg(1)->Arg(5)->Unit(benchmark::kMillisecond)->Iterations(1);

BENCHMARK(write_results)->Arg(1000)->Arg(10000)->Unit(benchmark::kMillisecond)->Iterations(1);

}  // namespace
}  // namespace traverse::batch
