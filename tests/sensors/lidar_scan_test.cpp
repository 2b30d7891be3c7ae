#include "traverse/sensors/lidar_scan.hpp"

#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include "traverse/sensors/measurement.hpp"

namespace traverse::sensors {
namespace {

TEST(LidarScan, CountsPointsThatAreNoReturns) {
  LidarScan scan;
  scan.x = {1, 0, std::numeric_limits<float>::quiet_NaN(), 2};
  scan.y = {0, 0, 1, std::numeric_limits<float>::infinity()};
  scan.z = {0, 0, 1, 0};
  const PointFaults faults = count_faults(scan);
  EXPECT_EQ(faults.at_origin, 1U);
  EXPECT_EQ(faults.not_finite, 2U);
}

TEST(LidarScan, ArraysMustAgree) {
  LidarScan scan;
  scan.x = scan.y = scan.z = {1, 2};
  EXPECT_NO_THROW(check_consistent(scan));
  scan.ring = {0};
  EXPECT_THROW(check_consistent(scan), std::invalid_argument);
}

TEST(Measurement, KnowsStampAndSensorOfEveryKind) {
  auto scan = std::make_shared<LidarScan>();
  scan->stamp = geometry::Stamp{5};
  scan->sensor = "velodyne";
  EXPECT_EQ(stamp_of(Measurement(std::shared_ptr<const LidarScan>(scan))).nanoseconds, 5);
  EXPECT_EQ(sensor_of(Measurement(std::shared_ptr<const LidarScan>(scan))), "velodyne");
  EXPECT_EQ(stamp_of(Measurement(ImuSample{geometry::Stamp{7}, "imu", {}, {}})).nanoseconds, 7);
}

}  // namespace
}  // namespace traverse::sensors
