#pragma once

#include <optional>

#include <Eigen/Core>

namespace traverse::sensors {

/// Whether the quality code of an NMEA GGA sentence says that the place was measured: 0 is no fix,
/// 6 is dead reckoning, 7 a place that was typed in, 8 a simulator's. Source: NMEA 0183, GGA.
bool is_gga_fix(int quality);

/// How exact a fix of that code is, as its covariance in east, north, up [m^2]; nothing where the
/// code says nothing (3, 9 and beyond). Horizontally 0.02 m for fixed ambiguities (4), 0.3 m for
/// float ones (5), 1 m with differential corrections (2), 2 m for one receiver alone (1); twice
/// that in height. These are what such receivers err by, also for seconds on end, where the sky is
/// open: GGA's dilution of precision tells the satellites' geometry, not the surroundings.
std::optional<Eigen::Matrix3d> covariance_of_gga_quality(int quality);

/// The code that comes next to such a covariance: 4, 5, 2 or 1.
int gga_quality_of(const Eigen::Matrix3d& covariance_enu);

}  // namespace traverse::sensors
