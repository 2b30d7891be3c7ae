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

/// Finds the first state: level and biases from a stand-still, carried on by the gyro since, or, in
/// motion, level as the mean specific force; heading from two antennas, once two of their headings
/// agree, or from the course between two fixes, whatever the speed, once it is exact enough; a
/// velocity from fixes or wheels. Without fixes, a stand-still begins a path that has only its own
/// heading.
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
  struct Heading {
    double rad = 0;
    double sigma = 0;
    std::string note;
  };
  /// A fix and how far the gyro had turned by then.
  struct TurnedFix {
    MapFix fix;
    double yaw = 0;  ///< rad
  };
  FirstState begin(geometry::Stamp stamp);
  std::optional<Heading> antennas_heading() const;
  std::optional<Heading> course() const;
  std::optional<Heading> course_since(std::size_t first) const;
  double step_m(std::size_t first) const;
  bool is_level_by_still() const { return still_tilt_sigma() < most_tilt_sigma_; }
  double still_tilt_sigma() const;
  double gyro_bias_sigma() const;

  StartOptions options_;
  GnssOptions gnss_;
  WheelOptions wheels_;
  Mounts mounts_;
  double gravity_;
  StandStillFinder finder_;
  double gyro_density_;
  double most_tilt_sigma_;
  std::optional<StandStill> last_still_;
  Eigen::Quaterniond q_level_body_ = Eigen::Quaterniond::Identity();  ///< by the gyro since then
  double since_still_s_ = 0;
  std::deque<sensors::ImuSample> recent_;
  double yaw_ = 0;  ///< that the gyro has told since the first reading [rad]
  std::deque<TurnedFix> fixes_;
  std::optional<geometry::Stamp> first_sample_;
  bool has_fix_ = false;
  std::optional<double> forward_mps_;
};

}  // namespace traverse::inertial
