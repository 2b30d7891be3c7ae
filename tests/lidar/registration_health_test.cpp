#include "traverse/lidar/registration_health.hpp"

#include <gtest/gtest.h>

namespace traverse::lidar {
namespace {

using optimization::Termination;

/// A thousand planes and a hundred lines that see every direction alike, 3 cm off them.
RegistrationHealth good_health() {
  RegistrationHealth health;
  health.plane_matches = 1000;
  health.line_matches = 100;
  health.residual_rms_m = 0.03;
  health.observability.eigenvalues.setConstant(0.1);
  health.observability.rotation_scale_m = 10;
  return health;
}

TEST(RegistrationHealth, SaysWhyItEnded) {
  RegistrationHealth health;
  EXPECT_EQ(name_of(health.reason), "not run");
  EXPECT_FALSE(health.converged);
  health.end(Termination::kConverged);
  EXPECT_TRUE(health.converged);
  for (const auto& [name, reason] : optimization::kTerminationNames) {
    health.end(reason);
    EXPECT_EQ(name_of(health.reason), name);
    EXPECT_EQ(health.converged, reason == Termination::kConverged);
  }
}

TEST(RegistrationHealth, CovarianceIsRotationFirstInRadiansAndMetres) {
  const Matrix6 covariance = good_health().covariance();
  const double translation = 0.03 * 0.03 / (1100 * 0.1);  // m^2
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(covariance(k + 3, k + 3), translation, 1e-12);
    EXPECT_NEAR(covariance(k, k), translation / (10 * 10), 1e-15) << "seen at ten metres";
  }
}

TEST(RegistrationHealth, AnUndeterminedDirectionIsUncertain) {
  RegistrationHealth health = good_health();
  health.observability.directions.col(0).swap(health.observability.directions.col(3));  // along x
  health.observability.eigenvalues[0] = 1e-6;
  const Matrix6 covariance = health.covariance();
  EXPECT_GT(covariance(3, 3), 100 * covariance(4, 4));
  EXPECT_NEAR(covariance(4, 4), 0.03 * 0.03 / (1100 * 0.1), 1e-12);
}

TEST(RegistrationHealth, NeitherAPerfectFitNorNoneGivesAnInfiniteOne) {
  RegistrationHealth health = good_health();
  health.residual_rms_m = 0;
  EXPECT_NEAR(health.covariance()(3, 3), 0.01 * 0.01 / (1100 * 0.1), 1e-13);
  EXPECT_TRUE(RegistrationHealth{}.covariance().allFinite());
  EXPECT_GT(RegistrationHealth{}.covariance()(3, 3), 0.5) << "nothing is known";
}

}  // namespace
}  // namespace traverse::lidar
