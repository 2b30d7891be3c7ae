#pragma once

#include <map>
#include <optional>
#include <string>

#include <Eigen/Core>

#include "traverse/geodesy/local_tangent_plane.hpp"
#include "traverse/inertial/navigation_options.hpp"
#include "traverse/sensors/gnss_fix.hpp"

#include "navigation/fix_scatter.hpp"

namespace traverse::inertial {

/// What was not used or not usual, by what it was.
using Events = std::map<std::string, std::size_t>;

/// A fix in the map frame.
struct MapFix {
  geometry::Stamp stamp;
  Eigen::Vector3d p_antenna_map = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();  ///< m^2
  bool is_sigma_known = true;  ///< false: nothing tells it yet, covariance is a guess
  /// What fixes whose deviation nobody tells may be off by for seconds beyond their scatter: when a
  /// receiver goes over from one set of ambiguities to another they step by a carrier's wavelength.
  double step_m = 0;
  std::optional<double> heading;  ///< of the body's x axis from east, counterclockwise [rad]
  double heading_sigma = 0;       ///< rad
};

/// Whether a fix tells a place; counts what it lacks.
bool is_place(const sensors::GnssFix& fix, Events& events);

/// A fix in the tangent plane, as exact as it says or, where it says nothing usable, as the options
/// do or, where they state nothing, as `scatter` does. \param baseline_angle  of two antennas from
/// the x axis [rad]
MapFix in_map(const sensors::GnssFix& fix, const geodesy::LocalTangentPlane& plane,
              const GnssOptions& options, double baseline_angle, const FixScatter& scatter,
              Events& events);

/// Between two fixes at a moment between them; without a heading.
MapFix interpolated(const MapFix& before, const MapFix& after, geometry::Stamp stamp);

}  // namespace traverse::inertial
