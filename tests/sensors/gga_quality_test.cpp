#include "traverse/sensors/gga_quality.hpp"

#include <gtest/gtest.h>

namespace traverse::sensors {
namespace {

TEST(GgaQuality, SaysWhichPlacesWereMeasured) {
  for (const int quality : {1, 2, 3, 4, 5, 9}) EXPECT_TRUE(is_gga_fix(quality)) << quality;
  for (const int quality : {0, 6, 7, 8, -1}) EXPECT_FALSE(is_gga_fix(quality)) << quality;
}

TEST(GgaQuality, IsADeviationAndBack) {
  double last_m = 0;
  for (const int quality : {4, 5, 2, 1}) {  // from the best to the worst
    const auto covariance = covariance_of_gga_quality(quality);
    ASSERT_TRUE(covariance.has_value());
    EXPECT_GT((*covariance)(0, 0), last_m) << quality;
    last_m = (*covariance)(0, 0);
    EXPECT_EQ((*covariance)(2, 2), 4 * (*covariance)(0, 0)) << "twice as much in height";
    EXPECT_EQ(gga_quality_of(*covariance), quality);
  }
  for (const int quality : {0, 3, 6, 7, 8, 9}) {
    EXPECT_FALSE(covariance_of_gga_quality(quality).has_value()) << quality;
  }
  EXPECT_EQ(gga_quality_of(1e-6 * Eigen::Matrix3d::Identity()), 4);
  EXPECT_EQ(gga_quality_of(1e4 * Eigen::Matrix3d::Identity()), 1);
}

}  // namespace
}  // namespace traverse::sensors
