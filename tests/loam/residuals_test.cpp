#include "traverse/loam/residuals.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "geometry/random_motion.hpp"

namespace traverse::loam {
namespace {

using testing::RandomMotion;

constexpr double kStep = 1e-5;

Line random_line(RandomMotion& random) {
  return {random.vector(10), random.vector(1).normalized()};
}

TEST(LineVectorResidual, DerivativeMatchesDifferences) {
  RandomMotion random(1);
  for (int trial = 0; trial < 50; ++trial) {
    const Line line = random_line(random);
    const Eigen::Vector3d q = random.vector(10);
    Eigen::Matrix3d J;
    line_vector_residual(line, q, &J);
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d d = kStep * Eigen::Vector3d::Unit(k);
      const Eigen::Vector3d numeric =
          (line_vector_residual(line, q + d) - line_vector_residual(line, q - d)) / (2 * kStep);
      EXPECT_LT((J.col(k) - numeric).norm(), 1e-9);
    }
  }
}

TEST(LineVectorResidual, IsTheSlidesCrossProductInTheSlidesOrder) {
  // d = (q - b) x (q - a) / |a - b| equals u x (q - c) for u = (a - b) / |a - b|; exchanging the
  // factors flips residual and derivative together, mixing them is the sign trap.
  RandomMotion random(2);
  const Eigen::Vector3d a = random.vector(10);
  const Eigen::Vector3d b = random.vector(10);
  const Eigen::Vector3d q = random.vector(10);
  const Line line{a, (a - b).normalized()};
  const Eigen::Vector3d slide = (q - b).cross(q - a) / (a - b).norm();
  EXPECT_LT((line_vector_residual(line, q) - slide).norm(), 1e-12);
}

TEST(LineDistanceResidual, IsTheLengthOfTheVectorAndItsDerivativeMatchesDifferences) {
  RandomMotion random(3);
  for (int trial = 0; trial < 50; ++trial) {
    const Line line = random_line(random);
    const Eigen::Vector3d q = random.vector(10);
    Eigen::RowVector3d J;
    const double r = line_distance_residual(line, q, &J);
    EXPECT_NEAR(r, line_vector_residual(line, q).norm(), 1e-13);
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d d = kStep * Eigen::Vector3d::Unit(k);
      const double numeric =
          (line_distance_residual(line, q + d) - line_distance_residual(line, q - d)) / (2 * kStep);
      EXPECT_NEAR(J[k], numeric, 1e-8);
    }
  }
}

TEST(LineResiduals, HaveOneCostAndOneGradientButNotOneRank) {
  RandomMotion random(6);
  const Line line = random_line(random);
  const Eigen::Vector3d& u = line.direction;
  const Eigen::Vector3d q = random.vector(10);
  const Eigen::Vector3d from_line = q - line.point;
  const Eigen::Vector3d h = from_line - u.dot(from_line) * u;  // the perpendicular to the point
  Eigen::Matrix3d J;
  Eigen::RowVector3d j;
  const Eigen::Vector3d r = line_vector_residual(line, q, &J);
  const double d = line_distance_residual(line, q, &j);
  EXPECT_NEAR(r.squaredNorm(), d * d, 1e-12);
  EXPECT_LT((J.transpose() * r - j.transpose() * d).norm(), 1e-12);
  EXPECT_LT((J.transpose() * r - h).norm(), 1e-12);
  EXPECT_LT((j.transpose() - h.normalized()).norm(), 1e-12);
  EXPECT_LT((J.transpose() * J - (Eigen::Matrix3d::Identity() - u * u.transpose())).norm(), 1e-12);
  const auto rank = [](const Eigen::Matrix3d& M) { return M.fullPivLu().rank(); };
  EXPECT_EQ(rank(J.transpose() * J), 2);
  EXPECT_EQ(rank(j.transpose() * j), 1);
}

TEST(LineDistanceResidual, IsGuardedOnTheLineItself) {
  const Line line{{1, 2, 3}, {0, 0, 1}};
  Eigen::RowVector3d J;
  EXPECT_EQ(line_distance_residual(line, {1, 2, 7}, &J), 0);
  EXPECT_EQ(J, Eigen::RowVector3d::Zero());
}

TEST(PlaneResidual, IsSignedAndItsDerivativeIsTheNormal) {
  RandomMotion random(4);
  const Plane plane{random.vector(1).normalized(), random.uniform(-5, 5)};
  const Eigen::Vector3d on_plane = -plane.offset * plane.normal;
  Eigen::RowVector3d J;
  EXPECT_NEAR(plane_residual(plane, on_plane + 0.3 * plane.normal, &J), 0.3, 1e-14);
  EXPECT_NEAR(plane_residual(plane, on_plane - 0.3 * plane.normal), -0.3, 1e-14);
  EXPECT_EQ(J, plane.normal.transpose());
}

TEST(PlaneDistanceResidual, IsTheSignedOneFoldedAtZero) {
  RandomMotion random(5);
  for (int trial = 0; trial < 50; ++trial) {
    const Plane plane{random.vector(1).normalized(), random.uniform(-5, 5)};
    const Eigen::Vector3d q = random.vector(10);
    Eigen::RowVector3d J;
    Eigen::RowVector3d J_signed;
    const double r = plane_distance_residual(plane, q, &J);
    const double r_signed = plane_residual(plane, q, &J_signed);
    EXPECT_EQ(r, std::abs(r_signed));
    EXPECT_EQ(r * J, r_signed * J_signed);  // the same gradient of the cost
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d d = kStep * Eigen::Vector3d::Unit(k);
      const double numeric =
          (plane_distance_residual(plane, q + d) - plane_distance_residual(plane, q - d)) /
          (2 * kStep);
      EXPECT_NEAR(J[k], numeric, 1e-9);
    }
  }
  Eigen::RowVector3d J;
  EXPECT_EQ(plane_distance_residual({{0, 0, 1}, -2}, {5, 6, 2}, &J), 0);
  EXPECT_EQ(J, Eigen::RowVector3d(0, 0, 1)) << "at the kink the derivative from above";
}

}  // namespace
}  // namespace traverse::loam
