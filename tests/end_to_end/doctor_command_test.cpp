#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/text_file.hpp"
#include "traverse/plausibility/diagnosis.hpp"

#include "end_to_end/program.hpp"
#include "temporary_folder.hpp"

/// `traverse doctor`: what is wrong, for which command, and what to do.
namespace traverse {
namespace {

namespace fs = std::filesystem;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::ProgramResult;
using testing::run_program;
using testing::TemporaryFolder;

class Doctor : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return "'" + (folder_ / name).string() + "'"; }
  TemporaryFolder folder_;
};

/// Scans of a few points as text, whose field of times is called so and counts so.
void make_scans(const fs::path& folder, const std::string& field, double step) {
  fs::create_directories(folder);
  for (int i = 0; i < 3; ++i) {
    std::string text = "VERSION 0.7\nFIELDS x y z ring " + field +
                       "\nSIZE 4 4 4 2 8\nTYPE F F F U F\nCOUNT 1 1 1 1 1\nWIDTH 4\nHEIGHT 1\n"
                       "POINTS 4\nDATA ascii\n";
    for (int k = 0; k < 4; ++k) {
      text += std::to_string(3 + k) + " 2 1 " + std::to_string(k) + " " + std::to_string(step * k) +
              "\n";
    }
    files::write_text(folder / (std::to_string(i) + ".pcd"), text);
  }
}

TEST_F(Doctor, NamesWhatIsNotARecordingAndFails) {
  EXPECT_THAT(run_program("doctor " + path("none")).output, HasSubstr("fails  not_found: "));
  EXPECT_EQ(run_program("doctor " + path("none")).status, 1);
  files::write_text(folder_ / "town.laz",
                    "LASF" + std::string(100, '\0') + "\x83" + std::string(200, '\0'));
  const ProgramResult laz = run_program("doctor " + path("town.laz"));
  EXPECT_EQ(laz.status, 1);
  EXPECT_THAT(laz.output, ContainsRegex("fails  foreign_laz: .*LAZ.*Next: pdal translate"));
  files::write_text(folder_ / "notes", "anything");
  EXPECT_THAT(run_program("doctor " + path("notes")).output,
              ContainsRegex("fails  not_a_recording: .*Next: .*traverse info --formats"));
  // A folder of recordings, beside what no reader knows.
  std::filesystem::create_directories(folder_ / "drives");
  files::write_text(folder_ / "drives" / "a.zip", std::string("PK\x03\x04") + "...");
  files::write_text(folder_ / "drives" / "b.rawlog", "anything");
  EXPECT_THAT(
      run_program("doctor " + path("drives")).output,
      ContainsRegex("fails  not_a_recording: .*drives: .*Next: open one of them: .*b.rawlog"));
  make_scans(folder_ / "scans", "t", 0.03);
  const ProgramResult stated = run_program(
      "doctor " + path("scans") + " --recording lidar.time_unit=ms --recording lidar.time_field=s");
  EXPECT_EQ(stated.status, 1);
  EXPECT_THAT(stated.output, ContainsRegex("fails  cannot_open: .*lidar.time_field"));
}

TEST_F(Doctor, TellsWhatMakesResultsWorse) {
  make_scans(folder_ / "scans", "t", 300);  // in no unit a sweep
  const ProgramResult result = run_program("doctor " + path("scans") + " --json " + path("a.json"));
  EXPECT_THAT(result.output, ContainsRegex("worse  deskew_off: .*run.*Next: .*lidar.time_field"));
  EXPECT_THAT(result.output, HasSubstr("note   no_reference: "));
  const auto written = nlohmann::json::parse(files::read_text(folder_ / "a.json"));
  EXPECT_EQ(written["findings"][0]["code"], "run_lost");
  EXPECT_EQ(written["findings"][1]["code"], "deskew_off");
  make_scans(folder_ / "scans", "t", 30);
  EXPECT_THAT(run_program("doctor " + path("scans")).output, Not(HasSubstr("deskew_off")));
}

TEST_F(Doctor, FailsWhereARunOfAllOfItIsLost) {
  make_scans(folder_ / "scans", "t", 0.03);  // of four points
  EXPECT_EQ(run_program("run " + path("scans") + " --no-report -o " + path("run")).status, 1);
  const ProgramResult result = run_program("doctor " + path("scans"));
  EXPECT_EQ(result.status, 1) << result.everything();
  EXPECT_THAT(result.output, ContainsRegex("fails  run_lost: a run of it is lost: .*run-folder"));
}

TEST_F(Doctor, APipelineThatNeedsALidarFailsWithoutOne) {
  files::write_text(folder_ / "log.txt",
                    "IMU 1 0 0 0 0 0 9.8\nIMU 1.01 0 0 0 0 0 9.8\nGNSS 1 48 11 500 0 0\n");
  const ProgramResult lidar = run_program("doctor " + path("log.txt"));
  EXPECT_EQ(lidar.status, 1);
  EXPECT_THAT(lidar.output, ContainsRegex("fails  no_pipeline: .*lidar.*Next: .*gins-window"));
  EXPECT_THAT(run_program("doctor " + path("log.txt") + " --pipeline gins-window").output,
              Not(HasSubstr("no_pipeline")));
}

TEST_F(Doctor, LooksFurtherWhereTheVehicleStandsAtFirst) {
  // It stands for 65 scans, more than are looked at of one that drives, and then goes round a
  // corner.
  const ProgramResult made = run_program(
      "simulate corridor_loop --duration 14 --set route.standstill_s=6.5 --set route.speed_mps=4 "
      "--set route.acceleration_mps2=2 --set route.lateral_mps2=2 --set route.laps=1 "
      "--set 'route.waypoints_m=[0, 0, 9, 0, 9, 9, 0, 9]' -o " +
      path("a.rawlog"));
  ASSERT_EQ(made.status, 0) << made.messages;
  EXPECT_THAT(run_program("doctor " + path("a.rawlog")).output, HasSubstr("nothing found"));
  const ProgramResult worse =
      run_program("doctor " + path("a.rawlog") + " --recording imu.angular_rate=deg");
  EXPECT_EQ(worse.status, 0) << worse.everything();
  EXPECT_THAT(worse.output, ContainsRegex("worse  gyro_small: imu: .*the lidar's odometry.*Next: "
                                          ".*imu.angular_rate=rad"));
}

TEST(DoctorCodes, AllStandInTheDocumentation) {
  const std::string text = files::read_text(fs::path(TRAVERSE_SOURCE_DIR) / "docs/recordings.md");
  for (const auto& [code, means] : plausibility::list_diagnoses()) {
    EXPECT_THAT(text, HasSubstr("| `" + std::string(code) + "` | " + std::string(means) + " |"));
  }
}

TEST_F(Doctor, LeavesTheRecordingAsItIsAndExplainsItself) {
  make_scans(folder_ / "scans", "t", 0.03);
  static_cast<void>(run_program("doctor " + path("scans")));
  std::size_t files = 0;
  for (const auto& entry : fs::directory_iterator(folder_ / "scans"))
    files += entry.is_regular_file();
  EXPECT_EQ(files, 3U);
  EXPECT_THAT(run_program("doctor --help").output, HasSubstr("Examples:"));
}

}  // namespace
}  // namespace traverse
