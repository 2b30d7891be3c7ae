#include <random>

#include <gtest/gtest.h>

#include "traverse/voxel_map/alignment.hpp"
#include "traverse/voxel_map/scan_information.hpp"

namespace traverse::voxel_map {
namespace {

/// A straight street along x: a wall, ground and their normals, off by `noise`, and `facing` planes
/// across the street.
ScanMatches street(double noise, std::size_t facing) {
  constexpr std::size_t kAlong = 600;
  std::mt19937 random(1);
  std::normal_distribution<double> off(0, noise);
  std::uniform_real_distribution<double> far(-20, 20);
  ScanMatches matches;
  matches.origin_map.setZero();
  PlaneRows& rows = matches.planes;
  rows.resize(kAlong + facing);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const bool is_wall = i % 2 == 0;
    Eigen::Vector3d normal = Eigen::Vector3d::UnitX();
    if (i < kAlong) {
      const double tilt = off(random);
      normal = Eigen::Vector3d(tilt, is_wall ? 1 : 0, is_wall ? 0 : 1).normalized();
    }
    const double ahead = far(random);
    const double aside = far(random);
    const Eigen::Vector3d p(ahead, is_wall ? 5 : aside, is_wall ? 0.1 * aside : -2);
    const auto as_float = [](double value) { return static_cast<float>(value); };
    rows.x[i] = as_float(p.x());
    rows.y[i] = as_float(p.y());
    rows.z[i] = as_float(p.z());
    rows.time[i] = 0;
    rows.nx[i] = as_float(normal.x());
    rows.ny[i] = as_float(normal.y());
    rows.nz[i] = as_float(normal.z());
    rows.d[i] = as_float(-normal.dot(p));
    rows.weight[i] = 2500;
    rows.age[i] = 1;
  }
  return matches;
}

lidar::Vector6 shares_of(const ScanMatches& matches) {
  MotionModel motion;
  motion.deskew = false;
  parallel::Workers alone(1);
  const geometry::Pose3 at = geometry::Pose3::identity();
  const NormalEquations normal = evaluate(matches, motion, at, ObjectiveOptions{}, alone);
  const lidar::Observability seen =
      judged_observability(normal, matches, at, motion, 10, AlignmentOptions{}.min_eigenvalue);
  return facing_shares(seen, matches, at, motion);
}

// Six planes of 606 face the street's axis: 0.0099 a match. Normals that are off by 0.1 add as
// much.
TEST(FacingShares, CountOfAStreetsAxisWhatFacesIt) {
  const lidar::Vector6 shares = shares_of(street(0.1, 6));
  EXPECT_NEAR(shares[0], 0.5, 0.15);
  EXPECT_EQ(shares.tail<4>(), (Eigen::Vector4d::Ones()));
  EXPECT_GT(shares_of(street(0.01, 6))[0], 0.9);
}

TEST(FacingShares, AreNothingWhereNothingFacesADirection) {
  EXPECT_EQ(shares_of(street(0.02, 0))[0], 0);
}

}  // namespace
}  // namespace traverse::voxel_map
