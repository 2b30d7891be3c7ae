#include "factor_measurement.hpp"

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "traverse/dataset/recording_slice.hpp"
#include "traverse/simulation/drive.hpp"
#include "traverse/simulation/scanner.hpp"
#include "traverse/simulation/worlds.hpp"

namespace traverse::app {

namespace {

loam::FactorBench measure(const std::vector<sensors::LidarScan>& scans,
                          const sensors::LidarProfile& profile, bool motion_compensated,
                          int repeats) {
  const loam::ScanToMapOdometryOptions options;
  const auto correspondences =
      loam::correspondences_of_last(scans, profile, motion_compensated, options);
  return loam::measure_factors(correspondences, options.solver, repeats);
}

std::size_t begin_of(std::size_t first, std::size_t frame) {
  return std::max(first, frame - std::min(frame, kFramesBefore));
}

}  // namespace

loam::FactorBench measure_on_recording(dataset::Source& source, std::size_t first,
                                       std::size_t frame, int repeats) {
  const std::size_t begin = begin_of(first, frame);
  std::vector<sensors::LidarScan> scans;
  std::size_t frames = 0;
  dataset::for_each_in_slice(source, {"", 0, frame}, [&](const sensors::Measurement& measurement) {
    const auto* scan = std::get_if<std::shared_ptr<const sensors::LidarScan>>(&measurement);
    const auto* sensor = source.info().rig.first(sensors::SensorKind::kLidar);
    if (scan == nullptr || sensor == nullptr || (*scan)->sensor != sensor->label) return;
    if (frames++ >= begin) scans.push_back(**scan);
  });
  const auto* sensor = source.info().rig.first(sensors::SensorKind::kLidar);
  if (sensor == nullptr || !sensor->lidar) {
    throw std::runtime_error(source.info().path.string() + ": no 3-D lidar in this recording");
  }
  if (frames <= frame) {
    throw std::runtime_error(fmt::format("{}: frame {} is asked for, but the recording has only {}",
                                         source.info().path.string(), frame, frames));
  }
  auto bench = measure(scans, *sensor->lidar, source.info().motion_compensated, repeats);
  bench.recording = source.info().name;
  bench.frame = frame;
  return bench;
}

loam::FactorBench measure_on_simulated_street(std::size_t frame, int repeats) {
  const simulation::Drive drive;
  const double length_m = drive.speed_mps * 0.1 * static_cast<double>(frame + 1);
  const auto street = simulation::street(length_m, 1);
  simulation::Scanner scanner = simulation::demo_scanner();
  scanner.range_noise_m = 0.02;
  std::vector<sensors::LidarScan> scans;
  for (std::size_t i = begin_of(0, frame); i <= frame; ++i) {
    scans.push_back(scanner.scan(street, drive, 0.1 * static_cast<double>(i)));
  }
  auto bench = measure(scans, scanner.profile, false, repeats);
  bench.recording = "simulated street";
  bench.frame = frame;
  return bench;
}

}  // namespace traverse::app
