#pragma once

#include <deque>
#include <optional>
#include <string>

#include "traverse/inertial/navigation.hpp"

#include "navigation/map_fix.hpp"

namespace traverse::inertial {

struct FirstState {
  NavState state;
  NavState::Tangent sigma;
  std::string note;
};

/// Finds the first state: level and biases from a stand-still or, in motion, level as the mean
/// specific force; heading and velocity from a fix with a heading or from two fixes; without fixes,
/// a stand-still begins a path that has only its own heading.
class NavigationStart {
 public:
  NavigationStart(const NavigationOptions& options, const Mounts& mounts, double gravity);

  void add(const sensors::ImuSample& sample);
  void add_wheels(geometry::Stamp stamp, double forward_mps);

  /// The state at the fix, or at a moment without one when fixes have not come for long enough.
  std::optional<FirstState> at_fix(const MapFix& fix);
  std::optional<FirstState> without_fix(geometry::Stamp now);

  /// Why there is none yet.
  std::string why_not() const;

 private:
  FirstState begin(geometry::Stamp stamp);

  StartOptions options_;
  GnssOptions gnss_;
  WheelOptions wheels_;
  Mounts mounts_;
  double gravity_;
  StandStillFinder finder_;
  std::optional<StandStill> last_still_;
  std::deque<sensors::ImuSample> recent_;
  std::deque<MapFix> fixes_;
  std::optional<geometry::Stamp> first_sample_;
  bool has_fix_ = false;
  double forward_mps_ = 0;
};

}  // namespace traverse::inertial
