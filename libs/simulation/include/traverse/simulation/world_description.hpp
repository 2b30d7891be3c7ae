#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "traverse/config/binder.hpp"
#include "traverse/simulation/gnss_simulator.hpp"
#include "traverse/simulation/imu_simulator.hpp"
#include "traverse/simulation/mounting.hpp"
#include "traverse/simulation/place.hpp"
#include "traverse/simulation/route.hpp"
#include "traverse/simulation/terrain.hpp"
#include "traverse/simulation/vehicle_motion.hpp"
#include "traverse/simulation/wheel_simulator.hpp"

namespace traverse::simulation {

/// By how much the stamps of a sensor are late, seconds. The lidar's clock is the right one.
struct ClockSettings {
  double imu_late_s = 0;
  double wheels_late_s = 0;
  double gnss_late_s = 0;
};

/// Everything that makes a simulated recording but the lidar: share/worlds/*.yaml.
struct WorldDescription {
  std::string name = "world";     ///< for titles
  std::string description;        ///< one line
  std::string sensor = "hdl64e";  ///< the lidar, if the command line names none
  std::int64_t seed = 1;          ///< of the place and, unless drive_seed tells, of the drive
  std::int64_t drive_seed = -1;   ///< of another drive through the place; -1 or `seed`: its own
  double start_s = 1767225600;    ///< Unix time of the drive's start
  RouteSettings route;
  TerrainSettings terrain;
  PlaceSettings place;
  SuspensionSettings suspension;
  GaitSettings gait;
  Mounting lidar{1.0, 0, 1.9, 0, 0, 0};
  ImuSettings imu;
  WheelSettings wheels;
  GnssSettings gnss;
  ClockSettings clock;
};
void bind(config::Binder& binder, WorldDescription& world);

/// The seed of what differs between drives through one place: noise and biases of all sensors, what
/// moves, what is parked, the driver's line and pace. Nothing: the drive that the place was built
/// with.
std::optional<std::uint64_t> other_drive(const WorldDescription& world);

/// The world of `file` with `overrides` ("route.speed_mps=8") on top.
/// \throws files::InputError naming file and line: no YAML, an unknown key, a value out of range, a
/// route that cannot be driven.
WorldDescription load_world(const std::filesystem::path& file,
                            const std::vector<std::string>& overrides);

/// The file of a world: `name` itself if it names a file, otherwise share/worlds/NAME.yaml.
/// \throws files::InputError listing the worlds there are.
std::filesystem::path find_world(const std::string& name, const std::filesystem::path& share);

}  // namespace traverse::simulation
