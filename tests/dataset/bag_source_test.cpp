#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/dataset/open_recording.hpp"
#include "traverse/files/input_error.hpp"

#include "bags/bag_writers.hpp"
#include "dataset/bag_of_recording.hpp"
#include "dataset/made_recordings.hpp"
#include "dataset/rawlog_maker.hpp"
#include "temporary_folder.hpp"

namespace traverse::dataset {
namespace {

namespace fs = std::filesystem;
using namespace traverse::testing;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr std::int64_t kStart = 1'700'000'000'000'000'000;
constexpr std::int64_t kTenth = 100'000'000;

sensors::LidarScan small_scan(std::int64_t ns, std::size_t points = 40) {
  sensors::LidarScan scan;
  scan.stamp = geometry::Stamp{ns};
  for (std::size_t i = 0; i < points; ++i) {
    const auto k = static_cast<float>(i);
    scan.x.push_back(5 + k);
    scan.y.push_back(-k + static_cast<float>(ns / kTenth % 7));
    scan.z.push_back(0.5F * k);
    scan.intensity.push_back(3 * k);
    scan.ring.push_back(static_cast<std::uint16_t>(i % 4));
    scan.time.push_back(0.1F * k / static_cast<float>(points));
  }
  return scan;
}

MadeMessage scan_message(const std::string& topic, std::int64_t ns, const std::string& frame,
                         Wire wire) {
  return {topic, "sensor_msgs/PointCloud2", ns + kTenth,
          message_of_scan(small_scan(ns), frame, wire)};
}

MadeMessage imu_at(const std::string& topic, std::int64_t ns, const std::string& frame, Wire wire) {
  return {topic, "sensor_msgs/Imu", ns, imu_message(wire, ns, frame, {0.1, 0.2, 0.3}, {1, 2, 9.8})};
}

/// Ten scans, an IMU at ten times their rate, fixes, and what else a bag has.
std::vector<MadeMessage> vehicle(Wire wire) {
  std::vector<MadeMessage> messages;
  messages.push_back({"/tf_static", "tf2_msgs/TFMessage", kStart,
                      transforms_message(wire, kStart,
                                         {{"base_link", "mast", {0, 0, 1}},
                                          {"mast", "lidar", {0.5, 0, 1}, {0, 0, 1, 0}},
                                          {"base_link", "imu", {0.1, 0.2, 0.3}}})});
  for (int i = 0; i < 10; ++i) {
    const std::int64_t ns = kStart + i * kTenth;
    messages.push_back(scan_message("/points", ns, "lidar", wire));
    messages.push_back(scan_message("/registered", ns, "map", wire));
    messages.push_back({"/fix", "sensor_msgs/NavSatFix", ns,
                        fix_message(wire, ns, "antenna", i == 0 ? -1 : 0, 50 + 1e-6 * i, 8, 120)});
    messages.push_back(
        {"/odom", "nav_msgs/Odometry", ns,
         odometry_message(wire, ns, "odom", "base_link", {0.1 * i, 0, 0}, {0, 0, 0, 1}, 1, 0)});
    messages.push_back({"/thing", "my_msgs/Thing", ns, "abc"});
    for (int k = 0; k < 10; ++k) {
      messages.push_back(imu_at("/imu", ns + k * kTenth / 10, "/imu", wire));
    }
  }
  std::stable_sort(messages.begin(), messages.end(),
                   [](const auto& a, const auto& b) { return a.log_time_ns < b.log_time_ns; });
  return messages;
}

const TopicInfo& topic_in(const Source& source, const std::string& name) {
  for (const TopicInfo& topic : source.info().topics) {
    if (topic.topic == name) return topic;
  }
  throw std::invalid_argument("no topic " + name);
}

TEST(BagSource, TakesOneTopicOfEachKindAndTellsWhy) {
  const TemporaryFolder folder;
  write_ros1_bag(folder / "a.bag", vehicle(Wire::kRos1));
  const auto source = open(folder / "a.bag");
  EXPECT_EQ(fact_value(*source, "lidar"), "/points");
  EXPECT_THAT(fact_reason(*source, "lidar"), HasSubstr("of 2: frame 'lidar', with point times"));
  EXPECT_EQ(fact_value(*source, "IMU"), "/imu");
  EXPECT_EQ(fact_value(*source, "GNSS"), "/fix");
  EXPECT_EQ(source->info().topics.size(), 7U);
  EXPECT_EQ(topic_in(*source, "/points").use, "lidar");
  EXPECT_EQ(topic_in(*source, "/points").count, 10U);
  EXPECT_NEAR(topic_in(*source, "/imu").rate_hz, 90, 10);
  EXPECT_THAT(topic_in(*source, "/registered").why, HasSubstr("lidar.topic=/registered takes it"));
  EXPECT_THAT(topic_in(*source, "/odom").why, HasSubstr("wheels.topic=/odom takes it"));
  EXPECT_EQ(topic_in(*source, "/thing").why, "no type that is used");
  EXPECT_EQ(source->info().expected_scans, 10U);
}

TEST(BagSource, GivesTheMeasurementsOfTheMessages) {
  const TemporaryFolder folder;
  for (const Wire wire : {Wire::kRos1, Wire::kCdr, Wire::kCdrBigEndian}) {
    const fs::path file = folder / (wire == Wire::kRos1 ? "a.bag" : "a.mcap");
    if (wire == Wire::kRos1) {
      write_ros1_bag(file, vehicle(wire));
    } else {
      write_mcap(file, vehicle(wire), {}, wire);
    }
    const auto source = open(file);
    const auto measurements = read_all(*source);
    const auto scans = scans_in(measurements);
    ASSERT_EQ(scans.size(), 10U);
    EXPECT_EQ(scans[3]->stamp.nanoseconds, kStart + 3 * kTenth) << "the header's, not the log's";
    const sensors::LidarScan expected = small_scan(kStart + 3 * kTenth);
    EXPECT_EQ(scans[3]->x, expected.x);
    EXPECT_EQ(scans[3]->y, expected.y);
    EXPECT_EQ(scans[3]->ring, expected.ring);
    EXPECT_EQ(scans[3]->intensity, expected.intensity);
    ASSERT_EQ(scans[3]->time.size(), expected.time.size());
    EXPECT_NEAR(scans[3]->time[20], expected.time[20], 1e-6);
    EXPECT_EQ(measurements.size(), 10U + 100U + 9U);
    EXPECT_THAT(skipped_in(*source), ElementsAre("1 x GNSS record without a fix"));
    for (const auto& measurement : measurements) {
      if (const auto* imu = std::get_if<sensors::ImuSample>(&measurement)) {
        EXPECT_EQ(imu->specific_force, Eigen::Vector3d(1, 2, 9.8));
        EXPECT_EQ(imu->angular_rate, Eigen::Vector3d(0.1, 0.2, 0.3));
      }
      if (const auto* fix = std::get_if<sensors::GnssFix>(&measurement)) {
        EXPECT_NEAR(fix->latitude_deg, 50, 1e-4);
        ASSERT_TRUE(fix->covariance_enu);
        EXPECT_EQ((*fix->covariance_enu)(2, 2), 9);
      }
    }
  }
}

TEST(BagSource, MountsSensorsAsTheTransformsSay) {
  const TemporaryFolder folder;
  write_ros1_bag(folder / "a.bag", vehicle(Wire::kRos1));
  const auto source = open(folder / "a.bag");
  EXPECT_EQ(source->info().rig.body_frame, "base_link");
  const auto* lidar = source->info().rig.find("/points");
  EXPECT_TRUE(lidar->T_body_sensor.translation.isApprox(Eigen::Vector3d(0.5, 0, 2)));
  EXPECT_TRUE(
      (lidar->T_body_sensor * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(-0.5, 0, 2)));
  EXPECT_TRUE(source->info().rig.find("/imu")->T_body_sensor.translation.isApprox(
      Eigen::Vector3d(0.1, 0.2, 0.3)));
  EXPECT_THAT(fact_value(*source, "mounting of /fix"), HasSubstr("vehicle.gnss.position_m"));
  EXPECT_THAT(fact_reason(*source, "mounting of /fix"),
              HasSubstr("no transform links 'antenna' to 'base_link'"));
  const auto in_imu = open(folder / "a.bag", {"body_frame=imu"});
  EXPECT_TRUE(in_imu->info().rig.find("/points")->T_body_sensor.translation.isApprox(
      Eigen::Vector3d(0.4, -0.2, 1.7)));
}

TEST(BagSource, MovingTransformsLinkOnlyWhileTheyStayTheSame) {
  const TemporaryFolder folder;
  for (const bool moves : {false, true}) {
    std::vector<MadeMessage> messages;
    for (int i = 0; i < 5; ++i) {
      const std::int64_t ns = kStart + i * kTenth;
      messages.push_back(
          {"/tf", "tf2_msgs/TFMessage", ns,
           transforms_message(Wire::kRos1, ns,
                              {{"base_link", "lidar", {1, 0, moves ? 0.01 * i : 0}}})});
      messages.push_back(scan_message("/points", ns, "lidar", Wire::kRos1));
    }
    write_ros1_bag(folder / "a.bag", messages);
    const auto source = open(folder / "a.bag");
    EXPECT_EQ(source->info().rig.body_frame, moves ? "lidar" : "base_link");
    EXPECT_EQ(source->info().rig.find("/points")->T_body_sensor.translation.x(), moves ? 0 : 1);
  }
}

TEST(BagSource, StatementsOverruleTheChoice) {
  const TemporaryFolder folder;
  write_ros1_bag(folder / "a.bag", vehicle(Wire::kRos1));
  const auto source = open(folder / "a.bag", {"lidar.topic=/registered", "imu.topic=none",
                                              "wheels.topic=/odom", "reference.topic=/odom"});
  EXPECT_EQ(fact_value(*source, "lidar"), "/registered");
  EXPECT_EQ(fact_value(*source, "IMU"), "none");
  EXPECT_EQ(source->info().rig.first(sensors::SensorKind::kImu), nullptr);
  ASSERT_NE(source->info().rig.first(sensors::SensorKind::kWheels), nullptr);
  ASSERT_TRUE(source->reference());
  EXPECT_EQ(source->reference()->T_map_body.size(), 10U);
  EXPECT_NEAR(source->reference()->T_map_body.path_length(), 0.9, 1e-9);
  EXPECT_THAT(opening_error(folder / "a.bag", {"lidar.topic=/pointz"}),
              HasSubstr("a topic of /points, /registered for 'lidar.topic', found '/pointz'"));
  EXPECT_THAT(opening_error(folder / "a.bag", {"imu.topic=/points"}), HasSubstr("/imu"));
}

TEST(BagSource, StampsOfZeroAreReplacedByLogTimesAndTold) {
  const TemporaryFolder folder;
  std::vector<MadeMessage> messages;
  for (int i = 0; i < 5; ++i) {
    auto message = scan_message("/points", 0, "lidar", Wire::kRos1);
    message.log_time_ns = kStart + i * kTenth;
    messages.push_back(message);
  }
  write_ros1_bag(folder / "a.bag", messages);
  const auto source = open(folder / "a.bag");
  EXPECT_EQ(fact_value(*source, "stamps of /points"), "log times");
  const auto scans = read_scans(*source);
  ASSERT_EQ(scans.size(), 5U);
  EXPECT_EQ(scans[2]->stamp.nanoseconds, kStart + 2 * kTenth);
}

TEST(BagSource, OrganisedCloudsWithRoomBetweenRowsAndBigNumbersAreRead) {
  const TemporaryFolder folder;
  CloudMessage cloud;
  cloud.height = 2;
  cloud.width = 3;
  cloud.point_step = 32;
  cloud.row_step = 3 * 32 + 16;
  cloud.is_bigendian = true;
  cloud.fields = {{"z", 16, 8}, {"x", 0, 8}, {"y", 8, 8}, {"t", 24, 6}};
  cloud.data.assign(2 * cloud.row_step, '\xee');
  const auto put = [&](std::size_t at, auto value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    std::reverse(raw, raw + sizeof value);
    cloud.data.replace(at, sizeof value, raw, sizeof value);
  };
  for (std::size_t row = 0; row < 2; ++row) {
    for (std::size_t column = 0; column < 3; ++column) {
      const std::size_t at = row * cloud.row_step + column * 32;
      put(at, 10.0 * static_cast<double>(row) + static_cast<double>(column));
      put(at + 8, 1.0);
      put(at + 16, -2.0);
      put(at + 24, static_cast<std::uint32_t>(30'000'000 * column));  // nanoseconds
    }
  }
  std::vector<MadeMessage> messages;
  for (int i = 0; i < 5; ++i) {
    const std::int64_t ns = kStart + i * kTenth;
    messages.push_back(
        {"/points", "sensor_msgs/PointCloud2", ns, cloud_message(Wire::kCdr, ns, "lidar", cloud)});
  }
  write_ros2_bag(folder / "bag", messages, {});
  const auto scans = read_scans(*open(folder / "bag"));
  ASSERT_EQ(scans.size(), 5U);
  EXPECT_THAT(scans[0]->x, ElementsAre(0, 1, 2, 10, 11, 12));
  EXPECT_THAT(scans[0]->z, ElementsAre(-2, -2, -2, -2, -2, -2));
  ASSERT_EQ(scans[0]->time.size(), 6U);
  EXPECT_NEAR(scans[0]->time[5], 0.06, 1e-6);
}

TEST(BagSource, MessagesThatLieAboutThemselvesCostOnlyThemselves) {
  const TemporaryFolder folder;
  auto messages = vehicle(Wire::kRos1);
  int damaged = 0;
  for (auto& message : messages) {
    if (message.topic == "/points" && message.log_time_ns > kStart + 6 * kTenth && damaged < 2) {
      if (damaged++ == 0) {
        message.bytes.resize(message.bytes.size() / 2);
      } else {
        message.bytes[28] = '\x7f';  // rows, of which there are not so many
      }
    }
  }
  write_ros1_bag(folder / "a.bag", messages);
  const auto source = open(folder / "a.bag");
  EXPECT_EQ(read_scans(*source).size(), 8U);
  EXPECT_EQ(source->skipped().total(), 3U);
}

/// Scans and, between them, joints whose angles grow as they are told.
void write_bag_with_joints(const fs::path& file, Wire wire,
                           const std::vector<std::vector<std::string>>& publishers,
                           bool has_positions = true) {
  std::vector<MadeMessage> messages;
  for (int i = 0; i < 5; ++i) {
    const std::int64_t ns = kStart + i * kTenth;
    messages.push_back(scan_message("/points", ns, "lidar", wire));
    for (std::size_t k = 0; k < publishers.size(); ++k) {
      std::vector<JointOf> joints;
      for (const std::string& name : publishers[k]) {
        joints.push_back({name, 0.5 * i + 10.0 * static_cast<double>(joints.size())});
      }
      const std::int64_t at = ns + static_cast<std::int64_t>(k + 1) * 1'000'000;
      messages.push_back({"/joint_states", "sensor_msgs/JointState", at,
                          joints_message(wire, at, joints, has_positions)});
    }
  }
  if (wire == Wire::kRos1) {
    write_ros1_bag(file, messages);
  } else {
    write_mcap(file, messages, {}, wire);
  }
}

std::vector<sensors::WheelOdometry::Ticks> ticks_in(Source& source) {
  std::vector<sensors::WheelOdometry::Ticks> ticks;
  for (const auto& measurement : read_all(source)) {
    if (const auto* wheels = std::get_if<sensors::WheelOdometry>(&measurement)) {
      ticks.push_back(wheels->ticks.value());
    }
  }
  return ticks;
}

TEST(BagSource, JointsThatAreWheelsArePulses) {
  const TemporaryFolder folder;
  for (const Wire wire : {Wire::kRos1, Wire::kCdr, Wire::kCdrBigEndian}) {
    const fs::path file = folder / (wire == Wire::kRos1 ? "a.bag" : "a.mcap");
    // An arm's joints come in messages of their own, before the wheels'.
    write_bag_with_joints(file, wire,
                          {{"elbow", "wrist"}, {"wheel_left_joint", "wheel_right_joint"}});
    const auto source = open(file, {"wheels.radius_m=0.2"});
    EXPECT_EQ(fact_value(*source, "wheels"), "/joint_states");
    const auto* wheels = source->info().rig.first(sensors::SensorKind::kWheels);
    ASSERT_NE(wheels, nullptr);
    ASSERT_TRUE(wheels->encoder);
    EXPECT_DOUBLE_EQ(wheels->encoder->left_m_per_pulse, 0.2 / 10'000);
    const auto ticks = ticks_in(*source);
    ASSERT_EQ(ticks.size(), 5U);
    EXPECT_EQ(ticks[2].left, 10'000);
    EXPECT_EQ(ticks[2].right, 110'000);
    EXPECT_THAT(skipped_in(*source), ElementsAre("5 x joints without one that is a wheel"));
  }
}

TEST(BagSource, WheelsAmongJointsAreToldByTheirNamesOrStated) {
  struct Case {
    std::vector<std::string> joints;
    std::vector<std::string> statements;
    std::string told;  ///< of the fact, or empty: the reason why none is taken
  };
  const std::vector<Case> cases{
      {{"left_wheel", "right_wheel"}, {}, "left_wheel (left) and right_wheel (right)"},
      {{"WheelR", "arm_left", "WheelL"}, {}, "WheelL (left) and WheelR (right)"},
      {{"drivewhl_l_joint", "drivewhl_r_joint"},
       {},
       "drivewhl_l_joint (left) and drivewhl_r_joint (right)"},
      {{"front_left_wheel", "front_right_wheel", "rear_left_wheel", "rear_right_wheel"},
       {},
       "rear_left_wheel (left) and rear_right_wheel (right)"},
      {{"wheel_fl", "wheel_fr", "wheel_rl", "wheel_rr"},
       {},
       "wheel_rl (left) and wheel_rr (right)"},
      {{"left_wheel_steering", "right_wheel_steering", "wheel_left", "wheel_right"},
       {},
       "wheel_left (left) and wheel_right (right)"},
      {{"j1", "j2"}, {"wheels.left_joint=j2", "wheels.right_joint=j1"}, "j2 (left) and j1 (right)"},
      {{"j1", "j2"}, {}, ""},
      {{"wheel_1_left", "wheel_2_left", "wheel_1_right", "wheel_2_right"}, {}, ""},
      {{"elbow_left", "elbow_right"}, {}, ""},
      {{"left_wheel", "right_wheel"}, {"wheels.left_joint=none_such"}, ""},
  };
  const TemporaryFolder folder;
  for (const Case& one : cases) {
    write_bag_with_joints(folder / "a.bag", Wire::kRos1, {one.joints});
    const auto source = open(folder / "a.bag", one.statements);
    if (one.told.empty()) {
      EXPECT_EQ(source->info().rig.first(sensors::SensorKind::kWheels), nullptr);
      EXPECT_THAT(
          topic_in(*source, "/joint_states").why,
          HasSubstr("no left and right wheel can be told among its joints (" + one.joints.front()));
    } else {
      EXPECT_THAT(fact_value(*source, "pulses of /joint_states"), HasSubstr(one.told));
      EXPECT_THAT(fact_reason(*source, "pulses of /joint_states"), HasSubstr("wheels.radius_m"));
    }
  }
  write_bag_with_joints(folder / "a.bag", Wire::kRos1, {{"left_wheel", "right_wheel"}}, false);
  EXPECT_EQ(topic_in(*open(folder / "a.bag"), "/joint_states").why,
            "joints without the angle of a wheel");
}

TEST(BagSource, TypesThatSomebodyMayExpectAreListedWithTheReason) {
  const TemporaryFolder folder;
  std::vector<MadeMessage> messages = vehicle(Wire::kRos1);
  for (const char* type :
       {"sensor_msgs/MultiEchoLaserScan", "point_cloud_interfaces/CompressedPointCloud2"}) {
    messages.push_back({std::string("/of/") + type, type, kStart, "abc"});
  }
  write_ros1_bag(folder / "a.bag", messages);
  const auto source = open(folder / "a.bag");
  EXPECT_THAT(topic_in(*source, "/of/sensor_msgs/MultiEchoLaserScan").why,
              HasSubstr("a laser that scans one plane"));
  EXPECT_THAT(topic_in(*source, "/of/point_cloud_interfaces/CompressedPointCloud2").why,
              HasSubstr("makes PointCloud2"));
}

TEST(BagSource, GoesBackToABookmark) {
  const TemporaryFolder folder;
  write_ros1_bag(folder / "a.bag", vehicle(Wire::kRos1), {"lz4", 7, true, true, true});
  write_ros2_bag(folder / "b", vehicle(Wire::kCdr), {3, true, true, false, true});
  for (const char* name : {"a.bag", "b"}) {
    const auto source = open(folder / name);
    for (int i = 0; i < 41; ++i) source->next();
    const auto here = source->bookmark();
    ASSERT_NE(here, nullptr);
    const auto rest = read_all(*source);
    source->return_to(*here);
    const auto again = read_all(*source);
    ASSERT_EQ(again.size(), rest.size());
    for (std::size_t i = 0; i < rest.size(); ++i) {
      EXPECT_EQ(stamp_of(again[i]), stamp_of(rest[i]));
      EXPECT_EQ(sensor_of(again[i]), sensor_of(rest[i]));
    }
  }
}

TEST(BagSource, FilesOfAFolderAreOneRecordingAndMissingOnesAreTold) {
  const TemporaryFolder folder;
  write_ros2_bag(folder / "bag", vehicle(Wire::kCdr), {3, false, false, true, true});
  EXPECT_EQ(read_scans(*open(folder / "bag")).size(), 10U);
  fs::remove(folder / "bag/bag_1.db3");
  const auto source = open(folder / "bag");
  EXPECT_EQ(fact_value(*source, "file left out"), "bag_1.db3");
  EXPECT_LT(read_scans(*source).size(), 10U);
}

TEST(BagSource, FilesThatArePackedAsAWholeAreRefusedWithTheWayToUnpackThem) {
  const TemporaryFolder folder;
  fs::create_directories(folder / "bag");
  std::ofstream(folder / "bag/bag_0.db3.zstd") << packed_by("zstd", "anything");
  EXPECT_THAT(opening_error(folder / "bag"), HasSubstr("`zstd -d "));
}

TEST(BagSource, EveryKindOfBagGivesTheScansOfTheRawlogItWasMadeOf) {
  const TemporaryFolder folder;
  {
    RawlogMaker maker(folder / "a.rawlog");
    for (int i = 0; i < 20; ++i) {
      maker.add(made_velodyne(0.1 * i, 300));
      for (int k = 0; k < 5; ++k) maker.add(made_imu(0.1 * i + 0.02 * k));
    }
  }
  const auto rawlog = open(folder / "a.rawlog");
  const auto expected = read_scans(*rawlog);
  for (const BagKind& kind : bag_kinds()) {
    SCOPED_TRACE(kind.name);
    const auto source = open(write_bag(kind, folder.path(), *rawlog));
    const auto measurements = read_all(*source);
    EXPECT_EQ(measurements.size(), 120U);
    const auto scans = scans_in(measurements);
    ASSERT_EQ(scans.size(), expected.size());
    for (std::size_t i = 0; i < scans.size(); ++i) {
      EXPECT_EQ(scans[i]->stamp, expected[i]->stamp);
      EXPECT_EQ(scans[i]->x, expected[i]->x);
      EXPECT_EQ(scans[i]->ring, expected[i]->ring);
    }
    EXPECT_TRUE(source->info()
                    .rig.first(sensors::SensorKind::kLidar)
                    ->T_body_sensor.translation.isApprox(Eigen::Vector3d(1, 0, 2)));
  }
}

/// Five scans of each of two lidars, 20 ms apart, that look ahead and behind.
std::vector<MadeMessage> two_lidars(Wire wire) {
  std::vector<MadeMessage> messages;
  messages.push_back({"/tf_static", "tf2_msgs/TFMessage", kStart,
                      transforms_message(wire, kStart,
                                         {{"base_link", "ahead", {2, 0, 0}},
                                          {"base_link", "behind", {-2, 0, 0}, {0, 0, 1, 0}}})});
  for (int i = 0; i < 5; ++i) {
    const std::int64_t ns = kStart + i * kTenth;
    messages.push_back(scan_message("/front/points", ns, "ahead", wire));
    messages.push_back(scan_message("/rear/points", ns + kTenth / 5, "behind", wire));
  }
  return messages;
}

TEST(BagSource, SeveralLidarsAreUsedAsOneWhereStated) {
  const TemporaryFolder folder;
  write_ros1_bag(folder / "a.bag", two_lidars(Wire::kRos1));
  write_mcap(folder / "a.mcap", two_lidars(Wire::kCdr));
  const std::string both = "lidars=/front/points,/rear/points";
  for (const fs::path& file : {folder / "a.bag", folder / "a.mcap"}) {
    const auto source = open(file, {both});
    const auto* lidar = source->info().rig.find("/front/points + /rear/points");
    ASSERT_NE(lidar, nullptr);
    EXPECT_EQ(lidar->lidar->rings, 8);
    EXPECT_EQ(lidar->T_body_sensor.translation, Eigen::Vector3d(2, 0, 0));
    EXPECT_EQ(topic_in(*source, "/front/points").use, "lidar");
    EXPECT_EQ(topic_in(*source, "/rear/points").use, "lidar");
    EXPECT_EQ(fact_value(*source, "/rear/points: rings"), fact_value(*source, "rings"));
    std::size_t points = 0;
    float farthest_behind = 0;
    const auto measurements = read_all(*source);
    for (const auto& scan : scans_in(measurements)) {
      points += scan->size();
      farthest_behind =
          std::min(farthest_behind, *std::min_element(scan->x.begin(), scan->x.end()));
    }
    EXPECT_EQ(points, 2U * 5U * 40U);
    EXPECT_FLOAT_EQ(farthest_behind,
                    -44 - 4);  // 44 m ahead of the one behind, 4 m behind the first

    source->rewind();
    static_cast<void>(source->next());
    const auto here = source->bookmark();
    ASSERT_TRUE(here);
    const auto second = source->next();
    static_cast<void>(source->next());
    source->return_to(*here);
    EXPECT_EQ(stamp_of(*source->next()), stamp_of(*second));
  }
  EXPECT_THAT(topic_in(*open(folder / "a.bag"), "/front/points").why,
              HasSubstr("'lidars=/rear/points,/front/points' takes both as one"));
  EXPECT_THAT(opening_error(folder / "a.bag", {"lidars=/front/points,/top"}),
              HasSubstr("different topics of /front/points, /rear/points"));
  EXPECT_THAT(opening_error(folder / "a.bag", {"lidars=/front/points,/front/points"}),
              HasSubstr("'/front/points'"));
  EXPECT_EQ(read_scans(*open(folder / "a.bag", {"lidars=/rear/points"})).size(), 5U);
}

}  // namespace
}  // namespace traverse::dataset
