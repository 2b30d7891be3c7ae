#include "traverse/voxel_map/moments.hpp"

#include <random>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace traverse::voxel_map {
namespace {

/// Normally distributed points with the standard deviations `sigma` along random axes.
struct RandomCloud {
  Eigen::Matrix3d axes;
  std::vector<Eigen::Vector3d> points;

  RandomCloud(unsigned seed, int count, const Eigen::Vector3d& sigma,
              const Eigen::Vector3d& centre) {
    std::mt19937 generator(seed);
    std::normal_distribution<double> normal;
    const Eigen::Quaterniond q{normal(generator), normal(generator), normal(generator),
                               normal(generator)};
    axes = q.normalized().toRotationMatrix();
    for (int i = 0; i < count; ++i) {
      points.push_back(centre + axes * Eigen::Vector3d{sigma.x() * normal(generator),
                                                       sigma.y() * normal(generator),
                                                       sigma.z() * normal(generator)});
    }
  }

  Moments moments(const Eigen::Vector3d& origin) const {
    Moments sums;
    for (const Eigen::Vector3d& p : points) {
      const Eigen::Vector3f q = (p - origin).cast<float>();
      sums.add(q.x(), q.y(), q.z());
    }
    return sums;
  }
};

TEST(FitPlane, AgreesWithAnEigenDecomposition) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    const RandomCloud cloud(seed, 20 + static_cast<int>(seed), {0.15, 0.1, 0.01},
                            {0.1, -0.05, 0.08});
    const Moments moments = cloud.moments(Eigen::Vector3d::Zero());
    const auto plane = fit_plane(moments, {});
    ASSERT_TRUE(plane) << seed;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> truth(moments.covariance());
    EXPECT_NEAR(std::abs(truth.eigenvectors().col(0).dot(plane->normal.cast<double>())), 1, 1e-5);
    EXPECT_NEAR(plane->variance, truth.eigenvalues()[0], 1e-6);
    EXPECT_NEAR(plane->normal.cast<double>().dot(moments.mean()) + plane->offset, 0, 1e-6);
  }
}

TEST(FitPlane, RefusesWhatIsNoPlane) {
  const auto fits = [](const Eigen::Vector3d& sigma) {
    return fit_plane(RandomCloud(3, 40, sigma, {0, 0, 0}).moments(Eigen::Vector3d::Zero()), {})
        .has_value();
  };
  EXPECT_TRUE(fits({0.15, 0.1, 0.01}));
  EXPECT_FALSE(fits({0.15, 0.1, 0.09})) << "a ball";
  EXPECT_FALSE(fits({0.15, 0.005, 0.001})) << "points of one beam";
  EXPECT_FALSE(fits({2, 2, 0.3})) << "thick";
}

TEST(FitPlane, PointsExactlyInAPlaneAreOne) {
  Moments sums;
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 5; ++j)
      sums.add(0.1F * static_cast<float>(i), 0.1F * static_cast<float>(j), 0.2F);
  }
  const auto plane = fit_plane(sums, {});
  ASSERT_TRUE(plane);
  EXPECT_NEAR(std::abs(plane->normal.z()), 1, 1e-6);
  EXPECT_NEAR(std::abs(plane->offset), 0.2, 1e-6);
}

TEST(FitLine, TwoPlanesMeetInIt) {
  const RandomCloud cloud(7, 30, {0.2, 0.01, 0.01}, {0.05, 0.1, -0.1});
  const Moments moments = cloud.moments(Eigen::Vector3d::Zero());
  const auto line = fit_line(moments, {});
  ASSERT_TRUE(line);
  const Eigen::Vector3f direction = line->normal_1.cross(line->normal_2);
  EXPECT_NEAR(line->normal_1.dot(line->normal_2), 0, 1e-6);
  EXPECT_GT(std::abs(direction.cast<double>().dot(cloud.axes.col(0))), 0.999);
  const Eigen::Vector3f mean = moments.mean().cast<float>();
  EXPECT_NEAR(line->normal_1.dot(mean) + line->offset_1, 0, 1e-6);
  EXPECT_NEAR(line->normal_2.dot(mean) + line->offset_2, 0, 1e-6);
  EXPECT_FALSE(fit_line(
      RandomCloud(7, 30, {0.2, 0.15, 0.01}, {0, 0, 0}).moments(Eigen::Vector3d::Zero()), {}));
}

TEST(Moments, AreShiftedToAnotherOrigin) {
  const RandomCloud cloud(9, 30, {0.2, 0.1, 0.05}, {0.05, 0.1, -0.1});
  const Eigen::Vector3d origin(0.5, -0.25, 1);
  Moments shifted;
  shifted.add_shifted(cloud.moments(origin), 0.5F, -0.25F, 1);
  const Moments direct = cloud.moments(Eigen::Vector3d::Zero());
  EXPECT_TRUE(shifted.mean().isApprox(direct.mean(), 1e-5));
  EXPECT_TRUE(shifted.covariance().isApprox(direct.covariance(), 1e-3));
}

TEST(Moments, ForgettingKeepsMeanAndCovariance) {
  Moments sums = RandomCloud(9, 30, {0.2, 0.1, 0.05}, {0.05, 0.1, -0.1}).moments({0, 0, 0});
  const Eigen::Matrix3d covariance = sums.covariance();
  sums.forget_half();
  EXPECT_EQ(sums.n, 15);
  EXPECT_EQ(sums.covariance(), covariance);
}

}  // namespace
}  // namespace traverse::voxel_map
