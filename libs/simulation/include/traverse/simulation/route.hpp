#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "traverse/config/binder.hpp"
#include "traverse/simulation/uniform_spline.hpp"

namespace traverse::simulation {

/// Where the vehicle goes and how fast.
struct RouteSettings {
  std::vector<double> waypoints_m{0, 0, 100, 0};  ///< x and y by turns, in the map
  bool closed = false;                            ///< the last waypoint leads to the first
  int laps = 1;                                   ///< of a closed route
  double corner_radius_m = 12;                    ///< of the arcs that replace the corners

  double speed_mps = 10;           ///< where no corner asks for less
  double acceleration_mps2 = 1.5;  ///< the most, forwards
  double braking_mps2 = 2;
  double lateral_mps2 = 2;      ///< the most in corners
  double jerk_mps3 = 2;         ///< the most, along the road
  std::vector<double> stops_m;  ///< metres along each lap where it halts
  double stop_s = 3;            ///< how long
  double standstill_s = 2;      ///< before the start and after the end
  double wander_m = 0.5;        ///< the most that another drive keeps beside this line
};
void bind(config::Binder& binder, RouteSettings& settings);

/// A route that cannot be driven.
class ImpossibleRoute : public std::runtime_error {
 public:
  /// `key` of the settings is the one to change.
  ImpossibleRoute(std::string key, std::string expected, std::string found);

  std::string key, expected, found;
};

/// The curve that the middle of the rear axle follows, by `s`, its length on straights (in corners
/// the curve is up to a few per cent shorter). The heading is the curve's tangent, so the vehicle
/// never slides sideways, and it is known at a standstill.
class Route {
 public:
  /// \param other_drive seed of the line that another driver keeps beside this one, the same in
  ///        each lap; nothing: exactly this one
  /// \throws ImpossibleRoute
  explicit Route(const RouteSettings& settings, std::optional<std::uint64_t> other_drive = {});

  double lap_m() const { return lap_m_; }
  double length_m() const { return length_m_; }  ///< all laps

  /// Point and tangent (not of unit length) where `s` moves. Beyond the ends of an open route the
  /// road goes straight on.
  struct Place {
    Jet x, y, tangent_x, tangent_y;
  };
  Place at(const Jet& s) const;

  Eigen::Vector2d point(double s) const;
  double heading(double s) const;    ///< rad, counterclockwise from the x axis
  double curvature(double s) const;  ///< 1/m, left positive

 private:
  UniformSpline x_, y_;
  double begin_m_ = 0;  ///< of the road, before s = 0
  double lap_m_ = 0;
  double length_m_ = 0;
};

}  // namespace traverse::simulation
