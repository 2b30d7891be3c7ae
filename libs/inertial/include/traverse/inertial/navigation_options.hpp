#pragma once

#include <vector>

#include "traverse/config/binder.hpp"
#include "traverse/inertial/imu_noise.hpp"
#include "traverse/inertial/stand_still.hpp"

namespace traverse::inertial {

/// How a fix constrains a state: as what it is (the antenna's place, a heading of one dimension),
/// or as the book does (a whole pose at the body, where it has a heading).
enum class GnssForm { kPosition, kPose };
/// How wheels constrain a state: in their own axes with lever arm and scale, or as the book does
/// (a velocity in the map, turned there with the attitude that was predicted).
enum class WheelForm { kVelocity, kWorldVelocity };
/// What makes a state: each fix, or each fix and each reading of the wheels.
enum class Trigger { kGnss, kGnssAndWheels };
/// What constrains the two states of Trigger::kGnssAndWheels: each what made it, or both what made
/// the later one; the earlier one then by the line between two fixes, or by the wheels' speed less
/// what the IMU says that it changed by. The second takes measurements twice, at half their weight.
enum class Pairing { kOwn, kPaired };

struct GnssOptions {
  bool use = true;
  GnssForm form = GnssForm::kPosition;
  /// Standard deviations, where the fix has no covariance; 0: what the fixes scatter by.
  double horizontal_m = 0;
  double vertical_m = 0;
  bool use_covariance = true;  ///< of the fix, where it has one that is positive definite
  bool use_heading = true;
  double heading_deg = 0.3;
  /// Of roll and pitch in GnssForm::kPose, which a heading does not tell. A slope lasts for dozens
  /// of fixes, each of which calls it level in the same way: a road's 3 degrees, said a hundred
  /// times as if anew, weigh as those of one fix with sqrt(100) times the deviation.
  double tilt_deg = 30;
  /// The book's literal pose: level, whatever the estimate says; the antenna's place is moved to
  /// the body as if there were no slope, and heading, roll and pitch have the same deviation.
  bool level_pose = false;
  double bias_horizontal_m = 0.001;  ///< standard deviations of what fixes err by for long
  double bias_vertical_m = 0.001;
  double bias_s = 60;             ///< time after which a share of 1/e of that is left
  double latency_s = 0;           ///< a fix tells where the antenna was so long before its stamp
  double latency_sigma_s = 1e-4;  ///< standard deviation; what is left of it is estimated
  double latency_walk = 1e-5;     ///< s a sqrt(s)
  bool gate = true;               ///< leave out what chi-square finds too unlikely (0.1 %)
  /// Without a fix that is believed, seconds; those that were not are then judged together.
  double longest_rejection_s = 2;
  double huber = 3;  ///< standard deviations; 0 for plain least squares
};
void bind(config::Binder& binder, GnssOptions& options);

struct WheelOptions {
  bool use = true;
  WheelForm form = WheelForm::kVelocity;
  double forward_mps = 0.05;  ///< standard deviations
  double sideways_mps = 0.1;
  double upwards_mps = 0.1;
  double scale = 0.02;          ///< of the first scale, about 1
  double scale_walk = 1e-5;     ///< a sqrt(s)
  double turn_deg = 0.1;        ///< of the first pitch and yaw of the wheels' axes, about 0
  double turn_walk_deg = 1e-4;  ///< a sqrt(s)
  bool gate = true;
  bool zero_velocity = true;  ///< constrain velocity and gyro bias when they stand still
  double standing_s = 0.5;    ///< without a pulse, or slower than standing_mps
  double standing_mps = 0.01;
};
void bind(config::Binder& binder, WheelOptions& options);

/// Which estimate of a state is given out: that of its own moment, or that which it leaves the
/// window with, when all that came after has had its say.
enum class WindowOutput { kNewest, kOldest };

struct WindowOptions {
  int states = 10;
  double seconds = 0;  ///< 0: as many states as there are
  WindowOutput output = WindowOutput::kNewest;
  int iterations = 4;
  double converged_step = 1e-4;  ///< of any unknown, SI units
  bool first_estimate_jacobians = true;
  double reintegrate_gyro = 0.005;  ///< bias shift beyond which samples are integrated again, rad/s
  double reintegrate_accelerometer = 0.1;
};
/// The number of states, their time, and which of them is given out.
void bind_length(config::Binder& binder, WindowOptions& options);
/// The rest.
void bind(config::Binder& binder, WindowOptions& options);

/// What is known before anything moves, and how long to wait for it.
struct StartOptions {
  StandStillOptions stand_still;
  double course_m = 3;              ///< way between two fixes of unknown deviation for a heading
  double course_s = 5;              ///< longest time between them
  double gnss_wait_s = 10;          ///< without a fix; then the wheels and the IMU must do
  double tilt_deg = 3;              ///< standard deviation of roll and pitch, started in motion
  double heading_deg = 5;           ///< of a heading from two fixes, at least; what is surer starts
  double gyro_bias = 0.02;          ///< rad/s, started in motion
  double accelerometer_bias = 0.2;  ///< m/s^2
};
void bind(config::Binder& binder, StartOptions& options);

/// Spells for which fixes are kept back, to see what the estimate is worth without them.
struct OutageOptions {
  std::vector<double> spells_s;  ///< one after the other; empty: none
  double first_s = 20;           ///< from the start to the first
  double between_s = 20;         ///< from the end of one to the next
};
void bind(config::Binder& binder, OutageOptions& options);

struct NavigationOptions {
  Trigger trigger = Trigger::kGnss;
  Pairing pairing = Pairing::kOwn;
  double longest_step_s = 0.15;  ///< without a fix, after which the wheels make a state
  double longest_gap_s = 1;      ///< of the IMU, after which navigation starts anew
  double gravity = 9.80665;      ///< m/s^2, where no fix tells the latitude
  ImuNoise imu;
  GnssOptions gnss;
  WheelOptions wheels;
  WindowOptions window;
  StartOptions start;
  OutageOptions outage;
};

/// The book's estimator: two states, the constraints of each kept as long as it is one of them.
struct TwoFrameOptions : NavigationOptions {
  TwoFrameOptions();
};
void bind(config::Binder& binder, TwoFrameOptions& options);

/// A sliding window.
struct SlidingWindowOptions : NavigationOptions {};
void bind(config::Binder& binder, SlidingWindowOptions& options);

}  // namespace traverse::inertial
