#include "traverse/batch/batch.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "traverse/batch/metric.hpp"
#include "traverse/batch/slurm.hpp"
#include "traverse/batch/status.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/files/numbers.hpp"

#include "batch_plan_text.hpp"
#include "batch_progress.hpp"
#include "command_line.hpp"
#include "commands.hpp"
#include "installed_files.hpp"
#include "interruption.hpp"
#include "standard_streams.hpp"

namespace traverse::app {

namespace {

namespace fs = std::filesystem;

struct BatchArguments {
  std::string plan;
  std::string folder;
  bool check = false;
  std::string executor = "local";
  int jobs = 0;
  std::string shard;
  bool retry_failed = false;
  bool wait = true;
  std::string baseline;
  std::int64_t last = -1;
  bool is_private = false;
};

fs::path this_program() { return fs::read_symlink("/proc/self/exe"); }

/// Whether `traverse simulate WORDS` would begin: its own arguments are asked.
std::optional<std::string> simulation_error(const std::vector<std::string>& words) {
  CLI::App probe;
  add_simulate_check(probe);
  std::vector<std::string> reversed{"x.rawlog", "-o"};
  reversed.insert(reversed.end(), words.rbegin(), words.rend());
  reversed.emplace_back("simulate");
  try {
    probe.parse(reversed);
  } catch (const std::exception& error) {
    return error.what();
  }
  return std::nullopt;
}

/// A wrong plan is wrong usage.
batch::Plan checked_plan(const BatchArguments& arguments, const fs::path& share) {
  try {
    batch::Plan plan = batch::load_plan(arguments.plan, share, simulation_error);
    print_notes(plan.notes);
    if (arguments.last >= 0) batch::stop_after(arguments.last, plan);
    plan.is_private |= arguments.is_private;
    if (arguments.executor == "local") batch::check_this_machine(plan);
    return plan;
  } catch (const files::InputError& error) {
    throw CLI::ValidationError(error.what());
  }
}

batch::Shard parse_shard(const std::string& text) {
  if (text.empty()) return {};
  const auto parts = files::split_cells(text, '/');
  const auto number = files::parse_integer(parts.front());
  const auto of = parts.size() == 2 ? files::parse_integer(parts.back()) : std::nullopt;
  if (!number || !of || *number < 1 || *number > *of) {
    throw CLI::ValidationError("--shard", "expected i/n with i from 1 to n, found '" + text + "'");
  }
  return {static_cast<std::size_t>(*number), static_cast<std::size_t>(*of)};
}

/// What is wrong with the end of a batch, or nothing.
std::string complaint(const batch::BatchEnd& end, bool all_expected) {
  std::size_t finished = 0;
  std::string text;
  const auto add = [&](std::size_t count, std::string_view what) {
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, what);
  };
  for (const auto& [outcome, rows] : end.state.outcomes) {
    finished += rows;
    if (!is_usable(outcome)) add(rows, name_of(outcome));
  }
  if (all_expected) add(end.state.rows - finished, "not made");
  add(end.over_budget, "over budget");
  add(end.regressed, "regressed against the baseline");
  return text;
}

void run_plan(const BatchArguments& arguments, const std::vector<std::string>& command) {
  const InstalledFiles installed = find_installed_files();
  const batch::Shard shard = parse_shard(arguments.shard);
  const batch::Plan plan = checked_plan(arguments, installed.share);
  if (arguments.check) {
    print_plan(plan);
    return;
  }
  fmt::print("{}\n", batch::describe(plan));
  std::fflush(stdout);

  const batch::BatchFolder folder{fs::absolute(arguments.folder).lexically_normal()};
  batch::BatchOptions options;
  options.program = this_program();
  options.share = installed.share;
  options.templates = installed.templates;
  options.command = command;
  options.jobs = arguments.jobs;
  options.shard = shard;
  options.wait = arguments.wait;
  options.retry_failed = arguments.retry_failed;
  options.baseline = arguments.baseline;
  if (arguments.executor == "slurm") options.executor = batch::Executor::kSlurm;

  const bool is_local = options.executor == batch::Executor::kLocal;
  const OrderlyStop stop([is_local] {
    return is_local ? std::string("stopping: runs at work are given up, what is finished stays")
                    : std::string("stopping to wait; the array goes on");
  });
  batch::BatchEnd end;
  {
    BatchProgress progress(folder);
    batch::BatchObserver observer;
    observer.stop = &stop.requested();
    observer.preparing = [&](const std::string& text) { progress.preparing(text); };
    observer.began = [&](const batch::BatchState& state) { progress.began(state); };
    observer.finished = [&](const auto& state, const auto& job, const auto& completion) {
      progress.finished(state, job, completion);
    };
    observer.tick = [&](const auto& state, const auto& running) { progress.tick(state, running); };
    end = batch::run_batch(plan, folder, options, observer);
  }
  const auto count = [&](batch::Outcome outcome) {
    const auto found = end.state.outcomes.find(outcome);
    return found == end.state.outcomes.end() ? 0 : found->second;
  };
  const std::size_t degraded = count(batch::Outcome::kDegraded);
  fmt::print("{} of {} runs are ok{}; {} made now, {} finished before\n",
             count(batch::Outcome::kOk), end.state.rows,
             degraded > 0 ? fmt::format(", {} degraded", degraded) : "", end.state.made,
             end.state.finished - std::min(end.state.finished, end.state.made));
  fmt::print("results    {}\nreport     {}\n", folder.results_csv().string(),
             folder.report().string());
  if (!plan.tables.empty()) fmt::print("tables     {}\n", folder.tables().string());
  if (end.stopped) {
    print_message("traverse: {}\n",
                  is_local
                      ? "stopped; the same command goes on from here"
                      : "stopped waiting; the array goes on (`traverse batch cancel` ends it)");
    throw CLI::RuntimeError(stop.exit_status());
  }
  const std::string wrong = complaint(end, shard.of == 1 && arguments.wait);
  if (!wrong.empty()) throw std::runtime_error(wrong);
}

constexpr const char* kBatchExamples = R"(Examples:
  traverse batch plan.yaml --check                     explain the plan, run nothing
  traverse batch plan.yaml -o TRY --last 9             ten frames of each run, to see what comes out
  traverse batch plan.yaml -o OUT                      on this machine; OUT/batch.html is the report
  traverse batch plan.yaml -o OUT                      again: goes on where it was, or finds all done
  traverse batch plan.yaml -o OUT --executor slurm     as one job array
  traverse batch plan.yaml -o OUT --shard 2/8          the second eighth, for any other scheduler
  traverse batch plan.yaml -o OUT --baseline OLD       improved, no change or regressed against OLD
  traverse batch status OUT                            from another terminal
docs/batch.md describes plans. Exit status: 0 all runs ok, within budgets and not regressed.)";

void add_status(CLI::App& batch) {
  auto folder = std::make_shared<std::string>();
  CLI::App* command = batch.add_subcommand("status", "how far a batch is");
  command->add_option("OUT", *folder, "the batch's folder")
      ->required()
      ->check(CLI::ExistingDirectory);
  command->callback([folder] {
    const batch::BatchStatus status = batch::read_status({fs::absolute(*folder)});
    fmt::print("{}/{} runs finished", status.finished, status.distinct);
    for (const auto& [outcome, count] : status.outcomes) fmt::print(", {} {}", count, outcome);
    fmt::print("\n");
    if (status.finished < status.distinct && status.runs_per_second > 0) {
      fmt::print("{:.2g} runs/s, about {:.0f} s left at that rate\n", status.runs_per_second,
                 status.seconds_left);
    }
    for (const auto& run : status.running) {
      fmt::print("  {:>6.0f} s  {}  ({})\n", run.seconds, run.title, run.host);
    }
    fmt::print("{}; last event {}\n",
               status.at_work ? "a batch is at work" : "no batch of this machine is at work",
               status.last_event_utc.empty() ? "none" : status.last_event_utc);
  });
}

void add_cancel(CLI::App& batch) {
  auto folder = std::make_shared<std::string>();
  CLI::App* command = batch.add_subcommand(
      "cancel", "end a batch; what is finished stays, and can be gone on with");
  command->add_option("OUT", *folder, "the batch's folder")
      ->required()
      ->check(CLI::ExistingDirectory);
  command->callback([folder] {
    const batch::BatchFolder places{fs::absolute(*folder).lexically_normal()};
    const bool has_array = fs::exists(places.submissions());
    if (has_array) {
      batch::slurm_cancel(places);
      fmt::print("asked Slurm to cancel {}\n", batch::slurm_name(places));
    }
    if (batch::cancel_local(places)) {
      fmt::print("asked the batch at work to end\n");
    } else if (!has_array) {
      throw std::runtime_error("no batch of this machine is at work in " + *folder);
    }
  });
}

void add_metrics(CLI::App& batch) {
  CLI::App* command = batch.add_subcommand("metrics", "list the metrics that plans can name");
  command->callback([] {
    for (const batch::Metric& metric : batch::known_metrics()) {
      fmt::print("{:<40}{}\n", metric.key, batch::with_unit(metric));
    }
  });
}

/// What the tasks of a Slurm array start: not for people.
void add_task(CLI::App& batch) {
  struct TaskArguments {
    batch::SlurmTask task;
    std::string list;
    std::string folder;
  };
  auto arguments = std::make_shared<TaskArguments>();
  CLI::App* command = batch.add_subcommand("task", "run the jobs of one task of a job array");
  command->group("");
  command->add_option("LIST", arguments->list)->required()->check(CLI::ExistingFile);
  command->add_option("-o,--output", arguments->folder)->required();
  command->add_option("--task", arguments->task.task)->required();
  command->add_option("--runs-per-task", arguments->task.runs_per_task);
  command->callback([arguments] {
    const OrderlyStop stop([] { return std::string("stopping: the run at work is given up"); });
    const batch::BatchFolder folder{arguments->folder};
    batch::Journal journal(folder.journals());
    arguments->task.list = arguments->list;
    batch::run_task(arguments->task, {this_program(), folder, journal, stop.requested()});
    if (stop.requested()) throw CLI::RuntimeError(stop.exit_status());
  });
}

}  // namespace

void add_batch(CLI::App& app) {
  auto arguments = std::make_shared<BatchArguments>();
  CLI::App* batch = app.add_subcommand(
      "batch", "evaluate pipelines on recordings as a plan says, here or on a cluster");
  batch->footer(kBatchExamples);
  batch->add_option("PLAN", arguments->plan, "YAML file: recordings, pipelines, grid, limits")
      ->check(CLI::ExistingFile);
  batch->add_option("-o,--output", arguments->folder, "folder of the batch")->type_name("OUT");
  batch->add_flag("--check", arguments->check, "check and explain the plan, run nothing");
  batch->add_option("--executor", arguments->executor, "local, or slurm: one job array")
      ->check(CLI::IsMember({"local", "slurm"}))
      ->capture_default_str();
  batch
      ->add_option("--jobs", arguments->jobs,
                   "runs at one time (default: what cores and memory allow)")
      ->check(CLI::Range(1, 4096));
  batch->add_option("--shard", arguments->shard, "only the i-th of n parts")->type_name("i/n");
  batch->add_flag("--retry-failed", arguments->retry_failed, "make runs that are not ok again");
  batch->add_flag("!--no-wait", arguments->wait, "slurm: submit and return");
  batch
      ->add_option("--last", arguments->last,
                   "stop each run after this frame, counted from 0: to try a plan")
      ->check(CLI::NonNegativeNumber)
      ->option_text("N");
  batch->add_option("--baseline", arguments->baseline, "folder or results.json to compare with")
      ->check(CLI::ExistingPath);
  batch->add_flag("--private", arguments->is_private,
                  "results do not tell whose machines made them, nor paths on them");
  batch->require_subcommand(0, 1);
  add_status(*batch);
  add_cancel(*batch);
  add_metrics(*batch);
  add_task(*batch);
  batch->callback([arguments, batch] {
    if (!batch->get_subcommands().empty()) return;
    if (arguments->plan.empty()) throw CLI::RequiredError("PLAN");
    if (arguments->folder.empty() && !arguments->check) throw CLI::RequiredError("--output");
    if (!arguments->wait && arguments->executor != "slurm") {
      throw CLI::ValidationError("--no-wait", "goes with --executor slurm");
    }
    if (!arguments->shard.empty() && arguments->executor == "slurm") {
      throw CLI::ValidationError("--shard", "the array is shared out by Slurm itself");
    }
    run_plan(*arguments, command_line());
  });
}

}  // namespace traverse::app
