// The pose graph of a long drive: 10,000 keyframes with 3,000 loops, a share of them false, solved
// at once from odometry; and one more loop from the solution. Prints a table.
//   taskset -c 0 pose_graph_bench [KEYFRAMES LOOPS]     on one core

#include <cstdio>
#include <ctime>
#include <string>

#include "pose_graph/made_drive.hpp"

namespace {

using namespace traverse;

/// Of the processor: what other programs take of a shared machine does not count.
double seconds_of(const auto& action) {
  const std::clock_t begin = std::clock();
  action();
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

void report(const char* name, pose_graph::PoseGraph& graph, const testing::MadeDrive& drive) {
  pose_graph::Result result;
  const double seconds = seconds_of([&] { result = graph.optimise(); });
  std::printf("%-28s %9zu %7zu %9zu %7d %11d %10.3f %9.2f\n", name, graph.size(), result.loops,
              result.rejected_loops, result.stages, result.iterations,
              testing::position_rmse(graph, drive), seconds);
}

void measure(std::size_t keyframes, std::size_t loops, double false_share) {
  testing::MadeDriveOptions options;
  options.laps = 4;
  options.keyframes_a_lap = keyframes / options.laps;
  options.loops = static_cast<std::size_t>(static_cast<double>(loops) * (1 - false_share));
  options.false_share = false_share;
  const testing::MadeDrive drive = testing::made_drive(options, 1);
  testing::MadeDrive all_but_last = drive;
  all_but_last.loops.pop_back();

  pose_graph::PoseGraph graph = testing::odometry_graph(drive);
  testing::add_loops(graph, drive, drive.false_loops);
  testing::add_loops(graph, drive, all_but_last.loops);
  const std::string share = std::to_string(std::lround(100 * false_share)) + " % false loops";
  std::printf("%-28s odometry's rmse %.3f m\n", share.c_str(),
              testing::position_rmse(graph, drive));
  report("  from odometry", graph, drive);
  testing::add_loops(graph, drive, {drive.loops.back()});
  report("  one more loop", graph, drive);
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t keyframes = argc > 2 ? std::stoul(argv[1]) : 10000;
  const std::size_t loops = argc > 2 ? std::stoul(argv[2]) : 3000;
  std::printf("%-28s %9s %7s %9s %7s %11s %10s %9s\n", "", "keyframes", "loops", "rejected",
              "stages", "iterations", "rmse m", "cpu s");
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  measure(keyframes, loops, 0);
  measure(keyframes, loops, 0.01);
}
