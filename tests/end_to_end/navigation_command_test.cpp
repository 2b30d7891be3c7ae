// From a text log of navigation sensors to a report, and through other formats and back.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "traverse/dataset/trajectory_files.hpp"
#include "traverse/files/atomic_file.hpp"
#include "traverse/files/text_file.hpp"
#include "traverse/geometry/stamp.hpp"

#include "end_to_end/program.hpp"
#include "inertial/simulated_vehicle.hpp"
#include "temporary_folder.hpp"
#include "test_data.hpp"

namespace traverse {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::run_program;
using testing::TemporaryFolder;

/// A drive of 40 s with two antennas as a text log with a bad line, made once.
class NavigationCommand : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder();
    testing::SimulatedSensors sensors;
    sensors.heading_sigma_deg = 0.2;
    const testing::SimulatedDrive drive = testing::simulate({}, sensors, 40);
    std::ofstream log(*folder_ / "drive.txt");
    log.precision(15);
    for (const auto& s : drive.imu) {
      log << "IMU " << geometry::to_text(s.stamp) << " " << s.angular_rate.transpose() << " "
          << s.specific_force.transpose() << "\n";
    }
    for (const auto& w : drive.wheels) {
      log << "ODOM " << geometry::to_text(w.stamp) << " " << w.ticks->left << " " << w.ticks->right
          << "\n";
    }
    for (const auto& f : drive.fixes) {
      log << "GNSS " << geometry::to_text(f.stamp) << " " << f.latitude_deg << " "
          << f.longitude_deg << " " << f.altitude_m << " " << *f.heading_deg << " 1\n";
    }
    log << "GNSS 1041 48\n";
    const double pulse = drive.mounts.encoder->left_m_per_pulse;
    const auto& antenna = drive.mounts.antenna_body;
    const auto& wheels = drive.mounts.wheels.p_body;
    files::write_text(*folder_ / "drive.traverse.yaml",
                      "log: {pulses: cumulative}\nvehicle:\n  gnss: {position_m: [" +
                          std::to_string(antenna.x()) + ", " + std::to_string(antenna.y()) + ", " +
                          std::to_string(antenna.z()) + "]}\n  wheels: {position_m: [" +
                          std::to_string(wheels.x()) + ", " + std::to_string(wheels.y()) + ", " +
                          std::to_string(wheels.z()) +
                          "], left_m_per_pulse: " + std::to_string(pulse) +
                          ", right_m_per_pulse: " + std::to_string(pulse) + "}\n");
  }
  static void TearDownTestSuite() { delete folder_; }

  static std::string file(const std::string& name) { return (*folder_ / name).string(); }
  static geometry::Trajectory path_of(const std::string& name) {
    return dataset::read_trajectory(*folder_ / name, dataset::TrajectoryFormat::kTum);
  }
  /// GNSS of centimetres, as it is simulated.
  static std::string settings() {
    return " --set gnss.horizontal_m=0.01 --set gnss.vertical_m=0.02";
  }

  static inline TemporaryFolder* folder_ = nullptr;
};

TEST_F(NavigationCommand, GoesFromATextLogToAReportAndToTheGrid) {
  const auto result = run_program("run " + file("drive.txt") + " -o " + file("run") +
                                  " --pipeline gins-window --utm --drop-gnss 5" + settings());
  ASSERT_EQ(result.status, 0) << result.messages;
  EXPECT_THAT(result.output, AllOf(HasSubstr("UTM        zone 32N"), HasSubstr("1 skipped")));
  const std::string page = files::read_text(*folder_ / "run" / "report.html");
  EXPECT_THAT(page, AllOf(HasSubstr("id=\"navigation\""), HasSubstr("id=\"table-outages\""),
                          HasSubstr("Prediction less fix")));
  const json report = json::parse(files::read_text(*folder_ / "run" / "report.json"));
  std::size_t charts = 0;
  for (const auto& chart : report["charts"]) {
    charts += chart["section"] == "navigation" ? 1 : 0;
    if (chart["id"] == "gyro-bias") {
      EXPECT_TRUE(chart["series"][0].contains("band"));
    }
  }
  EXPECT_GE(charts, 6U);

  // On the grid distances shrink by at most 0.04 %, and the heading turns by the convergence.
  const auto map = path_of("run/trajectory.tum");
  const auto grid = path_of("run/trajectory_utm.tum");
  ASSERT_EQ(map.size(), grid.size());
  const auto last = map.size() - 1;
  const double way = (map.pose(last).translation - map.pose(0).translation).head<2>().norm();
  const double on_grid = (grid.pose(last).translation - grid.pose(0).translation).head<2>().norm();
  EXPECT_NEAR(on_grid / way, 0.99985, 3e-4);
  const auto yaw = [](const geometry::Pose3& T) {
    return std::atan2(T.rotation(1, 0), T.rotation(0, 0)) * 180 / M_PI;
  };
  // tan(convergence) = tan(11.58 - 9 deg) sin(48.14 deg)
  EXPECT_NEAR(std::remainder(yaw(grid.pose(last)) - yaw(map.pose(last)), 360), 1.922, 0.01);

  // What else an INS tells.
  const auto origin = json::parse(files::read_text(*folder_ / "run" / "origin.json"));
  EXPECT_NEAR(origin["latitude_deg"].get<double>(), 48.14, 1e-3);
  const std::string places = files::read_text(*folder_ / "run" / "path.csv");
  EXPECT_EQ(std::count(places.begin(), places.end(), '\n'),
            static_cast<std::ptrdiff_t>(map.size()) + 1);
  EXPECT_THAT(places, HasSubstr("stamp_s,latitude_deg,longitude_deg,altitude_m\n"));
  EXPECT_THAT(files::read_text(*folder_ / "run" / "path.kml"), HasSubstr("11.58"));
  EXPECT_THAT(files::read_text(*folder_ / "run" / "frames.csv"),
              AllOf(HasSubstr("velocity_east_mps"), HasSubstr("sigma_roll_deg")));
  EXPECT_FALSE(report["figures"]["jump_p95_m"]["interval"].is_null());
  EXPECT_FALSE(report["figures"]["roughness_m"]["interval"].is_null());
  // Asked before the update, the inertial factor's mean is 1 where the covariances are right.
  for (const auto& row : report["tables"]["innovations"]["rows"]) {
    if (row[0] != "inertial") continue;
    EXPECT_GT(row[2].get<double>(), 0.3);
    EXPECT_LT(row[2].get<double>(), 2);
  }

  const auto shown = run_program("check-jacobians --run " + file("run") + " --frame 100");
  ASSERT_EQ(shown.status, 0) << shown.messages;
  for (const char* block : {"dR/dR1", "dv/dv1", "dp/dba1", "dR/dR2", "dp/dp2", "dv/dv2"}) {
    EXPECT_THAT(shown.output, HasSubstr(block));
  }
  EXPECT_EQ(run_program("check-jacobians --run " + file("run") + " --frame 99999").status, 1);
}

TEST_F(NavigationCommand, ConvertsToARawlogAndBack) {
  ASSERT_EQ(run_program("convert " + file("drive.txt") + " " + file("copy.rawlog")).status, 0);
  const auto back = run_program("convert " + file("copy.rawlog") + " " + file("back.txt"));
  ASSERT_EQ(back.status, 0) << back.messages;
  EXPECT_THAT(back.output, HasSubstr("back.txt: 0 scans, 4802 other records written"));
  for (const char* name : {"drive.txt", "copy.rawlog", "back.txt"}) {
    const auto result = run_program(
        "run " + file(name) + " -o " + file(std::string(name) + "_run") +
        " --no-report --pipeline gins-window" + settings() + " --set gnss.use_heading=false");
    ASSERT_EQ(result.status, 0) << name << result.messages;
  }
  const auto one = path_of("drive.txt_run/trajectory.tum");
  for (const char* other : {"copy.rawlog_run/trajectory.tum", "back.txt_run/trajectory.tum"}) {
    const auto two = path_of(other);
    ASSERT_EQ(one.size(), two.size());
    for (std::size_t k = 0; k < one.size(); ++k) {
      EXPECT_LT((one.pose(k).translation - two.pose(k).translation).norm(), 1e-3)
          << other << " " << k;
    }
  }
  // Text logs and rawlogs keep headings.
  for (const char* name : {"copy.rawlog", "back.txt"}) {
    const auto result = run_program("run " + file(name) + " -o " + file("same") +
                                    " --no-report --pipeline gins-odom" + settings());
    EXPECT_EQ(result.status, 0) << name << result.messages;
  }
}

TEST_F(NavigationCommand, SaysWhyThereIsNoGridWithoutAFix) {
  const auto result = run_program("run " + file("drive.txt") + " -o " + file("nowhere") +
                                  " --no-report --pipeline gins-window --utm --set gnss.use=false "
                                  "--set start.gnss_wait_s=1");
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.messages,
              HasSubstr("--utm: no GNSS fix gives the position of this trajectory on Earth"));
}

TEST_F(NavigationCommand, DeadReckonsARobotWithoutGnss) {
  const auto log = testing::test_data() / "wheel_imu" / "1.txt";
  if (!std::filesystem::exists(log)) GTEST_SKIP() << "wheel_imu is not there";
  const auto result =
      run_program("run " + log.string() + " -o " + file("robot") +
                  " --no-report --no-hash --pipeline gins-window --recording-config " +
                  TRAVERSE_SHARE_DIR + "/recordings/wheel_imu_log.yaml" +
                  " --set imu.accelerometer_density=0.05 --set imu.gyro_density=0.002"
                  " --set wheels.forward_mps=0.01 --set wheels.sideways_mps=0.02"
                  " --set wheels.upwards_mps=0.02 --set wheels.gate=false");
  ASSERT_EQ(result.status, 0) << result.messages;
  const auto path = path_of("robot/trajectory.tum");
  EXPECT_GT(path.size(), 1000U);
  // 13342 and 13929 pulses of 0.951 mm: the mean of both wheels.
  constexpr double kByWheels = 12.97;
  EXPECT_NEAR(path.path_length() / kByWheels, 1, 0.05);
}

}  // namespace
}  // namespace traverse
