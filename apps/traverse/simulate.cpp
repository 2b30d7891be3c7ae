#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "traverse/config/document.hpp"
#include "traverse/config/settings.hpp"
#include "traverse/dataset/recording_writer.hpp"
#include "traverse/dataset/trajectory_streams.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/simulation/ring_order.hpp"
#include "traverse/simulation/simulation.hpp"

#include "commands.hpp"
#include "gnss_table.hpp"
#include "installed_files.hpp"
#include "progress_bar.hpp"

namespace traverse::app {

namespace {

namespace fs = std::filesystem;
using simulation::Simulation;
using simulation::SweepRange;

struct SimulateArguments {
  bool list = false;
  std::string world;
  std::string output;
  std::string format;
  std::string sensor;
  std::size_t first = 0;
  std::size_t last = std::numeric_limits<std::size_t>::max();
  std::optional<double> duration_s;
  std::optional<std::int64_t> seed;
  std::optional<std::int64_t> drive_seed;
  std::vector<std::string> overrides;
  int threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  int gzip_level = 0;
  bool force = false;
};

constexpr const char* kCalibration = "rig.yaml";
constexpr const char* kWorld = "world.yaml";
constexpr const char* kGnss = "gnss.csv";

constexpr const char* kSimulateExamples = R"(Examples:
  traverse simulate --list
  traverse simulate town_loop -o town.rawlog && traverse run town.rawlog -o RUN
  traverse simulate park -o park.rawlog --sensor vlp16 --duration 20
  traverse simulate town_loop -o sequence --format kitti --seed 4 --set place.vehicles=6
  traverse simulate town_loop -o other_day.rawlog --drive-seed 100
  traverse simulate robot -o robot.txt --sensor vlp16
  traverse simulate highway -o fast.rawlog --set route.speed_mps=36 --set imu.rate_hz=200

Beside X.rawlog stand X.traverse.yaml (what holds of it), X.reference.tum (the exact poses),
X.rig.yaml (the calibration), X.world.yaml (every setting, to be simulated again) and X.gnss.csv
(the fixes with their headings and deviations as a table). A KITTI folder holds the same files
without X., and poses.txt and calib.txt of a camera 0 that looks ahead from the lidar's place; of the
other sensors it has gnss.csv only. A text log (X.txt) holds IMU, wheels and fixes with headings. The same seed gives the same bytes. Files of an earlier simulation
are replaced when the new ones are complete; a KITTI folder must be new or empty.)";

void list(const fs::path& share) {
  const auto files = [&](const char* folder) {
    std::vector<fs::path> found;
    for (const auto& entry : fs::directory_iterator(share / folder)) {
      if (entry.path().extension() == ".yaml") found.push_back(entry.path());
    }
    std::sort(found.begin(), found.end());
    return found;
  };
  fmt::print("worlds:\n");
  for (const fs::path& file : files("worlds")) {
    const auto world = simulation::load_world(file, {});
    fmt::print("  {:<15}{} ({})\n", file.stem().string(), world.description, world.sensor);
  }
  fmt::print("sensors:\n");
  for (const fs::path& file : files("sensors")) {
    const auto profile = sensors::load_lidar_profile(file);
    if (profile.firing.period_us == 0) continue;  // known, but not when its beams fire
    fmt::print("  {:<15}{}: {} beams, {:g} to {:g} m, {:.0f} firings a sweep of {:g} s\n",
               file.stem().string(), profile.name, profile.rings, profile.min_range_m,
               profile.max_range_m, 1e6 * profile.sweep_s / profile.firing.period_us,
               profile.sweep_s);
  }
}

fs::path find_sensor(const std::string& name, const fs::path& share) {
  if (name.find('/') != std::string::npos || name.ends_with(".yaml")) return name;
  const fs::path file = share / "sensors" / (name + ".yaml");
  if (fs::exists(file)) return file;
  std::vector<std::string> known;
  for (const auto& entry : fs::directory_iterator(share / "sensors")) {
    known.push_back(entry.path().stem().string());
  }
  std::sort(known.begin(), known.end());
  throw files::InputError(share / "sensors", files::Place::whole_file(),
                          fmt::format("a sensor ({})", fmt::join(known, ", ")),
                          files::in_quotes(name));
}

Simulation make_simulation(const simulation::WorldDescription& world, const fs::path& sensor) {
  const sensors::LidarProfile profile = sensors::load_lidar_profile(sensor);
  try {
    return {world, profile};
  } catch (const std::invalid_argument& error) {
    throw files::InputError(sensor, files::Place::whole_file(), "a lidar that can be simulated",
                            error.what());
  }
}

SweepRange choose_sweeps(const Simulation& simulation, const SimulateArguments& arguments) {
  const std::size_t all = simulation.lidar().sweeps();
  SweepRange sweeps{arguments.first, std::min(arguments.last, all - 1) + 1};
  if (arguments.duration_s) {
    const double sweep_s = simulation.lidar().begin_s(1);
    const double count = std::max(1.0, std::floor(*arguments.duration_s / sweep_s + 0.5));
    if (sweeps.first < sweeps.end && count < static_cast<double>(sweeps.end - sweeps.first)) {
      sweeps.end = sweeps.first + static_cast<std::size_t>(count);
    }
  }
  if (sweeps.first >= sweeps.end) {
    throw std::runtime_error(
        fmt::format("nothing to simulate: the drive of {:.1f} s has sweeps 0 to {}",
                    simulation.motion().duration_s(), all - 1));
  }
  return sweeps;
}

/// What the name of a file says that it is to hold; a folder is KITTI's.
std::string format_of_name(const fs::path& output) {
  const fs::path ending = output.extension();
  if (ending == ".rawlog") return "rawlog";
  return ending == ".txt" || ending == ".log" ? "log" : "kitti";
}

std::string format_of(const SimulateArguments& arguments) {
  return arguments.format.empty() ? format_of_name(arguments.output) : arguments.format;
}

bool is_kitti(const SimulateArguments& arguments) { return format_of(arguments) == "kitti"; }

dataset::RecordingInfo describe(const Simulation& simulation, const SimulateArguments& arguments,
                                std::size_t scans) {
  dataset::RecordingInfo info;
  info.path = arguments.output;
  info.format = "simulation";
  info.name =
      fmt::format("{} ({})", simulation.world().name, simulation.rig().sensors[0].lidar->name);
  info.rig = simulation.rig();
  info.expected_scans = scans;
  if (is_kitti(arguments)) {
    // KITTI's files need a camera 0: one that looks ahead from the lidar's place.
    info.rig.sensors[0].lidar = simulation::in_ring_order(*info.rig.sensors[0].lidar);
    info.T_body_camera = info.rig.sensors[0].T_body_sensor * simulation::camera_axes();
  }
  return info;
}

/// The poses of camera 0 as KITTI's benchmark gives them, the first at the origin.
std::string camera_poses(const dataset::RecordingInfo& info,
                         const geometry::Trajectory& T_map_body) {
  const geometry::Pose3& T_body_camera = *info.T_body_camera;
  const geometry::Pose3 T_first_map = (T_map_body.pose(0) * T_body_camera).inverse();
  std::ostringstream text;
  dataset::write_kitti(text,
                       T_map_body.transformed_left(T_first_map).transformed_right(T_body_camera));
  return std::move(text).str();
}

simulation::WorldDescription chosen_world(const SimulateArguments& arguments,
                                          const fs::path& share) {
  std::vector<std::string> overrides = arguments.overrides;
  if (arguments.seed) overrides.push_back(fmt::format("seed={}", *arguments.seed));
  if (arguments.drive_seed) {
    overrides.push_back(fmt::format("drive_seed={}", *arguments.drive_seed));
  }
  if (!arguments.sensor.empty()) overrides.push_back("sensor=" + arguments.sensor);
  return simulation::load_world(simulation::find_world(arguments.world, share), overrides);
}

void simulate(const SimulateArguments& arguments) {
  const InstalledFiles installed = find_installed_files();
  const simulation::WorldDescription world = chosen_world(arguments, installed.share);
  const Simulation simulation = make_simulation(world, find_sensor(world.sensor, installed.share));
  const SweepRange sweeps = choose_sweeps(simulation, arguments);
  const std::size_t scans = sweeps.end - sweeps.first;

  const bool kitti = is_kitti(arguments);
  const dataset::RecordingInfo info = describe(simulation, arguments, scans);
  const dataset::Reference truth{
      kitti ? simulation.truth(sweeps) : simulation.truth_of_all_sensors(sweeps), arguments.output,
      "exact truth of the simulation", Eigen::Vector3d::UnitY()};
  const bool log = format_of(arguments) == "log";
  const dataset::FilesThere there{arguments.force, {kCalibration, kWorld, kGnss}};
  const auto writer =
      kitti ? dataset::write_scan_folder(arguments.output, info, truth, info.rig.sensors[0].label,
                                         dataset::ScanFolderFormat::kKitti)
      : log ? dataset::write_navigation_log(arguments.output, info, truth, there)
            : dataset::write_rawlog(arguments.output, info, truth, {arguments.gzip_level, there});
  GnssTable gnss;
  ProgressBar bar("simulating", scans, "scans");
  std::size_t done = 0;
  std::size_t points = 0;
  simulation.run(sweeps, arguments.threads, [&](sensors::Measurement&& measurement) {
    if (const auto* fix = std::get_if<sensors::GnssFix>(&measurement)) gnss.add(*fix);
    const auto* scan = std::get_if<std::shared_ptr<const sensors::LidarScan>>(&measurement);
    if (scan == nullptr) {
      if (!kitti) writer->add(measurement);
      return;
    }
    points += (*scan)->size();
    if (log) {
      bar.update(++done);
      return;
    }
    if (kitti) {
      writer->add(std::make_shared<const sensors::LidarScan>(simulation::in_ring_order(**scan)));
    } else {
      writer->add(measurement);
    }
    bar.update(++done);
  });
  writer->add_file(kCalibration, simulation.calibration());
  simulation::WorldDescription resolved = world;
  writer->add_file(kWorld, config::to_yaml([&](config::Binder& b) { bind(b, resolved); }, true));
  if (kitti) writer->add_file("poses.txt", camera_poses(info, truth.T_map_body));
  if (!gnss.empty()) writer->add_file(kGnss, gnss.text());
  writer->commit();
  bar.finish();
  fmt::print("{}: {} scans of {}, {:.1f} M points, {:.1f} m driven, {} triangles\n",
             arguments.output, scans, info.rig.sensors[0].lidar->name,
             static_cast<double>(points) * 1e-6, truth.T_map_body.path_length(),
             simulation.triangles());
}

void check(const SimulateArguments& arguments) {
  if (arguments.list) return;
  if (arguments.world.empty()) throw CLI::RequiredError("WORLD");
  if (arguments.output.empty()) throw CLI::RequiredError("--output");
  if (format_of(arguments) != format_of_name(arguments.output)) {
    throw CLI::ValidationError(
        "--output", "a rawlog ends in .rawlog, a text log in .txt or .log, a KITTI folder in none");
  }
  if (arguments.last < arguments.first) {
    throw CLI::ValidationError("--last", "is before --first");
  }
}

/// The command with its options, and nothing yet that it does.
CLI::App* declare(CLI::App& app, const std::shared_ptr<SimulateArguments>& arguments) {
  CLI::App* command = app.add_subcommand(
      "simulate",
      "drive a lidar, an IMU, wheels and GNSS through a made-up place; write the recording with "
      "its exact truth");
  command->add_option("WORLD", arguments->world, "a world of --list, or a file like theirs");
  command
      ->add_option("-o,--output", arguments->output,
                   "X.rawlog, X.txt for a text log without scans, or a folder for KITTI's layout")
      ->type_name("PATH");
  command->add_flag("--list", arguments->list, "list the worlds and the sensors");
  command
      ->add_option("--format", arguments->format, "rawlog, log or kitti, if the name does not tell")
      ->check(CLI::IsMember({"rawlog", "log", "kitti"}))
      ->option_text("NAME");
  command->add_option("--sensor", arguments->sensor, "lidar of --list, or a file like theirs")
      ->option_text("NAME");
  command->add_option("--first", arguments->first, "first sweep, counted from 0")
      ->check(CLI::NonNegativeNumber)
      ->option_text("N");
  command->add_option("--last", arguments->last, "last sweep, included")
      ->check(CLI::NonNegativeNumber)
      ->option_text("N");
  command->add_option("--duration", arguments->duration_s, "seconds from the first sweep on")
      ->check(CLI::PositiveNumber)
      ->option_text("S");
  command->add_option("--seed", arguments->seed, "of the place, the road and all noise")
      ->check(CLI::NonNegativeNumber)
      ->option_text("N");
  command
      ->add_option("--drive-seed", arguments->drive_seed,
                   "of another drive through the same place: noise, traffic, parked cars, the "
                   "driver's line and pace")
      ->check(CLI::NonNegativeNumber)
      ->option_text("N");
  command->add_option("--set", arguments->overrides, "any key of the world: place.vehicles=6")
      ->option_text("KEY=VALUE")
      ->allow_extra_args(false);
  command->add_option("--threads", arguments->threads, "threads; the result does not depend on it")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  command
      ->add_option("--gzip", arguments->gzip_level,
                   "compression of a rawlog: 0 is quick, 1 halves the file")
      ->check(CLI::Range(0, 9))
      ->capture_default_str();
  command->add_flag("--force", arguments->force,
                    "replace files beside X.rawlog that this program did not write");
  command->footer(kSimulateExamples);
  return command;
}

}  // namespace

void add_simulate(CLI::App& app) {
  const auto arguments = std::make_shared<SimulateArguments>();
  declare(app, arguments)->callback([arguments] {
    check(*arguments);
    if (arguments->list) {
      list(find_installed_files().share);
    } else {
      simulate(*arguments);
    }
  });
}

void add_simulate_check(CLI::App& app) {
  const auto arguments = std::make_shared<SimulateArguments>();
  declare(app, arguments)->callback([arguments] {
    check(*arguments);
    const fs::path share = find_installed_files().share;
    find_sensor(chosen_world(*arguments, share).sensor, share);
  });
}

}  // namespace traverse::app
