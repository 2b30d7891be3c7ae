#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <variant>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/dataset/recording_writer.hpp"

#include "dataset/made_recordings.hpp"
#include "temporary_folder.hpp"

namespace traverse::dataset {
namespace {

namespace fs = std::filesystem;
using geometry::Pose3;
using sensors::LidarScan;
using sensors::SensorKind;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using namespace traverse::testing;  // made recordings

constexpr std::int64_t kStart_ns = 1'700'000'000'000'000'000;
constexpr std::int64_t kSweep_ns = 100'000'000;
constexpr std::int64_t kLag_ns = 30'000'000;  ///< the rear lidar's sweeps begin so much later
constexpr std::size_t kPoints = 100;          ///< a ring of a scan

Pose3 mounting(double yaw, const Eigen::Vector3d& t) {
  return {Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix(), t};
}
const Pose3 kFront = mounting(0.1, {2, 0, 1});
const Pose3 kRear = mounting(3.0, {-1.5, 0.2, 1.2});

/// Where the wall of the test is met from the vehicle at that time: y = 8 in the world.
LidarScan wall(const Pose3& T_body_lidar, std::int64_t begin_ns, const std::string& label) {
  LidarScan scan;
  scan.stamp = {begin_ns};
  scan.sensor = label;
  for (std::size_t i = 0; i < kPoints; ++i) {
    for (std::uint16_t ring = 0; ring < 2; ++ring) {
      const double after_s = 1e-3 * static_cast<double>(i);
      const double t = 1e-9 * static_cast<double>(begin_ns - kStart_ns) + after_s;
      const double x_world = -20 + 0.4 * static_cast<double>(i);
      const Eigen::Vector3d p_body(x_world, 8, ring);  // at the start: the vehicle goes to its left
      const Eigen::Vector3d p_lidar = T_body_lidar.inverse() * (p_body - Eigen::Vector3d(0, t, 0));
      scan.x.push_back(static_cast<float>(p_lidar.x()));
      scan.y.push_back(static_cast<float>(p_lidar.y()));
      scan.z.push_back(static_cast<float>(p_lidar.z()));
      scan.intensity.push_back(10);
      scan.ring.push_back(ring);
      scan.time.push_back(static_cast<float>(after_s));
    }
  }
  return scan;
}

struct Made {
  bool has_front = true;  ///< all the time; else only in the first and the last second of three
  int sweeps = 30;
};

void write(const fs::path& file, const Made& made) {
  RecordingInfo info;
  info.rig.body_frame = "vehicle";
  sensors::LidarProfile profile;
  profile.rings = 2;
  profile.stamp_fraction = 0;
  info.rig.sensors.push_back({"front", SensorKind::kLidar, kFront, profile});
  info.rig.sensors.push_back({"rear", SensorKind::kLidar, kRear, profile});
  info.rig.sensors.push_back({"imu", SensorKind::kImu, Pose3::identity(), std::nullopt});
  const auto writer = write_rawlog(file, info, std::nullopt, {});
  for (int i = 0; i < made.sweeps; ++i) {
    const std::int64_t ns = kStart_ns + kSweep_ns * i;
    if (made.has_front || i < 10 || i >= 20) {
      writer->add(std::make_shared<const LidarScan>(wall(kFront, ns, "front")));
    }
    sensors::ImuSample sample;
    sample.stamp = {ns + 10'000'000};
    sample.sensor = "imu";
    writer->add(sample);
    writer->add(std::make_shared<const LidarScan>(wall(kRear, ns + kLag_ns, "rear")));
  }
  writer->commit();
}

/// Of every return the distance from the wall where the vehicle was when it was measured.
double farthest_from_wall(const std::vector<ScanPtr>& scans) {
  double farthest = 0;
  for (const auto& scan : scans) {
    for (std::size_t i = 0; i < scan->size(); ++i) {
      const double t = 1e-9 * static_cast<double>(scan->stamp.nanoseconds - kStart_ns) +
                       static_cast<double>(scan->time[i]);
      const Eigen::Vector3d p = kFront * Eigen::Vector3d(scan->x[i], scan->y[i], scan->z[i]);
      farthest = std::max(farthest, std::abs(p.y() + t - 8));
    }
  }
  return farthest;
}

std::size_t points_in(const std::vector<ScanPtr>& scans) {
  std::size_t count = 0;
  for (const auto& scan : scans) count += scan->size();
  return count;
}

TEST(LidarsAsOne, EveryReturnIsWhereItWasMeasuredAndNoneTwice) {
  const TemporaryFolder folder;
  write(folder / "a.rawlog", {});
  const auto source = open(folder / "a.rawlog", {"lidars=front, rear"});
  const auto all = read_all(*source);
  const auto scans = scans_in(all);
  EXPECT_THAT(skipped_in(*source), IsEmpty());
  EXPECT_EQ(points_in(scans), 30U * 2 * 2 * kPoints);
  EXPECT_LT(farthest_from_wall(scans), 1e-5);
  ASSERT_GE(scans.size(), 30U);
  EXPECT_LE(scans.size(), 31U);  // the last of the rear one's goes on after the front one's
  for (std::size_t k = 0; k < 29; ++k) {
    EXPECT_EQ(scans[k]->stamp.nanoseconds, kStart_ns + kSweep_ns * static_cast<std::int64_t>(k));
    const auto [first, last] = std::minmax_element(scans[k]->time.begin(), scans[k]->time.end());
    EXPECT_GE(*first, 0);
    EXPECT_LT(*last, 0.1F);
    EXPECT_EQ(*std::max_element(scans[k]->ring.begin(), scans[k]->ring.end()), 3);
  }
  // The rest goes on in between, in the order of stamps.
  EXPECT_EQ(all.size() - scans.size(), 30U);
  for (std::size_t i = 1; i < all.size(); ++i) EXPECT_LE(stamp_of(all[i - 1]), stamp_of(all[i]));

  const auto& rig = source->info().rig;
  ASSERT_NE(rig.find("front + rear"), nullptr);
  EXPECT_EQ(rig.find("front + rear")->lidar->rings, 4);
  EXPECT_EQ(rig.find("rear"), nullptr);
  EXPECT_LT((rig.find("front + rear")->T_body_sensor.matrix() - kFront.matrix()).norm(), 1e-9);

  source->rewind();
  EXPECT_EQ(points_in(read_scans(*source)), 30U * 2 * 2 * kPoints);
}

TEST(LidarsAsOne, WhileTheFirstIsSilentTheOtherGoesOn) {
  const TemporaryFolder folder;
  write(folder / "a.rawlog", {false, 30});
  const auto source = open(folder / "a.rawlog", {"lidars=front,rear"});
  const auto scans = read_scans(*source);
  EXPECT_EQ(points_in(scans), 50U * 2 * kPoints);
  EXPECT_LT(farthest_from_wall(scans), 1e-5);
  for (std::size_t k = 1; k < scans.size(); ++k) {
    const double apart = seconds_between(scans[k - 1]->stamp, scans[k]->stamp);
    EXPECT_GT(apart, 0.04);
    EXPECT_LT(apart, 0.16) << k;
  }
}

TEST(LidarsAsOne, WhatIsNotUsedIsTold) {
  const TemporaryFolder folder;
  write(folder / "a.rawlog", {});
  const auto plain = open(folder / "a.rawlog");
  EXPECT_EQ(fact_value(*plain, "lidar not used"), "rear");
  EXPECT_THAT(fact_reason(*plain, "lidar not used"), HasSubstr("lidars=front,rear"));
  EXPECT_EQ(fact_value(*open(folder / "a.rawlog", {"lidars=rear"}), "lidar not used"), "front");
  EXPECT_THAT(opening_error(folder / "a.rawlog", {"lidars=front,top"}),
              HasSubstr("labels of different lidars, which are 'front', 'rear'"));
  EXPECT_THAT(opening_error(folder / "a.rawlog", {"lidars=rear,rear"}), HasSubstr("'rear'"));
}

TEST(LidarsAsOne, EveryPlaceCanBeComeBackTo) {
  const TemporaryFolder folder;
  write(folder / "a.rawlog", {false, 30});
  const auto source = open(folder / "a.rawlog", {"lidars=front,rear"});
  const auto all = read_all(*source);
  source->rewind();
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (i % 7 == 0) {
      const auto here = source->bookmark();
      ASSERT_TRUE(here);
      for (int ahead = 0; ahead < 9; ++ahead) static_cast<void>(source->next());
      source->return_to(*here);
    }
    const auto measurement = source->next();
    ASSERT_TRUE(measurement);
    ASSERT_EQ(stamp_of(*measurement), stamp_of(all[i])) << i;
    const auto* scan = std::get_if<ScanPtr>(&*measurement);
    if (scan == nullptr) continue;
    EXPECT_EQ((*scan)->x, std::get<ScanPtr>(all[i])->x) << i;
  }
  EXPECT_FALSE(source->next());
}

/// A room in which a vehicle drives in a circle: [m], rad/s. It does so at one place in its frame,
/// so that the motion of a lidar on it is constant.
constexpr double kHalfLength = 8;
constexpr double kHalfWidth = 5;
constexpr double kHalfHeight = 2;
constexpr double kRadius = 2;

Pose3 T_room_body_at(double t, double turn_rate) {
  const double angle = turn_rate * t;
  return {Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix(),
          {kRadius * std::sin(angle), -kRadius * std::cos(angle), 0}};
}

/// A sweep that begins then. \param late_ns of its stamp
LidarScan room(const Pose3& T_body_lidar, std::int64_t begin_ns, std::int64_t late_ns,
               double turn_rate, const std::string& label) {
  LidarScan scan;
  scan.stamp = {begin_ns + late_ns};
  scan.sensor = label;
  const Eigen::Vector3d half(kHalfLength, kHalfWidth, kHalfHeight);
  constexpr int kColumns = 300;
  for (int column = 0; column < kColumns; ++column) {
    const double after_s = 0.1 * column / kColumns;
    const double t = 1e-9 * static_cast<double>(begin_ns - kStart_ns) + after_s;
    const Pose3 T_room_lidar = T_room_body_at(t, turn_rate) * T_body_lidar;
    const double azimuth = 2 * std::numbers::pi * column / kColumns;
    for (std::uint16_t ring = 0; ring < 20; ++ring) {
      const double elevation = 0.05 * (ring - 9.5);
      const Eigen::Vector3d ray_lidar(std::cos(elevation) * std::cos(azimuth),
                                      std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      const Eigen::Vector3d ray = T_room_lidar.rotation * ray_lidar;
      const Eigen::Array3d to_wall =
          (ray.array().sign() * half.array() - T_room_lidar.translation.array()) / ray.array();
      const Eigen::Vector3f p = (to_wall.minCoeff() * ray_lidar).cast<float>();
      scan.x.push_back(p.x());
      scan.y.push_back(p.y());
      scan.z.push_back(p.z());
      scan.intensity.push_back(1);
      scan.ring.push_back(ring);
      scan.time.push_back(static_cast<float>(after_s));
    }
  }
  return scan;
}

void write_room(const fs::path& file, std::int64_t late_ns, double turn_rate) {
  RecordingInfo info;
  info.rig.body_frame = "vehicle";
  sensors::LidarProfile profile;
  profile.rings = 20;
  profile.stamp_fraction = 0;
  info.rig.sensors.push_back({"front", SensorKind::kLidar, kFront, profile});
  info.rig.sensors.push_back({"rear", SensorKind::kLidar, kRear, profile});
  const auto writer = write_rawlog(file, info, std::nullopt, {0});
  constexpr std::int64_t kSweepsApart_ns = 40'000'000;
  for (int i = 0; i < 24; ++i) {
    const std::int64_t ns = kStart_ns + kSweep_ns * i;
    writer->add(std::make_shared<const LidarScan>(room(kFront, ns, 0, turn_rate, "front")));
    writer->add(std::make_shared<const LidarScan>(
        room(kRear, ns + kSweepsApart_ns, late_ns, turn_rate, "rear")));
  }
  writer->commit();
}

/// Of every return the distance from the wall that it was measured at.
double farthest_from_walls(const std::vector<ScanPtr>& scans, double turn_rate) {
  double farthest = 0;
  for (const auto& scan : scans) {
    for (std::size_t i = 0; i < scan->size(); ++i) {
      const double t = 1e-9 * static_cast<double>(scan->stamp.nanoseconds - kStart_ns) +
                       static_cast<double>(scan->time[i]);
      const Eigen::Vector3d p = T_room_body_at(t, turn_rate) *
                                (kFront * Eigen::Vector3d(scan->x[i], scan->y[i], scan->z[i]));
      const Eigen::Array3d off(std::abs(std::abs(p.x()) - kHalfLength),
                               std::abs(std::abs(p.y()) - kHalfWidth),
                               std::abs(std::abs(p.z()) - kHalfHeight));
      farthest = std::max(farthest, off.minCoeff());
    }
  }
  return farthest;
}

TEST(LidarsAsOne, ClocksThatDifferAreFoundByWhatBothSee) {
  const TemporaryFolder folder;
  constexpr double kTurnRate = 0.8;
  for (const std::int64_t late_ns : {3'000'000, -12'000'000}) {
    write_room(folder / "a.rawlog", late_ns, kTurnRate);
    const auto source = open(folder / "a.rawlog", {"lidars=front,rear"});
    const double found_ms = std::stod(fact_value(*source, "clock of rear"));
    EXPECT_NEAR(found_ms, 1e-6 * static_cast<double>(late_ns), 0.1);
    EXPECT_THAT(fact_value(*source, "clock of rear"), HasSubstr("ms late against front"));
    EXPECT_LT(farthest_from_walls(read_scans(*source), kTurnRate), 0.001);

    // What is stated holds.
    const auto stated =
        open(folder / "a.rawlog",
             {"lidars=front,rear", late_ns > 0 ? "lidars_late_s=0.003" : "lidars_late_s=-0.012"});
    EXPECT_EQ(fact_value(*stated, "clock of rear"), "");
    EXPECT_LT(farthest_from_walls(read_scans(*stated), kTurnRate), 1e-5);
    const auto wrong = open(folder / "a.rawlog", {"lidars=front,rear", "lidars_late_s=0"});
    EXPECT_GT(farthest_from_walls(read_scans(*wrong), kTurnRate), 0.01);
  }
  EXPECT_THAT(opening_error(folder / "a.rawlog", {"lidars=front,rear", "lidars_late_s=0,1"}),
              HasSubstr("lidars_late_s"));
  EXPECT_THAT(opening_error(folder / "a.rawlog", {"lidars=front,rear", "lidars_late_s=3 ms"}),
              HasSubstr("'3 ms'"));
}

TEST(LidarsAsOne, ClocksOfAVehicleThatStandsAreTakenToBeOne) {
  const TemporaryFolder folder;
  write_room(folder / "a.rawlog", 3'000'000, 0);
  const auto source = open(folder / "a.rawlog", {"lidars=front,rear"});
  EXPECT_EQ(fact_value(*source, "clock of rear"), "taken to be that of front");
  EXPECT_THAT(fact_reason(*source, "clock of rear"), HasSubstr("lidars_late_s"));
}

}  // namespace
}  // namespace traverse::dataset
