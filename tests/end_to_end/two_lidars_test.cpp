/// Two lidars on one simulated vehicle whose clocks differ, used as one, against each of them
/// alone.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "traverse/dataset/recording_writer.hpp"
#include "traverse/sensors/lidar_profile.hpp"
#include "traverse/simulation/lidar_simulator.hpp"
#include "traverse/simulation/simulation.hpp"

#include "end_to_end/program.hpp"

namespace traverse {
namespace {

namespace fs = std::filesystem;
using sensors::LidarScan;
using sensors::SensorKind;

constexpr double kClocksApart_s = 0.003;

geometry::Pose3 mounted(double yaw, double x) {
  return {Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix(), {x, 0, 1.8}};
}

/// 64 rings with a quarter of the firings, so that a test can drive with two of them.
sensors::LidarProfile thinned_os1() {
  auto profile =
      sensors::load_lidar_profile(std::string(TRAVERSE_SHARE_DIR) + "/sensors/os1_64.yaml");
  profile.firing.period_us *= 4;
  return profile;
}

/// Writes the first seconds of a drive through the short town. \param blocked_from_s the rear lidar
/// sees nothing for ten seconds from then on; negative: it always sees
void write_drive(const fs::path& file, int seed, double seconds, double blocked_from_s) {
  auto world = simulation::load_world(std::string(TRAVERSE_SHARE_DIR) + "/worlds/town_short.yaml",
                                      {"seed=" + std::to_string(seed)});
  const sensors::LidarProfile profile = thinned_os1();
  const simulation::Simulation drive(world, profile);
  const geometry::Pose3 T_body_front = mounted(0, 1.5);
  const geometry::Pose3 T_body_rear = mounted(3.1, -1.5);
  const simulation::LidarSimulator front(profile, T_body_front, drive.surroundings(),
                                         drive.motion(), 11);
  const simulation::LidarSimulator rear(profile, T_body_rear, drive.surroundings(), drive.motion(),
                                        12);
  dataset::RecordingInfo info;
  info.name = "two lidars";
  info.rig.body_frame = "vehicle";
  info.rig.sensors.push_back({"front", SensorKind::kLidar, T_body_front, profile});
  info.rig.sensors.push_back({"rear", SensorKind::kLidar, T_body_rear, profile});
  const auto sweeps = static_cast<std::size_t>(seconds / profile.sweep_s);
  dataset::Reference truth{{}, file, "exact truth", Eigen::Vector3d::UnitY()};
  for (std::size_t i = 0; i < sweeps; ++i) {
    const double t = front.stamp_s(i);
    truth.T_map_body.push_back(geometry::Stamp::from_seconds(world.start_s + t),
                               drive.motion().state(t).T_map_body);
  }
  const auto writer = dataset::write_rawlog(file, info, truth, {0});
  for (std::size_t i = 0; i < sweeps; ++i) {
    const double t = front.stamp_s(i);
    LidarScan ahead = front.scan(i);
    ahead.sensor = "front";
    ahead.stamp = geometry::Stamp::from_seconds(world.start_s + t);
    writer->add(std::make_shared<const LidarScan>(std::move(ahead)));
    const bool is_blocked = blocked_from_s >= 0 && t >= blocked_from_s && t < blocked_from_s + 10;
    if (is_blocked) continue;
    LidarScan behind = rear.scan(i);
    behind.sensor = "rear";
    behind.stamp = geometry::Stamp::from_seconds(world.start_s + t + kClocksApart_s);
    writer->add(std::make_shared<const LidarScan>(std::move(behind)));
  }
  writer->commit();
}

/// Root mean square of the position error after alignment [m].
double ape_m(const fs::path& recording, const fs::path& run, const std::string& lidars) {
  const auto result =
      testing::run_program("run " + recording.string() + " -o " + run.string() +
                           " --no-slam --no-report --no-hash --recording lidars=" + lidars);
  EXPECT_EQ(result.status, 0) << result.everything();
  std::ifstream stream(run / "evaluation.json");
  if (!stream) return std::nan("");
  return nlohmann::json::parse(stream).at("ape").at("translation").at("rmse").get<double>();
}

TEST(TwoLidars, AreBetterThanTheBetterOfThem) {
  const testing::TemporaryFolder folder;
  double both = 0;
  double better = 0;
  for (const int seed : {3, 4}) {
    const fs::path drive = folder / ("drive" + std::to_string(seed) + ".rawlog");
    write_drive(drive, seed, 20, -1);
    const double front = ape_m(drive, folder / "front", "front");
    const double rear = ape_m(drive, folder / "rear", "rear");
    const double two = ape_m(drive, folder / "both", "front,rear");
    std::printf("seed %d: front %.4f m, rear %.4f m, both %.4f m\n", seed, front, rear, two);
    both += two * two;
    better += std::min(front, rear) * std::min(front, rear);
    for (const char* run : {"front", "rear", "both"}) fs::remove_all(folder / run);
  }
  EXPECT_LE(std::sqrt(both), 0.8 * std::sqrt(better));
}

TEST(TwoLidars, OneThatIsBlockedForTenSecondsCostsNothingButItsPoints) {
  const testing::TemporaryFolder folder;
  write_drive(folder / "a.rawlog", 4, 20, 5);
  const double front = ape_m(folder / "a.rawlog", folder / "front", "front");
  const double both = ape_m(folder / "a.rawlog", folder / "both", "front,rear");
  std::printf("front %.4f m, both %.4f m\n", front, both);
  EXPECT_LE(both, front);
}

}  // namespace
}  // namespace traverse
