#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

#include "traverse/geometry/trajectory.hpp"
#include "traverse/sensors/measurement.hpp"
#include "traverse/sensors/rig.hpp"
#include "traverse/simulation/lidar_simulator.hpp"
#include "traverse/simulation/world_description.hpp"

namespace traverse::simulation {

/// Sweeps of the lidar, counted from 0 at the start of the drive.
struct SweepRange {
  std::size_t first = 0;
  std::size_t end = 0;  ///< behind the last
};

/// A vehicle with its sensors in a world.
class Simulation {
 public:
  /// \throws std::invalid_argument saying what the lidar's profile lacks to be simulated.
  Simulation(const WorldDescription& world, const sensors::LidarProfile& lidar);
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  const WorldDescription& world() const { return world_; }
  const VehicleMotion& motion() const { return motion_; }
  const Surroundings& surroundings() const { return surroundings_; }
  const LidarSimulator& lidar() const { return lidar_; }
  std::size_t triangles() const { return triangles_; }

  /// The sensors with their labels and places: "lidar", "imu", "wheels", "gnss".
  sensors::Rig rig() const;
  /// The exact poses T_map_body at the stamps of the sweeps. The map is the plane east, north, up
  /// at the world's origin.
  geometry::Trajectory truth(const SweepRange& sweeps) const;
  /// The same, and between them at the moments of all samples of the other sensors.
  geometry::Trajectory truth_of_all_sensors(const SweepRange& sweeps) const;
  /// The calibration as YAML: where the sensors sit, and the errors that they keep.
  std::string calibration() const;

  /// Calls `use` with each measurement in the order of stamps, from the first sweep's begin to the
  /// last one's end, in this thread's arena of `threads`. Only a few scans are held at a time.
  void run(const SweepRange& sweeps, int threads,
           const std::function<void(sensors::Measurement&&)>& use) const;

 private:
  geometry::Stamp stamp_at(double seconds) const;
  std::uint64_t seed_of_drive() const;

  WorldDescription world_;
  sensors::LidarProfile profile_;
  VehicleMotion motion_;
  std::size_t triangles_ = 0;
  Surroundings surroundings_;
  LidarSimulator lidar_;
};

}  // namespace traverse::simulation
