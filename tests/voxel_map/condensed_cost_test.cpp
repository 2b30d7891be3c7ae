#include "condensed_cost.hpp"

#include <random>

#include <gtest/gtest.h>

#include "traverse/geometry/so3.hpp"
#include "traverse/optimization/rotation_manifold.hpp"
#include "traverse/parallel/workers.hpp"

namespace traverse::voxel_map {
namespace {

geometry::Twist twist(double rx, double ry, double rz, double tx, double ty, double tz) {
  return (geometry::Twist() << rx, ry, rz, tx, ty, tz).finished();
}

/// Random points 5 to 25 m around with random planes and lines near them.
ScanMatches random_matches(unsigned seed, std::size_t planes, std::size_t lines,
                           const geometry::Pose3& T_map_lidar) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto direction = [&] {
    return Eigen::Vector3d{normal(generator), normal(generator), normal(generator)}.normalized();
  };
  ScanMatches matches;
  matches.origin_map = origin_near(T_map_lidar.translation);
  const auto add = [&](PlaneRows& rows, const Eigen::Vector3d& p, double time,
                       const Eigen::Vector3d& n) {
    const Eigen::Vector3d q = T_map_lidar * p - matches.origin_map;
    const double offset = -n.dot(q) + 0.03 * normal(generator);
    const auto push = [](std::vector<float>& to, double value) {
      to.push_back(static_cast<float>(value));
    };
    push(rows.x, p.x());
    push(rows.y, p.y());
    push(rows.z, p.z());
    push(rows.time, time);
    push(rows.nx, n.x());
    push(rows.ny, n.y());
    push(rows.nz, n.z());
    push(rows.d, offset);
    push(rows.weight, 1000);
  };
  for (std::size_t i = 0; i < planes + lines; ++i) {
    const Eigen::Vector3d p = (15 + 10 * uniform(generator)) * direction();
    const double time = 0.05 * uniform(generator);
    const Eigen::Vector3d n = direction();
    if (i < planes) {
      add(matches.planes, p, time, n);
    } else {
      add(matches.line_1, p, time, n);
      add(matches.line_2, p, time, n.unitOrthogonal());
    }
  }
  return matches;
}

/// A pose in motion: 12 m/s and half a radian a second.
struct MovingPose {
  geometry::Pose3 T_map_lidar = geometry::Pose3{geometry::exp_so3({0.1, -0.2, 0.7}), {130, -40, 3}};
  MotionModel motion{T_map_lidar * geometry::exp_se3(-0.1 * twist(0.05, -0.1, 0.5, 12, 0.5, 0.2)),
                     0.1, true};
};

TEST(Evaluate, GradientIsThatOfTheCost) {
  const MovingPose at;
  parallel::Workers workers(1);
  const ScanMatches matches = random_matches(1, 900, 150, at.T_map_lidar);
  const NormalEquations normal = evaluate(matches, at.motion, at.T_map_lidar, {}, workers);
  for (Eigen::Index k = 0; k < 6; ++k) {
    const double h = k < 3 ? 1e-4 : 1e-3;
    const auto cost = [&](double step) {
      geometry::Pose3 moved = at.T_map_lidar;
      if (k < 3) {
        moved.rotation = moved.rotation * geometry::exp_so3(step * Eigen::Vector3d::Unit(k));
      } else {
        moved.translation += step * Eigen::Vector3d::Unit(k - 3);
      }
      return evaluate(matches, at.motion, moved, {}, workers).cost;
    };
    const double numeric = (cost(h) - cost(-h)) / (2 * h);
    // What is left out is of the second order in the motion within the sweep.
    EXPECT_NEAR(normal.g[k], numeric, 3e-3 * std::sqrt(normal.H(k, k) * normal.cost)) << k;
  }
}

TEST(Evaluate, DeskewThatFollowsThePoseMakesItWeighMore) {
  // A wall straight ahead, seen late in the sweep: moving the pose by d moves the point by 1.5 d.
  MovingPose at;
  at.T_map_lidar = geometry::Pose3::identity();
  at.motion.T_map_previous = geometry::Pose3::identity();
  ScanMatches matches;
  matches.origin_map.setZero();
  for (auto [values, value] :
       std::initializer_list<std::pair<std::vector<float>*, float>>{{&matches.planes.x, 10},
                                                                    {&matches.planes.y, 0},
                                                                    {&matches.planes.z, 0},
                                                                    {&matches.planes.time, 0.05F},
                                                                    {&matches.planes.nx, 1},
                                                                    {&matches.planes.ny, 0},
                                                                    {&matches.planes.nz, 0},
                                                                    {&matches.planes.d, -10},
                                                                    {&matches.planes.weight, 1}}) {
    values->push_back(value);
  }
  parallel::Workers workers(1);
  EXPECT_NEAR(evaluate(matches, at.motion, at.T_map_lidar, {}, workers).H(3, 3), 1.5 * 1.5, 1e-5);
  at.motion.deskew = false;
  EXPECT_NEAR(evaluate(matches, at.motion, at.T_map_lidar, {}, workers).H(3, 3), 1, 1e-5);
}

TEST(Evaluate, SameBitsForAnyNumberOfThreads) {
  const MovingPose at;
  const ScanMatches matches = random_matches(2, 5000, 1500, at.T_map_lidar);
  parallel::Workers one(1);
  const NormalEquations serial = evaluate(matches, at.motion, at.T_map_lidar, {}, one);
  for (const int threads : {2, 4}) {
    parallel::Workers many(threads);
    const NormalEquations parallel = evaluate(matches, at.motion, at.T_map_lidar, {}, many);
    EXPECT_EQ(serial.H, parallel.H);
    EXPECT_EQ(serial.g, parallel.g);
    EXPECT_EQ(serial.cost, parallel.cost);
  }
}

TEST(Evaluate, AnOutlierHardlyPulls) {
  const MovingPose at;
  parallel::Workers workers(1);
  ScanMatches matches = random_matches(3, 1, 0, at.T_map_lidar);
  matches.planes.d[0] += 0.5F;
  const double far = evaluate(matches, at.motion, at.T_map_lidar, {}, workers).g.tail<3>().norm();
  matches.planes.d[0] -= 0.45F;
  const double near = evaluate(matches, at.motion, at.T_map_lidar, {}, workers).g.tail<3>().norm();
  EXPECT_LT(far, 0.2 * near);
}

TEST(CondensedCost, HasTheValueGradientAndModelOfTheWholeScan) {
  const MovingPose at;
  parallel::Workers workers(1);
  const ScanMatches matches = random_matches(4, 900, 150, at.T_map_lidar);
  const ObjectiveOptions options;
  const CondensedCost cost(matches, at.motion, options, workers);
  const NormalEquations normal = evaluate(matches, at.motion, at.T_map_lidar, options, workers);

  const Eigen::Quaterniond q = at.T_map_lidar.quaternion();
  const double* parameters[] = {q.coeffs().data(), at.T_map_lidar.translation.data()};
  Eigen::Matrix<double, 7, 1> r;
  Eigen::Matrix<double, 7, 4, Eigen::RowMajor> J_q;
  Eigen::Matrix<double, 7, 3, Eigen::RowMajor> J_t;
  double* jacobians[] = {J_q.data(), J_t.data()};
  ASSERT_TRUE(cost.Evaluate(parameters, r.data(), jacobians));
  Eigen::Matrix<double, 7, 6> J;
  J << J_q * optimization::RotationManifold::plus_jacobian(q.coeffs().data(),
                                                           optimization::Perturbation::kRight),
      J_t;
  EXPECT_NEAR(0.5 * r.squaredNorm(), normal.cost, 1e-6 * normal.cost);
  EXPECT_TRUE((J.transpose() * r).isApprox(normal.g, 1e-5));
  EXPECT_TRUE((J.transpose() * J).isApprox(normal.H, 1e-5));
}

/// What ceres::GradientChecker would ask of the seven residuals cannot hold: J is that of a factor
/// of the Gauss-Newton model, and L changes with the pose. What a solver needs of them does: along
/// the manifold J'r is the derivative of r'r / 2, by the cost's own values.
TEST(CondensedCost, ItsGradientIsTheDerivativeOfItsCostOnTheManifold) {
  MovingPose at;
  at.motion.deskew = false;  // exact but for floats; else to the first order of the motion
  parallel::Workers workers(1);
  const ScanMatches matches = random_matches(6, 900, 150, at.T_map_lidar);
  const optimization::RotationManifold manifold;
  const Eigen::Quaterniond q = at.T_map_lidar.quaternion();
  const Eigen::Vector3d t = at.T_map_lidar.translation;
  const ObjectiveOptions options;
  const CondensedCost cost(matches, at.motion, options, workers);
  Eigen::Matrix<double, 7, 1> r;
  Eigen::Matrix<double, 7, 4, Eigen::RowMajor> J_q;
  Eigen::Matrix<double, 7, 3, Eigen::RowMajor> J_t;
  const double* parameters[] = {q.coeffs().data(), t.data()};
  double* jacobians[] = {J_q.data(), J_t.data()};
  ASSERT_TRUE(cost.Evaluate(parameters, r.data(), jacobians));
  EXPECT_LT((J_q * q.coeffs()).norm(), 1e-9 * J_q.norm()) << "the length of q does not matter";
  Eigen::Matrix<double, 7, 6> J;
  J << J_q * optimization::RotationManifold::plus_jacobian(q.coeffs().data(),
                                                           optimization::Perturbation::kRight),
      J_t;
  const lidar::Vector6 gradient = J.transpose() * r;

  for (Eigen::Index k = 0; k < 6; ++k) {
    const auto cost_at = [&](double step) {
      lidar::Vector6 delta = step * lidar::Vector6::Unit(k);
      Eigen::Vector4d moved_q;
      manifold.Plus(q.coeffs().data(), delta.data(), moved_q.data());
      const Eigen::Vector3d moved_t = t + delta.tail<3>();
      const double* moved[] = {moved_q.data(), moved_t.data()};
      Eigen::Matrix<double, 7, 1> moved_r;
      EXPECT_TRUE(cost.Evaluate(moved, moved_r.data(), nullptr));
      return 0.5 * moved_r.squaredNorm();
    };
    const double h = k < 3 ? 3e-4 : 3e-3;
    const double numeric =
        (8 * (cost_at(h) - cost_at(-h)) - (cost_at(2 * h) - cost_at(-2 * h))) / (12 * h);
    const double scale = J.col(k).norm() * r.norm();
    EXPECT_NEAR(gradient[k], numeric, 1e-4 * scale) << k;
  }
}

TEST(CondensedCost, AMotionThatNoMatchSeesIsNoFailure) {
  const MovingPose at;
  parallel::Workers workers(1);
  ScanMatches matches = random_matches(5, 60, 0, at.T_map_lidar);
  for (std::size_t i = 0; i < matches.planes.size(); ++i) {  // all planes face upward
    matches.planes.nx[i] = matches.planes.ny[i] = 0;
    matches.planes.nz[i] = 1;
  }
  const ObjectiveOptions options;
  const CondensedCost cost(matches, at.motion, options, workers);
  const Eigen::Quaterniond q = at.T_map_lidar.quaternion();
  const double* parameters[] = {q.coeffs().data(), at.T_map_lidar.translation.data()};
  Eigen::Matrix<double, 7, 1> r;
  EXPECT_TRUE(cost.Evaluate(parameters, r.data(), nullptr));
  EXPECT_TRUE(r.allFinite());
}

}  // namespace
}  // namespace traverse::voxel_map
