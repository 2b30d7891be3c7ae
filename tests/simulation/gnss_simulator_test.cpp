#include "traverse/simulation/gnss_simulator.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "traverse/geometry/angle.hpp"

#include "simulation/motion_settings.hpp"

namespace traverse::simulation {
namespace {

using Eigen::Vector3d;

/// A plain; from x = 40 m on under a roof.
Place plain_and_hall() {
  Place place;
  place.still.add_quad({-500, -500, -5}, {500, -500, -5}, {500, 500, -5}, {-500, 500, -5},
                       Material::kGrass);
  place.still.add_box(upright({90, 0, 3}, 0), {100, 200, 1}, Material::kConcrete);
  return place;
}

/// East, north and up of a fix by degrees and the ellipsoid's radii: good to millimetres here.
Vector3d local(const sensors::GnssFix& fix, const GnssSettings& s) {
  constexpr double a = 6378137, e2 = 0.00669437999014;
  const double sine = std::sin(s.latitude_deg * geometry::kDegree);
  const double n = a / std::sqrt(1 - e2 * sine * sine);
  const double m = a * (1 - e2) / std::pow(1 - e2 * sine * sine, 1.5);
  return {(fix.longitude_deg - s.longitude_deg) * geometry::kDegree * (n + s.altitude_m) *
              std::cos(s.latitude_deg * geometry::kDegree),
          (fix.latitude_deg - s.latitude_deg) * geometry::kDegree * (m + s.altitude_m),
          fix.altitude_m - s.altitude_m};
}

struct Errors {
  double rms = 0;
  std::size_t fixes = 0;
  double farthest_m = 0;
};

Errors errors_of(const GnssSettings& settings) {
  const VehicleMotion motion({}, {}, Terrain({}, 1), 1);  // 100 m straight east
  const Surroundings surroundings(plain_and_hall());
  GnssSimulator gnss(settings, surroundings, motion, 8);
  Errors errors;
  const auto count = static_cast<std::size_t>(motion.duration_s() * settings.rate_hz);
  for (std::size_t i = 0; i < count; ++i) {
    const auto fix = gnss.sample(i);
    if (!fix) continue;
    const double t = static_cast<double>(i) / settings.rate_hz;
    const MotionState antenna = motion.state(t).at(settings.mounting.T_body_sensor());
    errors.rms += (local(*fix, settings) - antenna.T_map_body.translation).squaredNorm();
    errors.farthest_m = antenna.T_map_body.translation.x();
    ++errors.fixes;
    EXPECT_NEAR(std::remainder(*fix->heading_deg - 90, 360), 0, 5 * settings.heading_noise_deg);
    EXPECT_GT((*fix->covariance_enu)(0, 0), 0);
  }
  errors.rms = std::sqrt(errors.rms / static_cast<double>(errors.fixes));
  return errors;
}

TEST(GnssSimulator, RtkIsAtTheAntennaWithinCentimetresAndLostUnderTheRoof) {
  const Errors errors = errors_of({});
  EXPECT_GT(errors.fixes, 20U);
  EXPECT_GT(errors.farthest_m, 35) << "the roof begins at 40 m";
  EXPECT_LT(errors.farthest_m, 55);
  EXPECT_LT(errors.rms, 0.2);
  EXPECT_GT(errors.rms, 0.005);
}

TEST(GnssSimulator, StandardPositionsAreMetresOffAndOutagesAreKept) {
  GnssSettings settings;
  settings.mode = GnssMode::kStandard;
  const Errors all = errors_of(settings);
  EXPECT_GT(all.rms, 0.3);
  EXPECT_LT(all.rms, 8);
  settings.outages_s = {0, 3};
  EXPECT_EQ(errors_of(settings).fixes, all.fixes - static_cast<std::size_t>(3 * settings.rate_hz));
}

TEST(GnssSimulator, TheOriginIsWhereTheSettingsSay) {
  const VehicleMotion motion({}, {}, Terrain({}, 1), 1);
  const Surroundings surroundings(plain_and_hall());
  const GnssSettings settings;
  const GnssSimulator gnss(settings, surroundings, motion, 1);
  const Vector3d origin = gnss.geodetic({0, 0, 0});
  EXPECT_NEAR(origin.x(), settings.latitude_deg, 1e-12);
  EXPECT_NEAR(origin.y(), settings.longitude_deg, 1e-12);
  EXPECT_NEAR(origin.z(), settings.altitude_m, 1e-6);
  EXPECT_GT(gnss.geodetic({0, 100, 0}).x(), origin.x());
  EXPECT_GT(gnss.geodetic({100, 0, 0}).y(), origin.y());
}

}  // namespace
}  // namespace traverse::simulation
