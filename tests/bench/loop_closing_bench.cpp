// What closing loops costs on a long drive. Prints two tables: the pose graph of 10,000 keyframes
// with 3,000 loops, a share of them false, solved at once from odometry, and one more loop from the
// solution; and the search for loops at one keyframe when there are 1,000 to 100,000 before it.
//   taskset -c 0 loop_closing_bench graph [KEYFRAMES LOOPS]     on one core
//   loop_closing_bench search [KEYFRAMES]

#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "cpu_seconds.hpp"
#include "loop_search.hpp"
#include "pose_graph/made_drive.hpp"

namespace {

using namespace traverse;

/// One optimisation, a row of the table.
void report(const char* name, pose_graph::PoseGraph& graph, const testing::MadeDrive& drive) {
  pose_graph::Result result;
  const double seconds = testing::cpu_seconds_of([&] { result = graph.optimise(); });
  std::printf("%-28s %9zu %7zu %9zu %7d %11d %10.3f %9.2f\n", name, graph.size(), result.loops,
              result.rejected_loops, result.stages, result.iterations,
              testing::position_rmse(graph, drive), seconds);
}

void measure(std::size_t keyframes, std::size_t loops, double false_share, std::size_t alike) {
  testing::MadeDriveOptions options;
  options.laps = 4;
  options.keyframes_a_lap = keyframes / options.laps;
  options.loops = static_cast<std::size_t>(static_cast<double>(loops) * (1 - false_share));
  options.false_share = false_share;
  options.alike = alike;
  const testing::MadeDrive drive = testing::made_drive(options, 1);
  testing::MadeDrive all_but_last = drive;
  all_but_last.loops.pop_back();

  pose_graph::PoseGraph graph = testing::odometry_graph(drive);
  std::string share = std::to_string(std::lround(100 * false_share)) + " % false loops";
  if (alike > 1) share += ", groups of " + std::to_string(alike);
  std::printf("%-28s odometry's rmse %.3f m\n", share.c_str(),
              testing::position_rmse(graph, drive));
  if (false_share > 0) {
    pose_graph::PoseGraph without = graph;
    testing::add_loops(without, drive, all_but_last.loops);
    report("  its true loops alone", without, drive);
    testing::add_loops(graph, drive, drive.false_loops);
  }
  testing::add_loops(graph, drive, all_but_last.loops);
  report("  from odometry", graph, drive);
  testing::add_loops(graph, drive, {drive.loops.back()});
  report("  one more loop", graph, drive);
}

void graphs(std::size_t keyframes, std::size_t loops) {
  std::printf("%-28s %9s %7s %9s %7s %11s %10s %9s\n", "", "keyframes", "loops", "rejected",
              "stages", "iterations", "rmse m", "cpu s");
  for (const double false_share : {0.0, 0.01, 0.3}) measure(keyframes, loops, false_share, 1);
  measure(keyframes, loops, 0.3, 10);
}

void search(std::size_t most) {
  std::vector<std::size_t> sizes;
  for (const std::size_t size : {1000U, 3000U, 10'000U, 30'000U, 100'000U}) {
    if (size <= most) sizes.push_back(size);
  }
  const auto places = testing::simulated_places(sizes.back() + testing::kSearches);
  testing::print_loop_search(places, sizes);
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  const std::string what = arguments.empty() ? "" : arguments[0];
  if (what != "search") {
    const bool is_sized = arguments.size() > 2;
    graphs(is_sized ? std::stoul(arguments[1]) : 10'000,
           is_sized ? std::stoul(arguments[2]) : 3000);
  }
  if (what != "graph") search(arguments.size() == 2 ? std::stoul(arguments[1]) : 100'000);
}
