#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "traverse/dataset/trajectory_files.hpp"
#include "traverse/files/atomic_file.hpp"
#include "traverse/files/numbers.hpp"
#include "traverse/files/text_file.hpp"

#include "end_to_end/program.hpp"
#include "temporary_folder.hpp"

namespace traverse {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::ProgramResult;
using testing::run_program;
using testing::TemporaryFolder;

/// Half a second of the corridor: the world that is built quickest.
const std::string kCorridor = "simulate corridor_loop --first 30 --duration 0.5 ";

TEST(SimulateCommand, ListsWorldsAndSensors) {
  const ProgramResult result = run_program("simulate --list");
  EXPECT_EQ(result.status, 0) << result.messages;
  for (const char* name : {"town_loop", "town_large", "terrace_loop", "highway", "tunnel", "park",
                           "corridor_loop", "hdl64e", "vlp16", "os1_64", "os1_128"}) {
    EXPECT_THAT(result.output, HasSubstr(name));
  }
}

TEST(SimulateCommand, WritesARawlogWithAllSensorsThatIsRecognisedWithoutOptions) {
  const TemporaryFolder folder;
  const std::string rawlog = (folder / "c.rawlog").string();
  const ProgramResult result = run_program(kCorridor + "--set gnss.mounted=true -o " + rawlog);
  ASSERT_EQ(result.status, 0) << result.messages;
  for (const char* beside : {"c.traverse.yaml", "c.reference.tum", "c.rig.yaml", "c.world.yaml"}) {
    EXPECT_TRUE(fs::is_regular_file(folder / beside)) << beside;
  }
  const ProgramResult info = run_program("info " + rawlog);
  EXPECT_EQ(info.status, 0) << info.messages;
  EXPECT_THAT(info.output,
              AllOf(HasSubstr("VLP-16"), HasSubstr("IMU"), HasSubstr("wheels"),
                    HasSubstr("16 expected"), HasSubstr("it covers 100.0 % of the scans")));
  const auto truth =
      dataset::read_trajectory(folder / "c.reference.tum", dataset::TrajectoryFormat::kTum);
  EXPECT_EQ(truth.size(), 50U) << "one for each reading of the IMU";
}

TEST(SimulateCommand, MrptsOwnToolOpensTheRawlog) {
  if (std::system("command -v rawlog-edit > /dev/null") != 0) {
    GTEST_SKIP() << "rawlog-edit is not installed";
  }
  const TemporaryFolder folder;
  const std::string rawlog = (folder / "c.rawlog").string();
  ASSERT_EQ(run_program(kCorridor + "--gzip 1 -o " + rawlog).status, 0);
  const std::string out = (folder / "out.txt").string();
  ASSERT_EQ(std::system(("rawlog-edit --info -i " + rawlog + " > " + out + " 2>&1").c_str()), 0);
  EXPECT_THAT(files::read_text(out), AllOf(HasSubstr("Open OK"), HasSubstr("imu, lidar, wheels"),
                                           HasSubstr("lidar /      5")));
}

TEST(SimulateCommand, TheSameSeedGivesTheSameBytesForAnyNumberOfThreads) {
  const TemporaryFolder folder;
  const auto bytes = [&](const std::string& name, const std::string& options) {
    const std::string rawlog = (folder / name).string();
    EXPECT_EQ(run_program(kCorridor + options + " -o " + rawlog).status, 0);
    return files::read_text(rawlog);
  };
  const std::string one = bytes("a.rawlog", "--threads 1");
  EXPECT_EQ(one, bytes("b.rawlog", "--threads 3"));
  EXPECT_NE(one, bytes("c.rawlog", "--seed 2"));
  EXPECT_EQ(one, bytes("d.rawlog", "--drive-seed 17")) << "17 is the world's seed";
  EXPECT_NE(one, bytes("e.rawlog", "--drive-seed 18"));
}

TEST(SimulateCommand, WhatItWroteOfTheWorldSimulatesTheSameAgain) {
  const TemporaryFolder folder;
  const std::string first = (folder / "a.rawlog").string();
  const std::string again = (folder / "b.rawlog").string();
  ASSERT_EQ(run_program(kCorridor + "--seed 5 --set route.speed_mps=1 -o " + first).status, 0);
  const ProgramResult result = run_program("simulate " + (folder / "a.world.yaml").string() +
                                           " --first 30 --duration 0.5 -o " + again);
  ASSERT_EQ(result.status, 0) << result.messages;
  EXPECT_EQ(files::read_text(first), files::read_text(again));
}

TEST(SimulateCommand, AKittiFolderIsReadAndEstimatedAsOne) {
  const TemporaryFolder folder;
  const std::string sequence = (folder / "sequence").string();
  const ProgramResult result =
      run_program("simulate town_short --first 80 --duration 1 --format kitti -o " + sequence);
  ASSERT_EQ(result.status, 0) << result.messages;
  EXPECT_TRUE(fs::is_regular_file(folder / "sequence/velodyne/000009.bin"));
  for (const char* name : {"calib.txt", "poses.txt", "times.txt", "gnss.csv", "rig.yaml"}) {
    EXPECT_TRUE(fs::is_regular_file(folder / "sequence" / name)) << name;
  }
  EXPECT_THAT(run_program("info " + sequence).output,
              AllOf(HasSubstr("KITTI odometry"), HasSubstr("64 / 64 / 64")));
  const ProgramResult run = run_program("run " + sequence + " -o " + (folder / "run").string() +
                                        " --no-report --no-hash");
  ASSERT_EQ(run.status, 0) << run.messages;
  const json evaluation = json::parse(files::read_text(folder / "run/evaluation.json"));
  EXPECT_LT(evaluation["ape"]["translation"]["rmse"], 0.1);
}

/// The columns of frames.csv by name.
std::vector<double> column(const fs::path& csv, const std::string& name) {
  files::LineReader lines(csv);
  lines.next();
  const auto names = files::split_cells(lines.line(), ',');
  std::size_t index = 0;
  while (index < names.size() && names[index] != name) ++index;
  std::vector<double> values;
  while (lines.next()) {
    values.push_back(*files::parse_double(files::split_cells(lines.line(), ',').at(index)));
  }
  return values;
}

TEST(SimulateCommand, TheTunnelIsReportedDegenerateAlongItsAxis) {
  const TemporaryFolder folder;
  const std::string rawlog = (folder / "t.rawlog").string();
  ASSERT_EQ(run_program("simulate tunnel --first 200 --duration 1 -o " + rawlog).status, 0);
  ASSERT_EQ(run_program("run " + rawlog + " -o " + (folder / "run").string() +
                        " --pipeline floam --no-report --no-hash")
                .status,
            1)
      << "nothing tells how far it went";
  const fs::path frames = folder / "run/frames.csv";
  const auto degenerate = column(frames, "degenerate_directions");
  const auto along = column(frames, "weakest_direction_tx");
  ASSERT_EQ(degenerate.size(), 10U);
  for (std::size_t i = 2; i < degenerate.size(); ++i) {
    EXPECT_EQ(degenerate[i], 1) << i;
    EXPECT_GT(std::abs(along[i]), 0.99) << i;
  }
}

TEST(SimulateCommand, WhatCannotBeSimulatedIsToldWithFileAndLine) {
  const TemporaryFolder folder;
  const std::string out = " -o " + (folder / "x.rawlog").string();
  const auto message = [&](const std::string& arguments) {
    const ProgramResult result = run_program("simulate " + arguments + out);
    EXPECT_EQ(result.status, 1) << arguments;
    return result.messages;
  };
  EXPECT_THAT(message("moon"), AllOf(HasSubstr("town_loop"), HasSubstr("'moon'")));
  EXPECT_THAT(message("corridor_loop --sensor sonar"),
              AllOf(HasSubstr("vlp16"), HasSubstr("'sonar'")));
  EXPECT_THAT(message("corridor_loop --sensor hdl64e_kitti"),
              AllOf(HasSubstr("hdl64e_kitti.yaml"), HasSubstr("elevations_deg")));
  EXPECT_THAT(message("corridor_loop --set route.corner_radius_m=400"),
              HasSubstr("--set route.corner_radius_m=400"));
  files::write_text(folder / "bad.yaml", "name: bad\nroute:\n  waypoints_m: [1, 2, 3]\n");
  EXPECT_THAT(message((folder / "bad.yaml").string()), HasSubstr("bad.yaml, line 3"));
  EXPECT_THAT(message("corridor_loop --first 100000"), HasSubstr("has sweeps 0 to"));
  EXPECT_FALSE(fs::exists(folder / "x.rawlog"));
  EXPECT_EQ(run_program("simulate park").status, 2);
  EXPECT_EQ(run_program("simulate park -o folder --format rawlog").status, 2);
}

}  // namespace
}  // namespace traverse
