#include "traverse/simulation/simulation.hpp"

#include <cmath>
#include <map>
#include <memory>
#include <utility>

#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include "sample_streams.hpp"

namespace traverse::simulation {

using sensors::LidarScan;
using sensors::Measurement;

namespace {

constexpr const char* kLidar = "lidar";
constexpr const char* kImu = "imu";
constexpr const char* kWheels = "wheels";
constexpr const char* kGnss = "gnss";

/// Sweeps in flight for each thread: what is held in memory.
constexpr std::size_t kInFlight = 3;

std::uint64_t seed_of(const WorldDescription& world) {
  return static_cast<std::uint64_t>(world.seed);
}

Terrain terrain_of(const WorldDescription& world) { return {world.terrain, seed_of(world)}; }

Place place_of(const WorldDescription& world, std::size_t& triangles) {
  Place place = build_place(world.place, Route(world.route), terrain_of(world), seed_of(world),
                            other_drive(world));
  triangles = place.still.size();
  return place;
}

}  // namespace

Simulation::Simulation(const WorldDescription& world, const sensors::LidarProfile& lidar)
    : world_(world),
      profile_(lidar),
      motion_(world.route, world.suspension, terrain_of(world), seed_of(world), other_drive(world),
              world.gait),
      surroundings_(place_of(world, triangles_)),
      lidar_(lidar, world.lidar.T_body_sensor(), surroundings_, motion_, seed_of_drive()) {}

std::uint64_t Simulation::seed_of_drive() const {
  return other_drive(world_).value_or(seed_of(world_));
}

sensors::Rig Simulation::rig() const {
  sensors::Rig rig;
  rig.body_frame = "vehicle";
  const auto add = [&](const char* label, sensors::SensorKind kind, const geometry::Pose3& T) {
    rig.sensors.push_back({label, kind, T, std::nullopt});
  };
  add(kLidar, sensors::SensorKind::kLidar, world_.lidar.T_body_sensor());
  rig.sensors.back().lidar = profile_;
  if (world_.imu.mounted) {
    add(kImu, sensors::SensorKind::kImu, world_.imu.mounting.T_body_sensor());
  }
  if (world_.wheels.mounted) add(kWheels, sensors::SensorKind::kWheels, geometry::Pose3());
  if (world_.gnss.mounted) {
    add(kGnss, sensors::SensorKind::kGnss, world_.gnss.mounting.T_body_sensor());
  }
  return rig;
}

geometry::Stamp Simulation::stamp_at(double seconds) const {
  return geometry::shifted(geometry::Stamp::from_seconds(world_.start_s), seconds);
}

geometry::Trajectory Simulation::truth(const SweepRange& sweeps) const {
  geometry::Trajectory truth;
  for (std::size_t i = sweeps.first; i < sweeps.end; ++i) {
    const double seconds = lidar_.stamp_s(i);
    truth.push_back(stamp_at(seconds), motion_.state(seconds).T_map_body);
  }
  return truth;
}

geometry::Trajectory Simulation::truth_of_all_sensors(const SweepRange& sweeps) const {
  const double begin_s = lidar_.begin_s(sweeps.first);
  const double end_s = lidar_.begin_s(sweeps.end);
  std::map<geometry::Stamp, double> seconds_at;  // in order, each moment once
  for (std::size_t i = sweeps.first; i < sweeps.end; ++i) {
    seconds_at.emplace(stamp_at(lidar_.stamp_s(i)), lidar_.stamp_s(i));
  }
  const auto add = [&](bool mounted, double rate_hz) {
    if (!mounted) return;
    for (auto i = std::ceil(begin_s * rate_hz); i < end_s * rate_hz; ++i) {
      seconds_at.emplace(stamp_at(i / rate_hz), i / rate_hz);
    }
  };
  add(world_.imu.mounted, world_.imu.rate_hz);
  add(world_.wheels.mounted, world_.wheels.rate_hz);
  add(world_.gnss.mounted, world_.gnss.rate_hz);
  geometry::Trajectory truth;
  for (const auto& [stamp, seconds] : seconds_at) {
    truth.push_back(stamp, motion_.state(seconds).T_map_body);
  }
  return truth;
}

void Simulation::run(const SweepRange& sweeps, int threads,
                     const std::function<void(Measurement&&)>& use) const {
  ImuSimulator imu(world_.imu, motion_, seed_of_drive());
  WheelSimulator wheels(world_.wheels, motion_, seed_of_drive());
  GnssSimulator gnss(world_.gnss, surroundings_, motion_, seed_of_drive());
  const auto finish = [&](auto sample, const char* label, double late_s) {
    sample.sensor = label;
    sample.stamp = stamp_at(sample.stamp.seconds() + late_s);
    return Measurement(std::move(sample));
  };
  SampleStreams others;
  const ClockSettings& clock = world_.clock;
  if (world_.imu.mounted) {
    others.add(world_.imu.rate_hz, clock.imu_late_s, [&](std::size_t i) {
      return std::optional(finish(imu.sample(i), kImu, clock.imu_late_s));
    });
  }
  if (world_.wheels.mounted) {
    others.add(world_.wheels.rate_hz, clock.wheels_late_s, [&](std::size_t) {
      return std::optional(finish(wheels.next(), kWheels, clock.wheels_late_s));
    });
  }
  if (world_.gnss.mounted) {
    others.add(world_.gnss.rate_hz, clock.gnss_late_s,
               [&](std::size_t i) -> std::optional<Measurement> {
                 auto fix = gnss.sample(i);
                 if (!fix) return std::nullopt;
                 return finish(std::move(*fix), kGnss, clock.gnss_late_s);
               });
  }
  others.give_until(lidar_.begin_s(sweeps.first), [](Measurement&&) {});  // what was before

  // Sweeps are simulated side by side and given out in order.
  using Scan = std::shared_ptr<LidarScan>;
  std::size_t next = sweeps.first;
  std::size_t done = sweeps.first;
  const auto number = tbb::make_filter<void, std::size_t>(
      tbb::filter_mode::serial_in_order, [&](tbb::flow_control& control) {
        if (next == sweeps.end) control.stop();
        return next == sweeps.end ? next : next++;
      });
  const auto scan = tbb::make_filter<std::size_t, Scan>(
      tbb::filter_mode::parallel,
      [&](std::size_t i) { return std::make_shared<LidarScan>(lidar_.scan(i)); });
  const auto give =
      tbb::make_filter<Scan, void>(tbb::filter_mode::serial_in_order, [&](const Scan& made) {
        const double seconds = lidar_.stamp_s(done++);
        others.give_until(seconds, use);
        made->stamp = stamp_at(seconds);
        made->sensor = kLidar;
        use(std::shared_ptr<const LidarScan>(made));
      });
  tbb::task_arena arena(threads);
  arena.execute([&] {
    tbb::parallel_pipeline(kInFlight * static_cast<std::size_t>(threads), number & scan & give);
  });
  others.give_until(lidar_.begin_s(sweeps.end), use);
}

}  // namespace traverse::simulation
