#include "traverse/simulation/simulation.hpp"

#include <map>

#include <gtest/gtest.h>

#include "traverse/simulation/ring_order.hpp"

namespace traverse::simulation {
namespace {

using sensors::Measurement;

Simulation corridor(const std::vector<std::string>& overrides = {}) {
  const auto world = load_world(find_world("corridor_loop", TRAVERSE_SHARE_DIR), overrides);
  return {world, sensors::load_lidar_profile(TRAVERSE_SHARE_DIR "/sensors/vlp16.yaml")};
}

std::vector<Measurement> run(const Simulation& simulation, const SweepRange& sweeps, int threads) {
  std::vector<Measurement> measurements;
  simulation.run(sweeps, threads, [&](Measurement&& m) { measurements.push_back(std::move(m)); });
  return measurements;
}

TEST(Simulation, GivesEverySensorInTheOrderOfStamps) {
  const Simulation simulation = corridor({"gnss.mounted=true"});
  const auto measurements = run(simulation, {20, 30}, 2);
  std::map<std::string, int> count;
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    ++count[sensor_of(measurements[i])];
    const std::size_t before = i > 0 ? i - 1 : 0;
    EXPECT_LE(stamp_of(measurements[before]), stamp_of(measurements[i]));
  }
  EXPECT_EQ(count["lidar"], 10);
  EXPECT_EQ(count["imu"], 100);
  EXPECT_EQ(count["wheels"], 50);
  EXPECT_EQ(count["gnss"], 0) << "indoors";
  EXPECT_EQ(simulation.rig().sensors.size(), 4U);
}

TEST(Simulation, TheSameForAnyNumberOfThreadsAndAnyStretch) {
  const Simulation simulation = corridor();
  const auto one = run(simulation, {10, 22}, 1);
  const auto four = run(simulation, {10, 22}, 4);
  const auto stretch = run(simulation, {16, 22}, 2);
  ASSERT_EQ(one.size(), four.size());
  const auto same = [](const Measurement& a, const Measurement& b) {
    ASSERT_EQ(stamp_of(a), stamp_of(b));
    ASSERT_EQ(a.index(), b.index());
    if (const auto* scan = std::get_if<std::shared_ptr<const sensors::LidarScan>>(&a)) {
      const auto& other = std::get<std::shared_ptr<const sensors::LidarScan>>(b);
      EXPECT_EQ((*scan)->x, other->x);
      EXPECT_EQ((*scan)->time, other->time);
    } else if (const auto* imu = std::get_if<sensors::ImuSample>(&a)) {
      EXPECT_EQ(imu->angular_rate, std::get<sensors::ImuSample>(b).angular_rate);
    } else if (const auto* wheels = std::get_if<sensors::WheelOdometry>(&a)) {
      EXPECT_EQ(wheels->ticks->left, std::get<sensors::WheelOdometry>(b).ticks->left);
    }
  };
  for (std::size_t i = 0; i < one.size(); ++i) same(one[i], four[i]);
  const std::size_t skipped = one.size() - stretch.size();
  for (std::size_t i = 0; i < stretch.size(); ++i) same(one[skipped + i], stretch[i]);
}

TEST(Simulation, StampsAreLateByTheClocksOffset) {
  const auto imu_stamps = [](const Simulation& simulation) {
    std::vector<geometry::Stamp> stamps;
    for (const Measurement& m : run(simulation, {5, 8}, 1)) {
      if (sensor_of(m) == "imu") stamps.push_back(stamp_of(m));
    }
    return stamps;
  };
  const auto exact = imu_stamps(corridor());
  const auto late = imu_stamps(corridor({"clock.imu_late_s=0.013"}));
  // The reading that is stamped first belongs to an earlier moment, so its stamp is off the grid.
  const double off = geometry::seconds_between(exact.front(), late.front());
  EXPECT_NEAR(std::remainder(off - 0.013, 0.01), 0, 1e-9);
}

TEST(Simulation, TruthIsOfTheBodyAtTheStamps) {
  const Simulation simulation = corridor();
  const geometry::Trajectory truth = simulation.truth({3, 6});
  ASSERT_EQ(truth.size(), 3U);
  const geometry::Pose3 expected =
      simulation.motion().state(simulation.lidar().stamp_s(4)).T_map_body;
  EXPECT_EQ(truth.pose(1).translation, expected.translation);
  EXPECT_NEAR(geometry::seconds_between(truth.stamp(0), truth.stamp(2)), 0.2, 1e-9);
}

TEST(Simulation, ThereIsATruePoseForEverySample) {
  const Simulation simulation = corridor();
  const geometry::Trajectory truth = simulation.truth_of_all_sensors({5, 8});
  std::size_t samples = 0;
  for (const Measurement& m : run(simulation, {5, 8}, 1)) {
    double nearest_s = 1;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const double off = std::abs(geometry::seconds_between(truth.stamp(i), stamp_of(m)));
      nearest_s = std::min(nearest_s, off);
    }
    EXPECT_LT(nearest_s, 1e-8) << sensor_of(m);
    ++samples;
  }
  EXPECT_GT(samples, 40U);  // 0.3 s of IMU, wheels, GNSS, and the sweeps
  for (std::size_t i = 1; i < truth.size(); ++i) EXPECT_LT(truth.stamp(i - 1), truth.stamp(i));
}

TEST(Simulation, TheOwnDriveByItsSeedIsTheDriveOfAWorldThatNamesNone) {
  const auto scan = [](const Simulation& simulation) { return simulation.lidar().scan(30); };
  const sensors::LidarScan own = scan(corridor());
  EXPECT_EQ(own.x, scan(corridor({"drive_seed=17"})).x) << "17 is the world's seed";
  EXPECT_NE(own.x, scan(corridor({"drive_seed=18"})).x);
}

TEST(Simulation, AnotherDriveSeesTheSamePlaceWithOtherNoiseFromAnotherLine) {
  const Simulation own = corridor({"place.pedestrians=2"});
  const Simulation other = corridor({"place.pedestrians=2", "drive_seed=18"});
  const auto imu_of = [](const Simulation& simulation) {
    for (const Measurement& m : run(simulation, {3, 4}, 1)) {
      if (const auto* sample = std::get_if<sensors::ImuSample>(&m)) return *sample;
    }
    return sensors::ImuSample{};
  };
  EXPECT_NE(imu_of(own).angular_rate, imu_of(other).angular_rate);
  EXPECT_NE(own.motion().duration_s(), other.motion().duration_s()) << "its pace";
  EXPECT_NE(own.calibration(), other.calibration()) << "biases of the IMU";

  // What it sees while it stands lies on what was built for the first drive.
  const WorldDescription& world = own.world();
  const Route route(world.route);
  const Place built = build_place(world.place, route, Terrain(world.terrain, 17), 17);
  const RayCaster walls(built.still);
  const geometry::Pose3 T_map_lidar =
      other.motion().state(0.4).T_map_body * world.lidar.T_body_sensor();
  const sensors::LidarScan scan = other.lidar().scan(3);
  std::size_t on_walls = 0;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const Eigen::Vector3d p(scan.x[i], scan.y[i], scan.z[i]);
    const Eigen::Vector3d direction = T_map_lidar.rotation * p.normalized();
    const auto hit = walls.cast({T_map_lidar.translation, direction}, 2 * p.norm());
    on_walls += hit.is_hit() && std::abs(hit.distance_m - p.norm()) < 0.1 ? 1 : 0;
  }
  EXPECT_GT(static_cast<double>(on_walls), 0.97 * static_cast<double>(scan.size()));
}

TEST(RingOrder, PointsGoRoundRingAfterRing) {
  const sensors::LidarScan scan = corridor().lidar().scan(12);
  const sensors::LidarScan ordered = in_ring_order(scan);
  ASSERT_EQ(ordered.size(), scan.size());
  int wraps = 0;
  for (std::size_t i = 1; i < ordered.size(); ++i) {
    wraps += ordered.y[i - 1] < 0 && ordered.y[i] >= 0 && ordered.x[i] > 0 ? 1 : 0;
  }
  EXPECT_EQ(wraps, 15);
  EXPECT_TRUE(ordered.ring.empty());
}

}  // namespace
}  // namespace traverse::simulation
