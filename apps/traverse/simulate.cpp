#include <cmath>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "traverse/dataset/recording_writer.hpp"
#include "traverse/simulation/drive.hpp"
#include "traverse/simulation/scanner.hpp"
#include "traverse/simulation/worlds.hpp"

#include "commands.hpp"
#include "progress_bar.hpp"

namespace traverse::app {

namespace {

constexpr double kSweepsPerSecond = 10;

struct SimulateArguments {
  std::string world;
  std::string output;
  double length_m = 120;
  double speed_mps = 10;
  double noise_m = 0.02;
  unsigned seed = 1;
};

simulation::AnalyticScene make_world(const SimulateArguments& arguments) {
  if (arguments.world == "tunnel") return simulation::tunnel(arguments.length_m);
  return simulation::street(arguments.length_m, arguments.seed);
}

/// What the rawlog says of itself: the sensor as simulated, and the exact truth as its reference.
dataset::RecordingInfo describe(const SimulateArguments& arguments,
                                const simulation::Scanner& scanner, std::size_t scans) {
  dataset::RecordingInfo info;
  info.path = arguments.output;
  info.format = "simulation";
  info.name = fmt::format("simulated {}", arguments.world);
  info.rig.body_frame = "lidar";
  sensors::MountedSensor lidar;
  lidar.label = "lidar";
  lidar.lidar = scanner.profile;
  info.rig.sensors.push_back(std::move(lidar));
  info.expected_scans = scans;
  return info;
}

void simulate(const SimulateArguments& arguments) {
  const simulation::AnalyticScene world = make_world(arguments);
  simulation::Drive drive;
  drive.speed_mps = arguments.speed_mps;
  simulation::Scanner scanner = simulation::demo_scanner();
  scanner.range_noise_m = arguments.noise_m;
  scanner.seed = arguments.seed;

  const auto scans = static_cast<std::size_t>(
      std::floor(arguments.length_m / arguments.speed_mps * kSweepsPerSecond) + 1);
  const dataset::RecordingInfo info = describe(arguments, scanner, scans);
  dataset::Reference truth;
  truth.file = arguments.output;
  truth.description = "exact truth of the simulation";
  const geometry::Pose3 T_start_map = drive.pose(0).inverse();
  for (std::size_t i = 0; i < scans; ++i) {
    const double t = static_cast<double>(i) / kSweepsPerSecond;
    truth.T_map_body.push_back(geometry::Stamp::from_seconds(t), T_start_map * drive.pose(t));
  }

  const auto writer = dataset::write_rawlog(arguments.output, info, truth, {});
  ProgressBar bar("simulating", scans, "scans");
  for (std::size_t i = 0; i < scans; ++i) {
    const double t = static_cast<double>(i) / kSweepsPerSecond;
    writer->add(std::make_shared<const sensors::LidarScan>(scanner.scan(world, drive, t)));
    bar.update(i + 1);
  }
  writer->commit();
  bar.finish();
  fmt::print("{}\n", arguments.output);
}

}  // namespace

void add_simulate(CLI::App& app) {
  auto arguments = std::make_shared<SimulateArguments>();
  CLI::App* command = app.add_subcommand(
      "simulate", "drive a lidar through a made-up place; write a rawlog with the exact truth");
  command->add_option("WORLD", arguments->world, "street, or tunnel (no motion visible along it)")
      ->required()
      ->check(CLI::IsMember({"street", "tunnel"}));
  command->add_option("-o,--output", arguments->output, "rawlog to write")
      ->required()
      ->type_name("FILE.rawlog");
  command->add_option("--length", arguments->length_m, "metres along the street")
      ->check(CLI::Range(1.0, 100000.0))
      ->capture_default_str();
  command->add_option("--speed", arguments->speed_mps, "metres a second")
      ->check(CLI::Range(0.1, 60.0))
      ->capture_default_str();
  command->add_option("--noise", arguments->noise_m, "standard deviation of ranges, metres")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command->add_option("--seed", arguments->seed, "of the houses and the noise")
      ->capture_default_str();
  command->footer(
      "Example:\n"
      "  traverse simulate street -o street.rawlog && traverse run street.rawlog -o RUN");
  command->callback([arguments] {
    if (std::filesystem::path(arguments->output).extension() != ".rawlog") {
      throw CLI::ValidationError("--output", "must end in .rawlog");
    }
    simulate(*arguments);
  });
}

}  // namespace traverse::app
