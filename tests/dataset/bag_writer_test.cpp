#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>
#include <limits>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/bags/message_container.hpp"
#include "traverse/dataset/recording_writer.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/files/text_file.hpp"

#include "dataset/made_recordings.hpp"
#include "geometry/random_motion.hpp"
#include "temporary_folder.hpp"

namespace traverse::dataset {
namespace {

namespace fs = std::filesystem;
using sensors::GnssFix;
using sensors::ImuSample;
using sensors::LidarScan;
using sensors::Measurement;
using sensors::PlanarScan;
using sensors::SensorKind;
using sensors::WheelOdometry;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Key;
using ::testing::Not;
using ::testing::Pair;
using namespace traverse::testing;  // made recordings

constexpr std::int64_t kEpoch_ns = 1'700'000'000'000'000'000;

/// Everything that Traverse knows of measurements, each in each of its forms.
struct Everything {
  RecordingInfo info;
  std::vector<Measurement> measurements;

  Everything() {
    RandomMotion random(7);
    info.name = "everything";
    info.rig.body_frame = "vehicle";
    sensors::LidarProfile profile;
    profile.rings = 4;
    profile.intensity_full_scale = 255;
    info.rig.sensors.push_back({"top lidar", SensorKind::kLidar, random.pose(1, 2), profile});
    for (const auto& [label, kind] :
         {std::pair("imu", SensorKind::kImu), std::pair("GNSS", SensorKind::kGnss),
          std::pair("laser 2", SensorKind::kPlanarLaser)}) {
      const geometry::Pose3 T_body_sensor = random.pose(1, 2);
      info.rig.sensors.push_back({label, kind, T_body_sensor, std::nullopt});
    }
    info.rig.sensors.push_back({"encoders", SensorKind::kWheels, geometry::Pose3::identity(),
                                std::nullopt, sensors::WheelEncoder{0.002, 0.0021}});
    for (int i = 0; i < 3; ++i) {
      const std::int64_t ns = kEpoch_ns + 100'000'000LL * i + 1'234'500;
      add_scan(ns, i);
      add_laser(ns + 1'000'000, i);
      for (int k = 0; k < 5; ++k) add_imu(ns + 2'000'000 + 10'000'000LL * k, k);
      add_fix(ns + 3'000'000, i);
      add_wheels(ns + 4'000'000, i);
    }
  }

  void add_scan(std::int64_t ns, int number) {
    LidarScan scan = made_scan(4, 50, number);
    scan.stamp = {ns};
    scan.sensor = "top lidar";
    for (std::size_t i = 0; i < scan.size(); ++i) {
      scan.ring.push_back(static_cast<std::uint16_t>(i / 50));
      const auto ticks = static_cast<double>(i % 50) * 20'000;
      scan.time.push_back(static_cast<float>(ticks * 1e-7));
    }
    scan.intensity.resize(scan.size());
    for (std::size_t i = 0; i < scan.size(); ++i) scan.intensity[i] = static_cast<float>(i % 256);
    scan.x[3] = std::nanf("");
    scan.x[4] = scan.y[4] = scan.z[4] = 0;
    scan.z[5] = -0.0F;
    measurements.emplace_back(std::make_shared<const LidarScan>(scan));
  }

  void add_laser(std::int64_t ns, int number) {
    PlanarScan scan;
    scan.stamp = {ns};
    scan.sensor = "laser 2";
    scan.max_range_m = 30.0F;
    const double aperture = 1.7F;
    scan.ranges_m = {1.1F, std::nanf(""), 3, 4, 5, 6.25F, 7.0F + static_cast<float>(number)};
    scan.first_azimuth = -aperture / 2;
    scan.azimuth_step = aperture / 6;
    measurements.emplace_back(std::make_shared<const PlanarScan>(scan));
  }

  void add_imu(std::int64_t ns, int number) {
    ImuSample sample;
    sample.stamp = {ns};
    sample.sensor = "imu";
    sample.angular_rate = {0.1 * number, 1.0 / 3, -0.2};
    sample.specific_force = {std::sqrt(2.0), -0.0, 9.81};
    measurements.emplace_back(sample);
  }

  void add_fix(std::int64_t ns, int number) {
    GnssFix fix;
    fix.stamp = {ns};
    fix.sensor = "GNSS";
    fix.latitude_deg = 48.1 + 1e-6 / 3 * number;
    fix.longitude_deg = -11.1;
    fix.altitude_m = number == 2 ? std::nan("") : 500.1;
    if (number > 0) fix.heading_deg = 359.0 / (1 + number);
    if (number < 2) {
      const double sigma = 0.021F;
      fix.covariance_enu = Eigen::Vector3d(sigma * sigma, 0.25, 4).asDiagonal();
    }
    measurements.emplace_back(fix);
  }

  void add_wheels(std::int64_t ns, int number) {
    WheelOdometry odometry;
    odometry.stamp = {ns};
    odometry.sensor = "encoders";
    odometry.T_odom_body = geometry::exp_se3(
        (geometry::Twist() << 0, 0, 0.3 * number, 1.0 / 3 * number, 0.5, 0).finished());
    if (number > 0) odometry.ticks = {1000LL * number, -7LL * number};
    if (number < 2) odometry.velocity = {1.5 / 7, -0.1, 0.2 * number};
    measurements.emplace_back(odometry);
  }
};

template <typename Number>
bool same_bits(const std::vector<Number>& a, const std::vector<Number>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Number)) == 0;
}
bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

void expect_same(const LidarScan& a, const LidarScan& b) {
  EXPECT_TRUE(same_bits(a.x, b.x));
  EXPECT_TRUE(same_bits(a.y, b.y));
  EXPECT_TRUE(same_bits(a.z, b.z));
  EXPECT_TRUE(same_bits(a.intensity, b.intensity));
  EXPECT_TRUE(same_bits(a.ring, b.ring));
  EXPECT_TRUE(same_bits(a.time, b.time));
}

void expect_same(const PlanarScan& a, const PlanarScan& b) {
  EXPECT_TRUE(same_bits(a.first_azimuth, b.first_azimuth));
  EXPECT_TRUE(same_bits(a.azimuth_step, b.azimuth_step));
  EXPECT_TRUE(same_bits(a.max_range_m, b.max_range_m));
  ASSERT_EQ(a.ranges_m.size(), b.ranges_m.size());
  for (std::size_t i = 0; i < a.ranges_m.size(); ++i) {
    EXPECT_EQ(std::isnan(a.ranges_m[i]), std::isnan(b.ranges_m[i]));
    if (!std::isnan(a.ranges_m[i])) {
      EXPECT_EQ(a.ranges_m[i], b.ranges_m[i]);
    }
  }
}

void expect_same(const ImuSample& a, const ImuSample& b) {
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_TRUE(same_bits(a.angular_rate[axis], b.angular_rate[axis]));
    EXPECT_TRUE(same_bits(a.specific_force[axis], b.specific_force[axis]));
  }
}

void expect_same(const GnssFix& a, const GnssFix& b) {
  EXPECT_TRUE(same_bits(a.latitude_deg, b.latitude_deg));
  EXPECT_TRUE(same_bits(a.longitude_deg, b.longitude_deg));
  EXPECT_EQ(std::isnan(a.altitude_m), std::isnan(b.altitude_m));
  if (!std::isnan(a.altitude_m)) {
    EXPECT_TRUE(same_bits(a.altitude_m, b.altitude_m));
  }
  EXPECT_EQ(a.heading_deg, b.heading_deg);
  EXPECT_EQ(a.covariance_enu, b.covariance_enu);
}

void expect_same(const WheelOdometry& a, const WheelOdometry& b) {
  ASSERT_EQ(a.T_odom_body.has_value(), b.T_odom_body.has_value());
  if (a.T_odom_body) {
    EXPECT_EQ(a.T_odom_body->translation, b.T_odom_body->translation);
    // What a quaternion rounds, and is told.
    EXPECT_LT((a.T_odom_body->rotation - b.T_odom_body->rotation).cwiseAbs().maxCoeff(), 1e-15);
  }
  ASSERT_EQ(a.ticks.has_value(), b.ticks.has_value());
  if (a.ticks) {
    EXPECT_EQ(a.ticks->left, b.ticks->left);
    EXPECT_EQ(a.ticks->right, b.ticks->right);
  }
  ASSERT_EQ(a.velocity.has_value(), b.velocity.has_value());
  if (a.velocity) {
    EXPECT_TRUE(same_bits(a.velocity->forward_mps, b.velocity->forward_mps));
    EXPECT_TRUE(same_bits(a.velocity->left_mps, b.velocity->left_mps));
    EXPECT_TRUE(same_bits(a.velocity->yaw_rate, b.velocity->yaw_rate));
  }
}

/// Of each measurement its stamp, its kind and every bit of what it holds.
void expect_same_measurements(Source& original, Source& copy) {
  original.rewind();
  copy.rewind();
  const auto expected = read_all(original);
  const auto found = read_all(copy);
  EXPECT_THAT(skipped_in(copy), IsEmpty());
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    SCOPED_TRACE(i);
    ASSERT_EQ(found[i].index(), expected[i].index());
    EXPECT_EQ(stamp_of(found[i]), stamp_of(expected[i]));
    const auto& other = found[i];
    std::visit(
        [&](const auto& held) {
          using Held = std::decay_t<decltype(held)>;
          if constexpr (std::is_same_v<Held, std::shared_ptr<const LidarScan>> ||
                        std::is_same_v<Held, std::shared_ptr<const PlanarScan>>) {
            expect_same(*held, *std::get<Held>(other));
          } else {
            expect_same(held, std::get<Held>(other));
          }
        },
        expected[i]);
  }
  for (const sensors::MountedSensor& sensor : original.info().rig.sensors) {
    const auto* same = copy.info().rig.first(sensor.kind);
    ASSERT_NE(same, nullptr) << sensor.label;
    EXPECT_LT((same->T_body_sensor.matrix() - sensor.T_body_sensor.matrix()).norm(), 1e-12)
        << sensor.label;
  }
}

void copy_all(Source& source, RecordingWriter& writer) {
  source.rewind();
  while (const auto measurement = source.next()) writer.add(*measurement);
  writer.commit();
}

std::map<std::string, std::size_t> to_bag(Source& source, const fs::path& file,
                                          BagPacking packing) {
  const BagFormat format = file.extension() == ".bag" ? BagFormat::kRos1 : BagFormat::kMcap;
  const auto writer = write_bag(file, source.info(), source.reference(), {format, packing});
  copy_all(source, *writer);
  return writer->left_out();
}

std::unique_ptr<Source> everything_as_rawlog(const fs::path& file) {
  const Everything everything;
  const auto writer = write_rawlog(file, everything.info, std::nullopt, {});
  for (const Measurement& measurement : everything.measurements) writer->add(measurement);
  writer->commit();
  EXPECT_THAT(writer->left_out(), IsEmpty());
  return open(file);
}

TEST(BagWriter, RawlogToBagToMcapToRawlogKeepsEveryBit) {
  const TemporaryFolder folder;
  const auto rawlog = everything_as_rawlog(folder / "a.rawlog");
  const auto first = read_all(*rawlog);
  EXPECT_EQ(first.size(), Everything().measurements.size());
  for (const auto packing : {BagPacking::kNone, BagPacking::kLz4}) {
    SCOPED_TRACE(static_cast<int>(packing));
    const std::string name = packing == BagPacking::kNone ? "plain" : "packed";
    const fs::path bag = folder / (name + "_ros1.bag");
    EXPECT_THAT(to_bag(*rawlog, bag, packing), Not(Contains(Key(HasSubstr("time")))));
    const auto from_bag = open(bag);
    expect_same_measurements(*rawlog, *from_bag);

    const fs::path mcap = folder / (name + "_ros2.mcap");
    to_bag(*from_bag, mcap, packing == BagPacking::kNone ? BagPacking::kZstd : packing);
    const auto from_mcap = open(mcap);
    expect_same_measurements(*rawlog, *from_mcap);

    const fs::path again = folder / (name + ".rawlog");
    const auto writer = write_rawlog(again, from_mcap->info(), from_mcap->reference(), {});
    copy_all(*from_mcap, *writer);
    EXPECT_THAT(writer->left_out(), IsEmpty());
    expect_same_measurements(*rawlog, *open(again));
    EXPECT_EQ(open(again)->info().rig.first(SensorKind::kWheels)->encoder->right_m_per_pulse,
              0.0021);
    for (const fs::path& file : {bag, mcap, again}) {
      EXPECT_EQ(open(file)->info().name, "everything");
      EXPECT_EQ(open(file)->info().rig.body_frame, "vehicle");
    }
  }
}

TEST(BagWriter, ARawlogHoldsDeviationsAndHeadingsAndSaysWhatItRounds) {
  const TemporaryFolder folder;
  Everything everything;
  const auto writer = write_rawlog(folder / "a.rawlog", everything.info, std::nullopt, {});
  GnssFix fix;
  fix.sensor = "GNSS";
  fix.latitude_deg = 48;
  fix.longitude_deg = 11;
  fix.altitude_m = 500;
  fix.heading_deg = 123.456789012345;
  fix.covariance_enu = Eigen::Vector3d(0.1, 0.25, 4).asDiagonal();
  (*fix.covariance_enu)(0, 1) = (*fix.covariance_enu)(1, 0) = 0.01;
  fix.stamp = {kEpoch_ns + 150};
  writer->add(fix);
  LidarScan scan = made_scan(1, 2);
  scan.sensor = "top lidar";
  scan.stamp = {kEpoch_ns};
  scan.intensity = {1.5F, 300};
  scan.time = {0, 1.5e-8F};
  writer->add(std::make_shared<const LidarScan>(scan));
  WheelOdometry odometry;
  odometry.sensor = "encoders";
  odometry.stamp = {kEpoch_ns + 200};
  odometry.ticks = {1LL << 40, 0};
  odometry.T_odom_body =
      geometry::Pose3::from_quaternion(Eigen::Quaterniond::Identity(), {1, 2, 3});
  writer->add(odometry);
  writer->commit();
  EXPECT_THAT(writer->left_out(),
              ::testing::ElementsAre(Pair("correlations of fixes", 1),
                                     Pair("counts of pulses beyond 32 bits", 1),
                                     Pair("digits of fixes' deviations beyond those of a float", 1),
                                     Pair("heights and tilts of wheel odometry", 1),
                                     Pair("intensities brought to 0 to 255, by scan", 1),
                                     Pair("nanoseconds of stamps below 100", 1),
                                     Pair("point times finer than 100 ns, by scan", 1)));
  const auto all = read_all(*open(folder / "a.rawlog"));
  for (const Measurement& measurement : all) {
    const auto* found = std::get_if<GnssFix>(&measurement);
    if (found == nullptr) continue;
    EXPECT_EQ(found->heading_deg, 123.456789012345);
    ASSERT_TRUE(found->covariance_enu);
    EXPECT_NEAR((*found->covariance_enu)(0, 0), 0.1, 1e-8);
    EXPECT_EQ((*found->covariance_enu)(1, 1), 0.25);
    EXPECT_EQ((*found->covariance_enu)(2, 2), 4);
    EXPECT_EQ((*found->covariance_enu)(0, 1), 0);
  }
}

TEST(BagWriter, WhatABagCannotHoldIsCounted) {
  const TemporaryFolder folder;
  const Everything everything;
  const auto writer = write_bag(folder / "a.mcap", everything.info, std::nullopt, {});
  ImuSample before;
  before.sensor = "imu";
  before.stamp = {-5};
  writer->add(before);
  PlanarScan laser;
  laser.sensor = "laser 2";
  laser.stamp = {kEpoch_ns};
  laser.first_azimuth = 0.1;
  laser.azimuth_step = 0.3;
  laser.max_range_m = 5;
  laser.ranges_m = {1, 6};
  writer->add(std::make_shared<const PlanarScan>(laser));
  WheelOdometry pulses;
  pulses.sensor = "encoders";
  pulses.stamp = {kEpoch_ns + 10};
  pulses.ticks = {1LL << 40, -3};
  writer->add(pulses);
  writer->commit();
  EXPECT_THAT(writer->left_out(),
              ::testing::ElementsAre(
                  Pair("2-D scans with ranges beyond their sensor's", 1),
                  Pair("digits of 2-D scans' angles beyond those of a float, by scan", 1),
                  Pair("records before 1970, which times of ROS cannot tell", 1)));
  const auto all = read_all(*open(folder / "a.mcap"));
  ASSERT_EQ(all.size(), 2U);
  const auto& wheels = std::get<WheelOdometry>(all[1]);
  EXPECT_FALSE(wheels.T_odom_body);
  EXPECT_FALSE(wheels.velocity);
  EXPECT_EQ(wheels.ticks->left, 1LL << 40);
  EXPECT_THROW(write_bag(folder / "b.bag", everything.info, std::nullopt,
                         {BagFormat::kRos1, BagPacking::kZstd}),
               std::invalid_argument);
}

TEST(BagWriter, TopicsHaveNamesThatRosAllows) {
  const TemporaryFolder folder;
  Everything everything;
  const sensors::MountedSensor lidar = everything.info.rig.sensors[0];
  everything.info.rig.sensors.push_back(
      {"top_lidar", lidar.kind, lidar.T_body_sensor, lidar.lidar});
  everything.info.rig.sensors.push_back({"2nd", lidar.kind, lidar.T_body_sensor, lidar.lidar});
  const auto writer = write_bag(folder / "a.bag", everything.info, std::nullopt,
                                {BagFormat::kRos1, BagPacking::kNone});
  LidarScan scan = made_scan(1, 2);
  scan.stamp = {kEpoch_ns};
  for (const char* label : {"top lidar", "top_lidar", "2nd"}) {
    scan.sensor = label;
    writer->add(std::make_shared<const LidarScan>(scan));
  }
  writer->commit();
  std::vector<std::string> topics;
  const auto bag = bags::open_ros1_bag(folder / "a.bag");
  for (const auto& channel : bag->contents().channels) topics.push_back(channel.topic);
  EXPECT_THAT(topics, ::testing::UnorderedElementsAre("/tf_static", "/top_lidar", "/top_lidar_2",
                                                      "/sensor_2nd"));
}

/// What a program prints, a line a message.
std::vector<std::string> lines_of(const std::string& command, const fs::path& folder) {
  const fs::path out = folder / "out";
  const int status = std::system((command + " > " + out.string() + " 2>&1").c_str());
  const std::string text = files::read_text(out);
  EXPECT_EQ(status, 0) << command << "\n" << text;
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    if (!line.starts_with("#")) lines.push_back(line);
  }
  return lines;
}

/// The same of a container as our own reader has it.
std::vector<std::string> lines_of(bags::MessageContainer& container, bool with_bytes) {
  std::vector<std::size_t> all;
  const auto& channels = container.contents().channels;
  for (std::size_t i = 0; i < channels.size(); ++i) all.push_back(i);
  container.begin(all);
  std::vector<std::string> lines;
  while (const auto message = container.next()) {
    const auto& channel = channels[message->channel];
    lines.push_back(channel.topic + " " + channel.type + " " +
                    std::to_string(message->log_time_ns) + " " +
                    std::to_string(with_bytes ? static_cast<std::int64_t>(message->bytes.size())
                                              : message->log_time_ns));
  }
  return lines;
}

constexpr const char* kPython = "/usr/bin/python3";  // Debian's, which has Debian's rosbag

bool succeeds(const std::string& command) {
  return std::system((command + " > /dev/null 2>&1").c_str()) == 0;
}

TEST(BagWriter, RosbagOfDebianReadsTheSameMessages) {
  if (!succeeds(std::string(kPython) + " -c 'import rosbag'")) {
    GTEST_SKIP() << "python3-rosbag is not installed; `scripts/dependencies test` installs it";
  }
  const TemporaryFolder folder;
  const auto rawlog = everything_as_rawlog(folder / "a.rawlog");
  const fs::path plain = folder / "plain.bag";
  const fs::path packed = folder / "packed.bag";
  to_bag(*rawlog, plain, BagPacking::kNone);
  to_bag(*rawlog, packed, BagPacking::kLz4);
  // A message is logged at its stamp.
  std::vector<std::string> expected = lines_of(*bags::open_ros1_bag(plain), false);
  EXPECT_GT(expected.size(), Everything().measurements.size());
  const auto as_much_again = lines_of(*bags::open_ros1_bag(packed), false);
  expected.insert(expected.end(), as_much_again.begin(), as_much_again.end());
  EXPECT_THAT(lines_of(std::string(kPython) + " " + TRAVERSE_TEST_READERS + "/list_ros1_bag.py " +
                           plain.string() + " " + packed.string(),
                       folder.path()),
              ::testing::UnorderedElementsAreArray(expected));
}

TEST(BagWriter, ReadersOfFoxgloveReadTheSameMessages) {
  const std::string readers = TRAVERSE_TEST_READERS;
  if (!succeeds("node --version") || !fs::exists(fs::path(readers) / "node_modules")) {
    GTEST_SKIP() << "node with @mcap/core and @foxglove/rosbag is not there; `scripts/dependencies "
                    "test` installs them where npm is";
  }
  const TemporaryFolder folder;
  const auto rawlog = everything_as_rawlog(folder / "a.rawlog");
  to_bag(*rawlog, folder / "b.bag", BagPacking::kNone);
  to_bag(*rawlog, folder / "c.mcap", BagPacking::kNone);
  EXPECT_THAT(
      lines_of("node " + readers + "/list_ros1_bag.mjs " + (folder / "b.bag").string(),
               folder.path()),
      ::testing::UnorderedElementsAreArray(lines_of(*bags::open_ros1_bag(folder / "b.bag"), true)));
  EXPECT_THAT(
      lines_of("node " + readers + "/list_mcap.mjs " + (folder / "c.mcap").string(), folder.path()),
      ::testing::UnorderedElementsAreArray(lines_of(*bags::open_mcap(folder / "c.mcap"), true)));
}

}  // namespace
}  // namespace traverse::dataset
