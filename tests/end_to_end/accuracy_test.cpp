/// The accuracy of every preset on a simulated drive against what it was when it was last looked
/// at, so that a regression is seen. After an intended change:
/// TRAVERSE_WRITE_ACCURACY=1 build/release/tests/end_to_end/accuracy_test, and say in the commit
/// why.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "end_to_end/program.hpp"

namespace traverse {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr double kTolerance = 0.05;  // of the figure

fs::path golden_file() {
  return fs::path(TRAVERSE_SOURCE_DIR) / "tests/end_to_end/accuracy_of_presets.json";
}

/// With three significant digits: what a person compares.
double rounded(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return std::atof(text);
}

Json figures_of(const fs::path& run) {
  std::ifstream stream(run / "evaluation.json");
  const Json evaluation = Json::parse(stream);
  Json figures{{"ape_rmse_m", rounded(evaluation.at("ape").at("translation").at("rmse"))}};
  const Json& kitti = evaluation.at("kitti");
  if (!kitti.is_null()) {
    figures["kitti_drift_percent"] = rounded(kitti.at("translation_percent"));
  }
  return figures;
}

TEST(Accuracy, OfEveryPresetOnTheShortTownIsAsItWas) {
  const testing::TemporaryFolder folder;
  const std::string drive = (folder / "town.rawlog").string();
  ASSERT_EQ(testing::run_program("simulate town_short --sensor vlp16 -o " + drive).status, 0);
  Json found;
  const auto note_figures = [&](const std::string& name, const std::string& options) {
    const fs::path run = folder / name;
    const auto result = testing::run_program("run " + drive + " -o " + run.string() +
                                             " --no-report --no-hash --pipeline " + options);
    ASSERT_EQ(result.status, 0) << name << ": " << result.messages;
    found[name] = figures_of(run);
  };
  for (const char* preset : {"traverse", "floam", "aloam", "loam", "gins-gnss", "gins-odom",
                             "gins-phone", "gins-window"}) {
    note_figures(preset, preset);
  }
  note_figures("traverse-odometry", "traverse --no-slam");
  note_figures("traverse-inertial-odometry", "traverse-inertial --no-slam");
  // On a road that the lidar sees well an IMU must not spoil it.
  const auto ape_of = [&](const char* name) { return found[name]["ape_rmse_m"].get<double>(); };
  EXPECT_LE(ape_of("traverse-inertial-odometry"), 1.03 * ape_of("traverse-odometry"));
  if (std::getenv("TRAVERSE_WRITE_ACCURACY") != nullptr) {
    std::ofstream(golden_file()) << found.dump(1) << "\n";
  }
  std::ifstream stream(golden_file());
  const Json golden = Json::parse(stream);
  ASSERT_EQ(golden.size(), found.size());
  for (const auto& [preset, figures] : golden.items()) {
    for (const auto& [name, value] : figures.items()) {
      const double then = value.get<double>();
      const double now = found.at(preset).at(name).get<double>();
      EXPECT_LE(std::abs(now - then), kTolerance * then)
          << preset << ", " << name << ": " << now << " where it was " << then;
    }
  }
}

/// Sixteen rings between bare walls for a minute: how far the lidar seems to have gone from where
/// it was first.
TEST(Accuracy, ALidarThatStandsStaysWhereItIs) {
  const testing::TemporaryFolder folder;
  const std::string drive = (folder / "standing.rawlog").string();
  ASSERT_EQ(testing::run_program("simulate corridor_loop --set route.standstill_s=60 --duration 60 "
                                 "-o " +
                                 drive)
                .status,
            0);
  const fs::path run = folder / "run";
  ASSERT_EQ(testing::run_program("run " + drive + " -o " + run.string() + " --no-report --no-hash")
                .status,
            0);
  std::ifstream poses(run / "trajectory.tum");
  std::string line;
  std::size_t count = 0;
  double farthest_m = 0;
  while (std::getline(poses, line)) {
    double stamp = 0;
    double x = 0;
    double y = 0;
    double z = 0;
    if (std::sscanf(line.c_str(), "%lf %lf %lf %lf", &stamp, &x, &y, &z) != 4) continue;
    farthest_m = std::max(farthest_m, std::hypot(x, y, z));
    ++count;
  }
  EXPECT_EQ(count, 600U);
  EXPECT_LE(farthest_m, 0.015);
}

}  // namespace
}  // namespace traverse
