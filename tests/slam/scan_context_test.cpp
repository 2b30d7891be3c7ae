#include "traverse/slam/scan_context.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace traverse::slam {
namespace {

struct Cloud {
  std::vector<float> x, y, z;
};

/// Walls of different height at random places around the sensor.
Cloud place(unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<float> unit(0, 1);
  Cloud cloud;
  for (int wall = 0; wall < 60; ++wall) {
    const float azimuth = 6.28F * unit(generator);
    const float range = 3 + 70 * unit(generator);
    const float height = 8 * unit(generator);
    for (int i = 0; i < 200; ++i) {
      const float a = azimuth + 0.25F * unit(generator);
      cloud.x.push_back(range * std::cos(a));
      cloud.y.push_back(range * std::sin(a));
      cloud.z.push_back(-1.8F + height * unit(generator));
    }
  }
  return cloud;
}

/// The same seen from a sensor that is turned by `angle` and shifted by `ahead_m`.
Cloud seen_from(const Cloud& cloud, double angle, double ahead_m) {
  Cloud seen;
  const auto c = static_cast<float>(std::cos(angle));
  const auto s = static_cast<float>(std::sin(angle));
  for (std::size_t i = 0; i < cloud.x.size(); ++i) {
    const float x = cloud.x[i] - static_cast<float>(ahead_m);
    seen.x.push_back(c * x + s * cloud.y[i]);
    seen.y.push_back(-s * x + c * cloud.y[i]);
    seen.z.push_back(cloud.z[i]);
  }
  return seen;
}

ScanContext context_of(const Cloud& cloud) { return {cloud.x, cloud.y, cloud.z, {}}; }

TEST(ScanContext, TellsTheTurnOfAPlaceSeenAgain) {
  const Cloud cloud = place(1);
  const ScanContext first = context_of(cloud);
  for (const double turn : {0.0, 0.6, 2.0, -2.9}) {
    const auto match = ScanContext::compare(first, context_of(seen_from(cloud, turn, 0.5)));
    EXPECT_LT(match.distance, 0.3);
    const double off = std::remainder(match.turn_rad - turn, 2 * std::numbers::pi);
    EXPECT_LT(std::abs(off), 2 * std::numbers::pi / 60) << "turned by " << turn;
  }
}

TEST(ScanContext, RingKeyDoesNotKnowTheHeading) {
  const Cloud cloud = place(2);
  const double whole_sectors = 7 * 2 * std::numbers::pi / 60;
  const auto first = context_of(cloud).ring_key();
  const auto turned = context_of(seen_from(cloud, whole_sectors, 0)).ring_key();
  for (std::size_t ring = 0; ring < first.size(); ++ring) {
    EXPECT_NEAR(first[ring], turned[ring], 2.5F / 60) << "ring " << ring;
  }
}

TEST(ScanContext, OtherPlacesAreFarther) {
  const Cloud here = place(3);
  const double same =
      ScanContext::compare(context_of(here), context_of(seen_from(here, 1, 1))).distance;
  for (unsigned seed = 4; seed < 14; ++seed) {
    EXPECT_GT(ScanContext::compare(context_of(here), context_of(place(seed))).distance, same + 0.1);
  }
}

TEST(ScanContext, AnEmptyScanResemblesNothing) {
  EXPECT_EQ(ScanContext::compare(context_of({}), context_of(place(1))).distance, 1);
}

}  // namespace
}  // namespace traverse::slam
