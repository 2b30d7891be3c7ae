#include "traverse/simulation/lidar_simulator.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <set>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "traverse/geometry/angle.hpp"

#include "simulation/motion_settings.hpp"

namespace traverse::simulation {
namespace {

using Eigen::Vector3d;

sensors::LidarProfile profile_of(const char* name) {
  return sensors::load_lidar_profile(std::string(TRAVERSE_SHARE_DIR) + "/sensors/" + name +
                                     ".yaml");
}

geometry::Pose3 on_the_roof() {
  geometry::Pose3 T_body_lidar;
  T_body_lidar.translation = {1, 0, 1.9};
  return T_body_lidar;
}

/// A winding drive through a small town, made once.
struct Town {
  VehicleMotion motion = testing::winding_drive();
  Surroundings surroundings{build_place(PlaceSettings{}, motion.route(), testing::hills(), 2)};

  static const Town& instance() {
    static const Town town;
    return town;
  }
};

LidarSimulator lidar_in(const Town& town, const sensors::LidarProfile& profile) {
  return {profile, on_the_roof(), town.surroundings, town.motion, 4};
}

/// A moment when the vehicle is in its first corner.
std::size_t sweep_in_corner(const LidarSimulator& lidar, const VehicleMotion& motion) {
  for (std::size_t i = 0; i < lidar.sweeps(); ++i) {
    if (std::abs(motion.state(lidar.begin_s(i)).angular_rate_body.z()) > 0.25) return i;
  }
  throw std::logic_error("the drive has no corner");
}

/// Root mean square of measured minus true range, with each point's pose from `seconds_of`.
template <typename SecondsOf>
double rms_off_surface(const Town& town, const sensors::LidarScan& scan,
                       const SecondsOf& seconds_of, std::size_t& outliers) {
  double sum = 0;
  outliers = 0;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const double seconds = seconds_of(i);
    const geometry::Pose3 T_map_lidar = town.motion.state(seconds).T_map_body * on_the_roof();
    const Vector3d p_lidar(scan.x[i], scan.y[i], scan.z[i]);
    const Ray ray{T_map_lidar.translation, T_map_lidar.rotation * p_lidar.normalized()};
    const SurfaceHit hit = town.surroundings.cast(ray, seconds, 300);
    const double off = hit.is_hit() ? p_lidar.norm() - hit.distance_m : 1;
    // Where a surface ends, the last digit of a float decides what is met.
    if (std::abs(off) > 0.2) {
      ++outliers;
    } else {
      sum += off * off;
    }
  }
  return std::sqrt(sum / static_cast<double>(scan.size() - outliers));
}

TEST(LidarSimulator, DeskewedWithTruePosesAScanLiesOnTheWorldsSurfaces) {
  const Town& town = Town::instance();
  for (const char* name : {"hdl64e", "vlp16"}) {
    sensors::LidarProfile profile = profile_of(name);
    profile.noise.resolution_m = 0;
    profile.firing.period_us *= 4;  // fewer rays
    const LidarSimulator lidar = lidar_in(town, profile);
    const std::size_t sweep = sweep_in_corner(lidar, town.motion);
    const sensors::LidarScan scan = lidar.scan(sweep);
    ASSERT_GT(scan.size(), 3000U) << name;
    const auto moment = [&](std::size_t i) { return scan.stamp.seconds() + scan.time[i]; };
    std::size_t outliers = 0;
    EXPECT_NEAR(rms_off_surface(town, scan, moment, outliers), profile.noise.range_m, 0.001)
        << name;
    EXPECT_LT(outliers, scan.size() / 500) << name;
    // Without the motion within the sweep, it does not.
    const auto stamp = [&](std::size_t) { return scan.stamp.seconds(); };
    const double skewed = rms_off_surface(town, scan, stamp, outliers);
    EXPECT_GT(skewed + 0.1 * (outliers > scan.size() / 20), 0.04) << name;
  }
}

TEST(LidarSimulator, WithoutNoiseEveryPointIsExactToTheFloat) {
  const Town& town = Town::instance();
  sensors::LidarProfile profile = profile_of("os1_64");
  profile.noise.range_m = profile.noise.resolution_m = 0;
  profile.firing.period_us *= 8;
  const LidarSimulator lidar = lidar_in(town, profile);
  const sensors::LidarScan scan = lidar.scan(sweep_in_corner(lidar, town.motion));
  std::size_t outliers = 0;
  const auto moment = [&](std::size_t i) { return scan.stamp.seconds() + scan.time[i]; };
  EXPECT_LT(rms_off_surface(town, scan, moment, outliers), 2e-4);
  EXPECT_LT(outliers, scan.size() / 500);
}

TEST(LidarSimulator, EachPointHasTheAngleAndTheTimeOfItsBeam) {
  const Town& town = Town::instance();
  const sensors::LidarProfile profile = profile_of("vlp16");
  const LidarSimulator lidar = lidar_in(town, profile);
  const sensors::LidarScan scan = lidar.scan(40);
  float latest = -1;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const double elevation =
        std::atan2(scan.z[i], std::hypot(scan.x[i], scan.y[i])) / geometry::kDegree;
    EXPECT_NEAR(elevation, profile.elevations_deg[scan.ring[i]], 1e-4);
    EXPECT_GE(scan.time[i], 0);
    EXPECT_LT(scan.time[i], 0.1001);
    latest = std::max(latest, scan.time[i]);
    // Clockwise from behind, at constant rate.
    const double azimuth = std::atan2(scan.y[i], scan.x[i]);
    const double expected = std::remainder(
        std::numbers::pi - 2 * std::numbers::pi * scan.time[i] / 0.1, 2 * std::numbers::pi);
    EXPECT_NEAR(std::remainder(azimuth - expected, 2 * std::numbers::pi), 0, 1e-4);
  }
  EXPECT_GT(latest, 0.099F);
}

TEST(LidarSimulator, ALidarThatStampsAtTheEndTellsTimesBeforeItsStamp) {
  const Town& town = Town::instance();
  const sensors::LidarProfile profile = profile_of("rs16");
  ASSERT_EQ(profile.stamp_fraction, 1);
  const LidarSimulator lidar = lidar_in(town, profile);
  const sensors::LidarScan scan = lidar.scan(sweep_in_corner(lidar, town.motion));
  const auto [first, last] = std::minmax_element(scan.time.begin(), scan.time.end());
  EXPECT_GE(*first, -0.1001F);
  EXPECT_LT(*first, -0.09F);
  EXPECT_LT(*last, 1e-4F);
  EXPECT_GT(*last, -0.01F);
  const auto moment = [&](std::size_t i) { return scan.stamp.seconds() + scan.time[i]; };
  std::size_t outliers = 0;
  EXPECT_NEAR(rms_off_surface(town, scan, moment, outliers), profile.noise.range_m, 0.001);
  EXPECT_LT(outliers, scan.size() / 500);
}

TEST(LidarSimulator, AMirrorThatNodsNeverSweepsTheSameWayTwice) {
  const Town& town = Town::instance();
  sensors::LidarProfile profile = profile_of("mid360");
  profile.noise.resolution_m = 0;
  const LidarSimulator lidar = lidar_in(town, profile);
  const std::size_t sweep = sweep_in_corner(lidar, town.motion);
  const sensors::LidarScan scan = lidar.scan(sweep);
  ASSERT_GT(scan.size(), 5000U);
  const auto elevation_deg = [](const sensors::LidarScan& s, std::size_t i) {
    return std::atan2(s.z[i], std::hypot(s.x[i], s.y[i])) / geometry::kDegree;
  };
  double lowest = 90;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    EXPECT_GE(elevation_deg(scan, i), -7.01);
    EXPECT_LE(elevation_deg(scan, i), 52.01);
    EXPECT_LT(scan.ring[i], 4);
    lowest = std::min(lowest, elevation_deg(scan, i));
  }
  EXPECT_LT(lowest, -6);
  // Directions of the one sweep, by degrees, that the next has not.
  const auto directions = [&](const sensors::LidarScan& s) {
    std::set<std::pair<int, int>> all;
    for (std::size_t i = 0; i < s.size(); ++i) {
      const double azimuth_deg = std::atan2(s.y[i], s.x[i]) / geometry::kDegree;
      all.insert({static_cast<int>(std::lround(azimuth_deg)),
                  static_cast<int>(std::lround(elevation_deg(s, i)))});
    }
    return all;
  };
  const auto now = directions(scan);
  const auto next = directions(lidar.scan(sweep + 1));
  std::size_t anew = 0;
  for (const auto& direction : next) anew += now.count(direction) == 0 ? 1 : 0;
  EXPECT_GT(static_cast<double>(anew), 0.3 * static_cast<double>(next.size()));
  const auto moment = [&](std::size_t i) { return scan.stamp.seconds() + scan.time[i]; };
  std::size_t outliers = 0;
  EXPECT_NEAR(rms_off_surface(town, scan, moment, outliers), profile.noise.range_m, 0.001);
  EXPECT_LT(outliers, scan.size() / 500);
}

TEST(LidarSimulator, EveryInstalledProfileThatTellsItsFiringCanBeSimulated) {
  const Town& town = Town::instance();
  std::size_t count = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string(TRAVERSE_SHARE_DIR) + "/sensors")) {
    const sensors::LidarProfile profile = sensors::load_lidar_profile(entry.path());
    if (profile.firing.period_us == 0) continue;
    const auto& mirror = profile.firing.mirror;
    EXPECT_EQ((mirror.turns_hz > 0 ? mirror.tilts_deg : profile.elevations_deg).size(),
              static_cast<std::size_t>(profile.rings))
        << entry.path();
    EXPECT_NO_THROW(lidar_in(town, profile)) << entry.path();
    ++count;
  }
  EXPECT_GE(count, 22U);
}

TEST(LidarSimulator, SkyGivesNoPointsAndTheRestIsWithinReach) {
  // An empty plain: every beam above the horizon sees nothing.
  const VehicleMotion motion({}, {}, Terrain({}, 1), 1);
  Place place;
  place.still.add_quad({-500, -500, 0}, {500, -500, 0}, {500, 500, 0}, {-500, 500, 0},
                       Material::kPlaster);
  const Surroundings surroundings(place);
  const sensors::LidarProfile profile = profile_of("os1_64");
  const LidarSimulator lidar(profile, on_the_roof(), surroundings, motion, 1);
  const sensors::LidarScan scan = lidar.scan(0);
  EXPECT_EQ(sensors::count_faults(scan).total(), 0U);
  ASSERT_FALSE(scan.empty());
  for (std::size_t i = 0; i < scan.size(); ++i) {
    EXPECT_LT(profile.elevations_deg[scan.ring[i]], 0);
    EXPECT_LE(Vector3d(scan.x[i], scan.y[i], scan.z[i]).norm(), profile.max_range_m + 1e-4);
  }
}

TEST(LidarSimulator, TheSameSeedGivesTheSameBytesAndAnotherDoesNot) {
  const Town& town = Town::instance();
  sensors::LidarProfile profile = profile_of("vlp16");
  const LidarSimulator lidar = lidar_in(town, profile);
  const sensors::LidarScan a = lidar.scan(30);
  lidar.scan(3);  // in whatever order
  const sensors::LidarScan b = lidar.scan(30);
  EXPECT_EQ(a.x, b.x);
  EXPECT_EQ(a.intensity, b.intensity);
  EXPECT_EQ(a.time, b.time);
  const LidarSimulator other(profile, on_the_roof(), town.surroundings, town.motion, 5);
  EXPECT_NE(a.x, other.scan(30).x);
}

TEST(LidarSimulator, SaysWhatAProfileLacks) {
  const Town& town = Town::instance();
  sensors::LidarProfile profile = profile_of("vlp16");
  profile.firing.times_us.pop_back();
  EXPECT_THROW(lidar_in(town, profile), std::invalid_argument);
  EXPECT_THROW(lidar_in(town, sensors::LidarProfile()), std::invalid_argument);
  profile = profile_of("vlp16");
  profile.firing.period_us = 1e-6;  // 10^11 columns
  EXPECT_THROW(lidar_in(town, profile), std::invalid_argument);
  profile = profile_of("vlp16");
  profile.sweep_s = 1e300;
  profile.firing.period_us = 1e306;
  EXPECT_THROW(lidar_in(town, profile), std::invalid_argument);
}

}  // namespace
}  // namespace traverse::simulation
