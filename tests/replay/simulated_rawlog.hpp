#pragma once

#include <filesystem>
#include <memory>

#include "traverse/dataset/open_recording.hpp"
#include "traverse/dataset/recording_writer.hpp"
#include "traverse/simulation/scanner.hpp"
#include "traverse/simulation/worlds.hpp"

namespace traverse::testing {

/// A street driven through at 10 m/s with a coarse lidar, exact reference included.
inline void write_simulated_rawlog(const std::filesystem::path& file, std::size_t scans,
                                   int gzip_level = 1) {
  const simulation::AnalyticScene street = simulation::street(80, 1);
  simulation::Drive drive;
  drive.speed_mps = 10;
  simulation::Scanner scanner = simulation::demo_scanner();
  scanner.azimuth_steps = 900;
  std::vector<double> beams;  // every third, for speed
  for (std::size_t i = 0; i < scanner.profile.elevations_deg.size(); i += 3) {
    beams.push_back(scanner.profile.elevations_deg[i]);
  }
  scanner.profile.elevations_deg = beams;
  scanner.profile.rings = static_cast<int>(beams.size());

  dataset::RecordingInfo info;
  info.path = file;
  info.format = "simulation";
  info.name = "street";
  info.rig.body_frame = "lidar";
  sensors::MountedSensor lidar;
  lidar.label = "lidar";
  lidar.lidar = scanner.profile;
  info.rig.sensors.push_back(lidar);
  dataset::Reference truth;
  truth.file = file;
  const geometry::Pose3 T_start_map = drive.pose(0).inverse();
  const auto seconds = [](std::size_t i) { return 0.1 * static_cast<double>(i); };
  for (std::size_t i = 0; i < scans; ++i) {
    truth.T_map_body.push_back(geometry::Stamp::from_seconds(seconds(i)),
                               T_start_map * drive.pose(seconds(i)));
  }
  const auto writer = dataset::write_rawlog(file, info, truth, {gzip_level});
  for (std::size_t i = 0; i < scans; ++i) {
    sensors::LidarScan scan = scanner.scan(street, drive, seconds(i));
    scan.sensor = "lidar";
    writer->add(std::make_shared<const sensors::LidarScan>(std::move(scan)));
  }
  writer->commit();
}

inline dataset::OpenOptions open_options() {
  dataset::OpenOptions options;
  options.share_folder = TRAVERSE_SHARE_DIR;
  return options;
}

}  // namespace traverse::testing
