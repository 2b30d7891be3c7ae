#include <algorithm>
#include <filesystem>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "commands.hpp"
#include "factor_measurement.hpp"
#include "json_output.hpp"
#include "recording_options.hpp"
#include "table.hpp"

namespace traverse::app {

namespace {

using loam::FactorBench;
using loam::Spread;

constexpr const char* kBenchFactorsExamples = R"(Examples:
  traverse bench-factors                               on a frame of a simulated street
  traverse bench-factors 2011_09_26_drive_0001 --frame 50 --json factors.json
  traverse run DRIVE -o RUN --bench-factors            the same as a part of RUN's report
  traverse bench-factors DRIVE --json RUN/factor_bench.json && traverse report RUN

Every derivative works on the same correspondences, in turn, in each of the repeats; shown are medians
± half of what lies between the quartiles. "swept" points have each seen their part of the sweep's
motion, Exp(s Log R) p + s t, as in LOAM's scan-to-scan stage. docs/mathematics.md derives both.)";

struct BenchFactorsArguments {
  RecordingOptions recording;
  std::size_t frame = kFramesBefore;
  int repeats = kFactorRepeats;
  std::optional<std::filesystem::path> json;
};

/// The median and half of what lies between the quartiles.
std::string spread_text(const Spread& spread) {
  const int decimals = spread.median < 10 ? 2 : spread.median < 100 ? 1 : 0;
  return fmt::format("{:.{}f} ± {:.{}f}", spread.median, decimals,
                     (spread.upper_quartile - spread.lower_quartile) / 2, decimals);
}

/// The costs of one case: analytic, automatic, numeric.
template <typename Cost>
std::vector<std::span<const Cost>> by_case(const std::vector<Cost>& costs) {
  constexpr std::size_t kEach = optimization::kDerivativeNames.size();
  std::vector<std::span<const Cost>> cases;
  for (std::size_t i = 0; i + kEach <= costs.size(); i += kEach) {
    cases.emplace_back(costs.data() + i, kEach);
  }
  return cases;
}

Table table_of(std::size_t columns) {
  std::vector<Table::Column> layout(columns, {Table::Align::kRight});
  layout.front().align = Table::Align::kLeft;
  return Table(layout);
}

std::string ratio(const Spread& a, const Spread& b) {
  return fmt::format("{:.1f}", a.median / b.median);
}

std::string evaluations_text(const FactorBench& bench) {
  Table table = table_of(6);
  table.add_row({"", "analytic", "automatic", "numeric", "automatic", "numeric"});
  table.add_row({"factor", "ns", "ns", "ns", "/ analytic", "/ analytic"});
  for (const auto& costs : by_case(bench.evaluations)) {
    table.add_row({costs[0].factor, spread_text(costs[0].nanoseconds),
                   spread_text(costs[1].nanoseconds), spread_text(costs[2].nanoseconds),
                   ratio(costs[1].nanoseconds, costs[0].nanoseconds),
                   ratio(costs[2].nanoseconds, costs[0].nanoseconds)});
  }
  return table.text(2);
}

std::string solves_text(const FactorBench& bench) {
  Table table = table_of(8);
  table.add_row(
      {"", "analytic", "automatic", "numeric", "automatic", "numeric", "", "poses apart"});
  table.add_row({"factors", "ms", "ms", "ms", "/ analytic", "/ analytic", "steps", "m / deg"});
  for (const auto& costs : by_case(bench.solves)) {
    const double metres = std::max(costs[1].from_analytic_m, costs[2].from_analytic_m);
    const double radians = std::max(costs[1].from_analytic_rad, costs[2].from_analytic_rad);
    table.add_row(
        {fmt::format("{}", fmt::join(costs[0].factors, " + ")), spread_text(costs[0].milliseconds),
         spread_text(costs[1].milliseconds), spread_text(costs[2].milliseconds),
         ratio(costs[1].milliseconds, costs[0].milliseconds),
         ratio(costs[2].milliseconds, costs[0].milliseconds),
         fmt::format("{}/{}/{}", costs[0].iterations, costs[1].iterations, costs[2].iterations),
         fmt::format("{:.0e} / {:.0e}", metres, radians * 180 / std::numbers::pi)});
  }
  return table.text(2);
}

void print(const FactorBench& bench) {
  fmt::print(
      "{}, frame {}: {} line and {} plane matches, {} repeats, CPU time of one thread\n\nA "
      "residual with its "
      "Jacobians, nanoseconds\n{}",
      bench.recording, bench.frame, bench.lines, bench.planes, bench.repeats,
      evaluations_text(bench));
  if (!bench.solves.empty()) {
    fmt::print("\nA whole solve for the pose, milliseconds\n{}", solves_text(bench));
  }
}

void bench_factors(BenchFactorsArguments& arguments) {
  FactorBench bench;
  if (arguments.recording.recording.empty()) {
    bench = measure_on_simulated_street(arguments.frame, arguments.repeats);
  } else {
    const auto source = arguments.recording.open();
    bench = measure_on_recording(*source, 0, arguments.frame, arguments.repeats);
  }
  print(bench);
  if (arguments.json) write_json_output(*arguments.json, to_json(bench));
}

}  // namespace

void add_bench_factors(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "bench-factors", "measure analytic, automatic and numeric derivatives on one frame");
  const auto arguments = std::make_shared<BenchFactorsArguments>();
  add_recording_options(*command, arguments->recording);
  command->get_option("RECORDING")
      ->required(false)
      ->description(
          "KITTI folder, folder of PCD or PLY files, or MRPT rawlog; without one a "
          "simulated street");
  command
      ->add_option("--frame", arguments->frame,
                   "counted from 0; up to ten frames before it are followed to it")
      ->check(CLI::Range(1, 100'000'000))
      ->capture_default_str();
  command->add_option("--repeats", arguments->repeats, "of each measurement")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  command->add_option("--json", arguments->json, "write every figure to this file")
      ->type_name("FILE");
  command->footer(kBenchFactorsExamples);
  command->callback([arguments] { bench_factors(*arguments); });
}

}  // namespace traverse::app
