#include <cstring>
#include <fstream>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/files/atomic_file.hpp"

#include "dataset/made_recordings.hpp"
#include "temporary_folder.hpp"

namespace traverse::dataset {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using namespace traverse::testing;  // made recordings
using sensors::GnssFix;
using sensors::ImuSample;

/// A log of these lines, read with statements.
class StatedLog {
 public:
  StatedLog(const std::string& lines, std::vector<std::string> statements) {
    files::write_text(folder_ / "log.txt", lines);
    source_ = open(folder_ / "log.txt", std::move(statements));
    all_ = read_all(*source_);
  }
  const Source& source() const { return *source_; }
  template <typename Reading>
  std::vector<Reading> all() const {
    std::vector<Reading> readings;
    for (const auto& measurement : all_) {
      if (const auto* reading = std::get_if<Reading>(&measurement)) readings.push_back(*reading);
    }
    return readings;
  }

 private:
  TemporaryFolder folder_;
  std::unique_ptr<Source> source_;
  std::vector<sensors::Measurement> all_;
};

constexpr const char* kImuLines = "IMU 1.00 2 0 -4 0 0.5 1\nIMU 1.01 2 0 -4 0 0.5 1\n";

TEST(MeasurementStatements, ForcesInG) {
  const StatedLog log(kImuLines, {"imu.unit=g"});
  EXPECT_TRUE(log.all<ImuSample>().at(0).specific_force.isApprox(
      Eigen::Vector3d(0, 0.5 * 9.80665, 9.80665)));
  EXPECT_EQ(fact_value(log.source(), "specific force"), "g");
  const StatedLog thousandths(kImuLines, {"imu.unit=mg"});
  EXPECT_NEAR(thousandths.all<ImuSample>().at(0).specific_force.z(), 0.00980665, 1e-12);
}

TEST(MeasurementStatements, RatesInDegreesHoweverTheyAreStated) {
  for (const char* statement : {"imu.angular_rate=deg", "log.angular_rate=deg"}) {
    const StatedLog log(kImuLines, {statement});
    EXPECT_NEAR(log.all<ImuSample>().at(0).angular_rate.x(), std::numbers::pi / 90, 1e-12);
  }
}

TEST(MeasurementStatements, IncrementsAreDividedByTheirInterval) {
  const StatedLog log(kImuLines, {"imu.unit=increment", "imu.angular_rate=increment"});
  ASSERT_EQ(log.all<ImuSample>().size(), 1U);  // before the first there is none
  EXPECT_NEAR(log.all<ImuSample>()[0].specific_force.z(), 100, 1e-9);
  EXPECT_NEAR(log.all<ImuSample>()[0].angular_rate.z(), -400, 1e-9);
  EXPECT_THAT(skipped_in(log.source()), ElementsAre(HasSubstr("increments")));
}

TEST(MeasurementStatements, PlacesInAnyOrderAndUnit) {
  const auto place = [](const char* line, std::vector<std::string> statements) {
    const StatedLog log(line, std::move(statements));
    const GnssFix fix = log.all<GnssFix>().at(0);
    return std::pair(fix.latitude_deg, fix.longitude_deg);
  };
  EXPECT_EQ(place("GNSS 1 116.4 39.9 50 0 0\n", {"gnss.order=longitude_latitude"}),
            std::pair(39.9, 116.4));
  const auto radians = place("GNSS 1 0.8 0.2 50 0 0\n", {"gnss.unit=rad"});
  EXPECT_NEAR(radians.first, 45.8366, 1e-4);
  EXPECT_NEAR(radians.second, 11.4592, 1e-4);
  // 48 degrees 30.6 minutes south, 116 degrees 15 minutes west, as NMEA writes it and in
  // hundredths.
  for (const char* line : {"GNSS 1 -4830.6 -11615 50 0 0\n", "GNSS 1 -48.306 -116.15 50 0 0\n"}) {
    const auto minutes = place(line, {"gnss.unit=ddmm"});
    EXPECT_NEAR(minutes.first, -48.51, 1e-9) << line;
    EXPECT_NEAR(minutes.second, -116.25, 1e-9) << line;
  }
}

TEST(MeasurementStatements, APlaceThatIsNoneEvenSoIsSkipped) {
  const StatedLog log("GNSS 1 48 116.4 50 0 0\nIMU 1 0 0 0 0 0 9.8\n",
                      {"gnss.order=longitude_latitude"});
  EXPECT_THAT(log.all<GnssFix>(), IsEmpty());
  EXPECT_THAT(skipped_in(log.source()), ElementsAre(HasSubstr("no such place")));
}

TEST(MeasurementStatements, ZerosBeforeTheFirstFixAreSkipped) {
  const StatedLog log("GNSS 1 0 0 0 0 0\nGNSS 2 0.0 0.0 12 90 1\nGNSS 3 48 11 50 0 0\n", {});
  ASSERT_EQ(log.all<GnssFix>().size(), 1U);
  EXPECT_THAT(skipped_in(log.source()), ElementsAre(HasSubstr("2 x fix at latitude 0")));
}

TEST(MeasurementStatements, HeadingsOfAnySenseAndUnit) {
  const auto heading = [](std::vector<std::string> statements) {
    const StatedLog log("GNSS 1 48 11 50 1.5 1\n", std::move(statements));
    return *log.all<GnssFix>().at(0).heading_deg;
  };
  EXPECT_NEAR(heading({}), 1.5, 1e-12);
  EXPECT_NEAR(heading({"gnss.heading=from_east"}), 88.5, 1e-12);
  EXPECT_NEAR(heading({"gnss.heading=counterclockwise"}), -1.5, 1e-12);
  EXPECT_NEAR(heading({"gnss.heading_unit=rad"}), 85.9437, 1e-4);
  EXPECT_NEAR(heading({"gnss.heading_unit=rad", "gnss.heading=from_east"}), 4.0563, 1e-4);
}

TEST(MeasurementStatements, ADelayIsTakenOffAndTheOrderKept) {
  const StatedLog log("IMU 1 0 0 0 0 0 9.8\nIMU 2 0 0 0 0 0 9.8\nGNSS 2.5 48 11 50 0 0\n",
                      {"gnss.delay_s=1"});
  EXPECT_EQ(log.all<GnssFix>().at(0).stamp.nanoseconds, 1'500'000'000);
  EXPECT_THAT(skipped_in(log.source()), IsEmpty());
}

TEST(MeasurementStatements, AcceptedContradictionsAreWords) {
  const StatedLog log(kImuLines, {"accept=imu_in_g gnss_late"});
  EXPECT_THAT(log.source().info().accepted_contradictions, ElementsAre("imu_in_g", "gnss_late"));
}

TEST(BinLayout, ColumnsAndTypesThatAreStated) {
  const TemporaryFolder folder;
  const auto write = [&](auto number, int columns) {
    using Number = decltype(number);
    std::vector<Number> numbers;
    for (int i = 0; i < 2 * columns; ++i) numbers.push_back(static_cast<Number>(i));
    std::string bytes(numbers.size() * sizeof(Number), '\0');
    std::memcpy(bytes.data(), numbers.data(), bytes.size());
    std::filesystem::create_directories(folder / "drive/velodyne");
    files::write_text(folder / "drive/velodyne/000000.bin", bytes);
  };
  write(float{}, 5);
  const auto five = open(folder / "drive", {"bin.columns=5"});
  const auto scan = read_scans(*five).at(0);
  EXPECT_THAT(scan->x, ElementsAre(0, 5));
  EXPECT_THAT(scan->intensity, ElementsAre(3, 8));
  write(double{}, 3);
  const auto doubles = open(folder / "drive", {"bin.columns=3", "bin.type=float64"});
  EXPECT_THAT(read_scans(*doubles).at(0)->z, ElementsAre(2, 5));
  EXPECT_THAT(read_scans(*doubles), IsEmpty());
}

}  // namespace
}  // namespace traverse::dataset
