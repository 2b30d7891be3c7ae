#include "swept_point.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "traverse/geometry/so3.hpp"
#include "traverse/optimization/random_states.hpp"
#include "traverse/parallel/workers.hpp"
#include "traverse/voxel_map/scan_objective.hpp"

namespace traverse::voxel_map {
namespace {

const geometry::Pose3 kPrevious{geometry::exp_so3({0.1, -0.2, 0.7}), {13, -4, 3}};

/// 36 km/h to 108 km/h, turning by up to half a radian a second: a car's.
geometry::Twist motion_of_a_car(optimization::RandomStates& random) {
  geometry::Twist motion;
  motion << random.vector(0.01).head<2>(), random.uniform(-0.05, 0.05), random.uniform(1, 3),
      random.vector(0.1).head<2>();
  return motion;
}

TEST(SweptPoint, StandsWhereItWasMeasured) {
  geometry::Twist motion;
  motion << 0.1, 0.2, -0.3, 1, 2, 3;
  const geometry::Pose3 pose = kPrevious * geometry::exp_se3(motion);
  const Eigen::Vector3d p(4, -5, 6);
  EXPECT_LT((SweptPoint(kPrevious, p, 0).at(pose) - pose * p).norm(), 1e-12);
  EXPECT_LT((SweptPoint(kPrevious, p, -1).at(pose) - kPrevious * p).norm(), 1e-12)
      << "a whole interval before the pose";
}

TEST(SweptPoint, DerivativeMatchesDifferences) {
  optimization::RandomStates random(1);
  for (int trial = 0; trial < 50; ++trial) {
    geometry::Twist motion;
    motion << random.vector(0.5), random.vector(5);
    const geometry::Pose3 pose = kPrevious * geometry::exp_se3(motion);
    const SweptPoint point(kPrevious, random.vector(20), random.uniform(-0.5, 0.5));
    const Matrix36 J = point.derivative(pose);
    constexpr double h = 1e-5;
    for (int k = 0; k < 6; ++k) {
      const auto moved = [&](double step) {
        geometry::Pose3 other = pose;
        if (k < 3) {
          other.rotation = pose.rotation * geometry::exp_so3(step * Eigen::Vector3d::Unit(k));
        } else {
          other.translation += step * Eigen::Vector3d::Unit(k - 3);
        }
        return point.at(other);
      };
      EXPECT_LT((J.col(k) - (moved(h) - moved(-h)) / (2 * h)).norm(), 1e-7) << trial << " " << k;
    }
  }
}

/// The Jacobian of one plane row as evaluate() sees it: g / (w r), with a kernel so wide that it
/// does not weigh.
lidar::Vector6 row_of_evaluate(const SweptPoint& point, double interval_s,
                               const Eigen::Vector3d& normal, const geometry::Pose3& pose) {
  const double residual = 1;
  ScanMatches matches;
  matches.origin_map.setZero();
  PlaneRows& rows = matches.planes;
  rows.resize(1);
  const Eigen::Vector3f p = point.p_lidar().cast<float>();
  const Eigen::Vector3f n = normal.cast<float>();
  rows.x[0] = p.x();
  rows.y[0] = p.y();
  rows.z[0] = p.z();
  rows.time[0] = static_cast<float>(point.share() * interval_s);
  rows.nx[0] = n.x();
  rows.ny[0] = n.y();
  rows.nz[0] = n.z();
  rows.d[0] = static_cast<float>(residual - normal.dot(point.at(pose)));
  rows.weight[0] = 1;
  ObjectiveOptions wide;
  wide.kernel = 1e5;
  parallel::Workers workers(1);
  const MotionModel motion{point.T_previous_map().inverse(), interval_s, true};
  return evaluate(matches, motion, pose, wide, workers).g / residual;
}

TEST(SweptPoint, WhatEvaluateLeavesOutOfTheJacobianIsLittleInACar) {
  optimization::RandomStates random(2);
  double worst = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    const geometry::Pose3 pose = kPrevious * geometry::exp_se3(motion_of_a_car(random));
    const SweptPoint point(kPrevious, random.uniform(3, 80) * random.unit_vector(),
                           random.uniform(-0.5, 0.5));
    const Eigen::Vector3d normal = random.unit_vector();
    const lidar::Vector6 exact = (normal.transpose() * point.derivative(pose)).transpose();
    const lidar::Vector6 kept = row_of_evaluate(point, 0.1, normal, pose);
    const double turn = (kept - exact).head<3>().norm() / (point.p_lidar().norm() + 1);
    const double shift = (kept - exact).tail<3>().norm();
    worst = std::max({worst, turn, shift});
  }
  EXPECT_LT(worst, 4e-3) << "of the lever arm and a metre; of one";
  EXPECT_GT(worst, 1e-4) << "so the comparison sees the second order";
}

}  // namespace
}  // namespace traverse::voxel_map
