#include <algorithm>
#include <fstream>
#include <numbers>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "traverse/dataset/open_recording.hpp"
#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"

#include "temporary_folder.hpp"

namespace traverse::dataset {
namespace {

std::unique_ptr<Source> opened(const std::filesystem::path& path,
                               std::vector<std::string> statements = {}) {
  OpenOptions options;
  options.statements = std::move(statements);
  options.share_folder = TRAVERSE_SHARE_DIR;
  return open_recording(path, options);
}

std::vector<sensors::Measurement> all_of(Source& source) {
  std::vector<sensors::Measurement> all;
  while (auto measurement = source.next()) all.push_back(std::move(*measurement));
  return all;
}

constexpr const char* kGood =
    "# a log\n"
    "IMU 1.0 90 0 -180 0.1 0.2 9.8\n"
    "ODOM 1.1 3 4\n"
    "GNSS 1.2 48.1 11.5 520 30 1\n"
    "GNSS 1.4 48.1 11.5 520 30 0\n"
    "ODOM 1.3 -1 2\n";

TEST(NavigationLog, IsReadInTheOrderOfItsStamps) {
  const testing::TemporaryFolder folder;
  files::write_text(folder.path() / "drive.txt", kGood);
  const auto source = opened(folder.path() / "drive.txt", {"log.angular_rate=deg"});
  const auto all = all_of(*source);
  ASSERT_EQ(all.size(), 5U);
  EXPECT_TRUE(source->skipped().empty());
  EXPECT_NEAR(std::get<sensors::ImuSample>(all[0]).angular_rate.x(), std::numbers::pi / 2, 1e-12);
  EXPECT_EQ(std::get<sensors::GnssFix>(all[2]).heading_deg, 30);
  const auto& wheels = std::get<sensors::WheelOdometry>(all[3]);
  EXPECT_EQ(wheels.ticks->left, 2);  // pulses of the intervals, added up
  EXPECT_EQ(wheels.ticks->right, 6);
  EXPECT_FALSE(std::get<sensors::GnssFix>(all[4]).heading_deg.has_value());
}

TEST(NavigationLog, CumulativePulsesStayAsTheyAre) {
  const testing::TemporaryFolder folder;
  files::write_text(folder.path() / "drive.txt", kGood);
  const auto source = opened(folder.path() / "drive.txt", {"log.pulses=cumulative"});
  EXPECT_EQ(std::get<sensors::WheelOdometry>(all_of(*source)[3]).ticks->left, -1);
}

TEST(NavigationLog, NamesEachBadLine) {
  const testing::TemporaryFolder folder;
  files::write_text(folder.path() / "drive.txt",
                    "IMU 1 0 0 0 0 0 9.8\n"      // 1
                    "IMU 2 0 0 0 0 0\n"          // 2: truncated
                    "IMU 3 0 0 x 0 0 9.8\n"      // 3
                    "IMU 4 0 0 nan 0 0 9.8\n"    // 4
                    "IMU 0.5 0 0 0 0 0 9.8\n"    // 5: steps back
                    "LASER 6 1 2 3\n"            // 6
                    "GNSS 7 91 11 500 0 0\n"     // 7
                    "GNSS 8 48 11 500 0 2\n"     // 8
                    "ODOM 9 1e30 0\n"            // 9
                    "IMU 1e300 0 0 0 0 0 9.8\n"  // 10
                    "IMU 11 0 0 0 0 0 9.8\n");   // 11
  const auto source = opened(folder.path() / "drive.txt");
  EXPECT_EQ(all_of(*source).size(), 2U);
  EXPECT_EQ(source->skipped().total(), 9U);
  const auto& by_reason = source->skipped().by_reason();
  const auto place = [&](const char* reason) {
    const auto found = by_reason.find(reason);
    return found == by_reason.end() ? std::string("none") : found->second.first_places.front();
  };
  EXPECT_EQ(place("IMU line with not 7 numbers"), "line 2");
  EXPECT_EQ(place("IMU line with a word that is no number"), "line 3");
  EXPECT_EQ(place("IMU line with a number that is not finite"), "line 4");
  EXPECT_EQ(place("stamp not later than the one before"), "line 5");
  EXPECT_EQ(place("a line that does not begin with IMU, ODOM or GNSS"), "line 6");
  EXPECT_EQ(place("GNSS line with no such place"), "line 7");
  EXPECT_EQ(place("GNSS line whose heading_valid is not 0 or 1"), "line 8");
  EXPECT_EQ(place("ODOM line with no such count"), "line 9");
  EXPECT_EQ(place("IMU line with no such time"), "line 10");
}

TEST(NavigationLog, WithoutAUsableLineIsAnError) {
  const testing::TemporaryFolder folder;
  files::write_text(folder.path() / "drive.txt", "IMU 1 2\nIMU 2 3\n");
  EXPECT_THROW(opened(folder.path() / "drive.txt"), files::InputError);
}

TEST(CsvFolder, TakesTheColumnsThatAreStated) {
  const testing::TemporaryFolder folder;
  files::write_text(folder.path() / "gyro.csv",
                    "t,x,y,z\n1,0.1,0.2,0.3\n1.01,0.1,bad,0.3\n1.02,0.2,0.2,0.3\n");
  files::write_text(folder.path() / "force.csv", "t,x,y,z\n0.99,0,0,9\n1.03,0,0,10\n");
  const std::vector<std::string> statements{"csv.gyro={file: gyro.csv, columns: x y z}",
                                            "csv.accelerometer={file: force.csv, columns: x y z}"};
  const auto source = opened(folder.path(), statements);
  const auto all = all_of(*source);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_NEAR(std::get<sensors::ImuSample>(all[0]).specific_force.z(), 9.25, 1e-9);
  EXPECT_EQ(source->skipped()
                .by_reason()
                .at("CSV line with a cell that is no finite number")
                .first_places.front(),
            "gyro.csv, line 3");
  EXPECT_THROW(opened(folder.path()), files::InputError);  // nothing is stated
  EXPECT_THROW(opened(folder.path(), {"csv.gyro={file: gyro.csv, columns: x y w}", statements[1]}),
               files::InputError);
}

TEST(CsvFolder, PutsReadingsBackOnTheClockOfTheirSensor) {
  const testing::TemporaryFolder folder;
  std::string lines = "t,lat,lon,alt\n";
  std::string unusable = lines;
  for (int k = 0; k < 40; ++k) {
    if (k == 20) continue;  // a fix that is missing
    const double late = 0.03 * ((k * 7) % 5 - 2) / 2;
    lines += std::to_string(100 + 0.1 * k + late) + ",48,11,500\n";
    unusable += std::to_string(100 + 0.04 * k) + ",48,11,500\n";
  }
  files::write_text(folder.path() / "gnss.csv", lines);
  files::write_text(folder.path() / "fast.csv", unusable);
  const auto gnss = [](const char* file, const char* period) {
    return std::string("csv.gnss={file: ") + file + ", columns: lat lon alt, period_s: " + period +
           "}";
  };
  const auto all = all_of(*opened(folder.path(), {gnss("gnss.csv", "0.1")}));
  ASSERT_EQ(all.size(), 39U);
  for (std::size_t k = 1; k < all.size(); ++k) {
    const double step = geometry::seconds_between(std::get<sensors::GnssFix>(all[k - 1]).stamp,
                                                  std::get<sensors::GnssFix>(all[k]).stamp);
    EXPECT_NEAR(step, k == 20 ? 0.2 : 0.1, 1e-3) << k;
  }
  // Twice as fast as stated: the stamps stay.
  const auto fast = opened(folder.path(), {gnss("fast.csv", "0.1")});
  EXPECT_NEAR(std::get<sensors::GnssFix>(all_of(*fast)[1]).stamp.seconds(), 100.04, 1e-6);
  const auto& facts = fast->info().facts;
  EXPECT_TRUE(std::any_of(facts.begin(), facts.end(), [](const Fact& fact) {
    return fact.value == "as they are: they do not keep the period";
  }));
}

TEST(VehicleStatements, PlaceTheSensors) {
  const testing::TemporaryFolder folder;
  files::write_text(folder.path() / "drive.txt", kGood);
  const auto source =
      opened(folder.path() / "drive.txt",
             {"vehicle.gnss.position_m=[1, 2, 3]", "vehicle.wheels.left_m_per_pulse=0.01",
              "vehicle.wheels.right_m_per_pulse=0.02"});
  const sensors::Rig& rig = source->info().rig;
  EXPECT_EQ(rig.find("GNSS")->T_body_sensor.translation, Eigen::Vector3d(1, 2, 3));
  ASSERT_TRUE(rig.find("ODOM")->encoder.has_value());
  EXPECT_EQ(rig.find("ODOM")->encoder->right_m_per_pulse, 0.02);
  EXPECT_THROW(opened(folder.path() / "drive.txt", {"vehicle.gnss.position_m=[1, 2]"}),
               files::InputError);
}

}  // namespace
}  // namespace traverse::dataset
