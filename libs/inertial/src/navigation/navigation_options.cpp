#include "traverse/inertial/navigation_options.hpp"

#include <array>
#include <string_view>
#include <utility>

namespace traverse::inertial {

using config::Binder;
using config::Range;

namespace {

constexpr std::array<std::pair<std::string_view, GnssForm>, 2> kGnssForms{
    {{"position", GnssForm::kPosition}, {"pose", GnssForm::kPose}}};
constexpr std::array<std::pair<std::string_view, WheelForm>, 2> kWheelForms{
    {{"velocity", WheelForm::kVelocity}, {"world_velocity", WheelForm::kWorldVelocity}}};
constexpr std::array<std::pair<std::string_view, Trigger>, 2> kTriggers{
    {{"gnss", Trigger::kGnss}, {"gnss_and_wheels", Trigger::kGnssAndWheels}}};

constexpr std::array<std::pair<std::string_view, WindowOutput>, 2> kOutputs{
    {{"newest", WindowOutput::kNewest}, {"oldest", WindowOutput::kOldest}}};
constexpr std::array<std::pair<std::string_view, Pairing>, 2> kPairings{
    {{"own", Pairing::kOwn}, {"paired", Pairing::kPaired}}};

void bind_common(Binder& b, NavigationOptions& o, bool with_length) {
  b.choice("trigger", o.trigger, kTriggers, "measurement that creates a state");
  b.choice("pairing", o.pairing, kPairings,
           "how two states are constrained: each by the measurement that created it, or both by "
           "that of the later one");
  b.number("longest_step_s", o.longest_step_s, Range::positive(),
           "time without a fix after which wheel odometry creates a state");
  b.number("longest_gap_s", o.longest_gap_s, Range::positive(),
           "longest gap between IMU samples; after a longer one navigation starts again");
  b.number("gravity", o.gravity, Range::between(9, 10.5),
           "m/s^2, used until a fix gives the latitude");
  b.group("imu", "noise of the IMU", [&](Binder& g) { bind(g, o.imu); });
  b.group("gnss", "noise and use of GNSS fixes", [&](Binder& g) { bind(g, o.gnss); });
  b.group("wheels", "noise and use of wheel odometry", [&](Binder& g) { bind(g, o.wheels); });
  b.group("window", "states of the sliding window", [&](Binder& g) {
    if (with_length) bind_length(g, o.window);
    bind(g, o.window);
  });
  b.group("start", "how the first state is found", [&](Binder& g) { bind(g, o.start); });
  b.group("outage", "GNSS outages: fixes withheld on purpose",
          [&](Binder& g) { bind(g, o.outage); });
}

}  // namespace

void bind(Binder& b, GnssOptions& o) {
  b.flag("use", o.use, "use GNSS fixes");
  b.choice("form", o.form, kGnssForms,
           "position of the antenna and heading, or the book's six-row pose");
  b.number("horizontal_m", o.horizontal_m, Range::non_negative(),
           "standard deviation where the fix has none; 0: by how much fixes scatter");
  b.number("vertical_m", o.vertical_m, Range::non_negative(),
           "standard deviation where the fix has none; 0: by how much fixes scatter");
  b.flag("use_covariance", o.use_covariance, "use the covariance of a fix where it has one");
  b.flag("use_heading", o.use_heading, "use the heading of a dual antenna");
  b.number("heading_deg", o.heading_deg, Range::positive(), "standard deviation of a heading");
  b.number("tilt_deg", o.tilt_deg, Range::positive(),
           "standard deviation of roll and pitch of the book's pose");
  b.flag("level_pose", o.level_pose,
         "the book's pose as it stands there: level, with heading_deg for roll and pitch too");
  b.number("bias_horizontal_m", o.bias_horizontal_m, Range::positive(),
           "standard deviation of the slowly varying error of fixes, which is estimated");
  b.number("bias_vertical_m", o.bias_vertical_m, Range::positive(), "the same");
  b.number("bias_s", o.bias_s, Range::positive(), "correlation time of that error, seconds");
  b.number("latency_s", o.latency_s, Range::between(-1, 1), "age of a fix at its stamp, seconds");
  b.number("latency_sigma_s", o.latency_sigma_s, Range::positive(),
           "standard deviation of latency_s, which is estimated");
  b.number("latency_walk", o.latency_walk, Range::positive(),
           "random walk of the latency, s/sqrt(s)");
  b.flag("gate", o.gate, "reject fixes by a chi-square test (0.1 %)");
  b.number("longest_rejection_s", o.longest_rejection_s, Range::positive(),
           "time without a fix that is believed, after which those rejected are judged together");
  b.number("huber", o.huber, Range::non_negative(),
           "Huber threshold in standard deviations; 0: least squares");
}

void bind(Binder& b, WheelOptions& o) {
  b.flag("use", o.use, "use wheel odometry");
  b.choice("form", o.form, kWheelForms,
           "residual in the axes of the wheels, or the book's in those of the map");
  b.number("forward_mps", o.forward_mps, Range::positive(), "standard deviation of the speed");
  b.number("sideways_mps", o.sideways_mps, Range::positive(),
           "standard deviation of the sideways speed");
  b.number("upwards_mps", o.upwards_mps, Range::positive(),
           "standard deviation of the vertical speed");
  b.number("scale", o.scale, Range::positive(), "standard deviation of the initial wheel scale");
  b.number("scale_walk", o.scale_walk, Range::positive(),
           "random walk of the wheel scale, 1/sqrt(s)");
  b.number("turn_deg", o.turn_deg, Range::positive(),
           "standard deviation of pitch and yaw of the axes of the wheels, which are estimated");
  b.number("turn_walk_deg", o.turn_walk_deg, Range::positive(),
           "random walk of these angles, deg/sqrt(s)");
  b.flag("gate", o.gate, "reject readings by a chi-square test (0.1 %)");
  b.flag("zero_velocity", o.zero_velocity, "constrain velocity and gyro bias at stand-still");
  b.number("standing_s", o.standing_s, Range::positive(),
           "time below standing_mps after which the vehicle stands");
  b.number("standing_mps", o.standing_mps, Range::positive(), "largest wheel speed at stand-still");
}

void bind_length(Binder& b, WindowOptions& o) {
  b.integer("states", o.states, Range::between(2, 1000), "at most");
  b.number("seconds", o.seconds, Range::non_negative(), "at most; 0 for any");
  b.choice("output", o.output, kOutputs,
           "which state is output: the newest, or the smoothed one that leaves the window");
}

void bind(Binder& b, WindowOptions& o) {
  b.integer("iterations", o.iterations, Range::between(1, 100), "Gauss-Newton iterations at most");
  b.number("converged_step", o.converged_step, Range::positive(),
           "largest step of any unknown at convergence, SI units");
  b.flag("first_estimate_jacobians", o.first_estimate_jacobians,
         "first-estimate Jacobians: linearise where the prior was linearised");
  b.number("reintegrate_gyro", o.reintegrate_gyro, Range::positive(),
           "change of the bias beyond which samples are integrated again, rad/s");
  b.number("reintegrate_accelerometer", o.reintegrate_accelerometer, Range::positive(),
           "the same, m/s^2");
}

void bind(Binder& b, StartOptions& o) {
  b.group("stand_still", "detection of stand-still", [&](Binder& g) { bind(g, o.stand_still); });
  b.number("course_m", o.course_m, Range::positive(),
           "distance between two fixes of unknown standard deviation that gives a heading");
  b.number("course_s", o.course_s, Range::positive(),
           "longest time between two fixes that give a heading");
  b.number("gnss_wait_s", o.gnss_wait_s, Range::non_negative(),
           "time without a fix after which dead reckoning starts from a stand-still");
  b.number("tilt_deg", o.tilt_deg, Range::positive(),
           "standard deviation of roll and pitch when started in motion");
  b.number("heading_deg", o.heading_deg, Range::positive(),
           "standard deviation of a heading from fixes, at least and, to start by it, at most");
  b.number("gyro_bias", o.gyro_bias, Range::positive(),
           "standard deviation when started in motion, rad/s");
  b.number("accelerometer_bias", o.accelerometer_bias, Range::positive(),
           "standard deviation, m/s^2");
}

void bind(Binder& b, OutageOptions& o) {
  b.numbers("spells_s", o.spells_s,
            "lengths of GNSS outages, for which fixes are withheld, seconds");
  b.number("first_s", o.first_s, Range::non_negative(), "time from the start to the first outage");
  b.number("between_s", o.between_s, Range::non_negative(),
           "time from the end of one outage to the next");
}

TwoFrameOptions::TwoFrameOptions() { window.states = 2; }

void bind(Binder& b, TwoFrameOptions& o) { bind_common(b, o, false); }
void bind(Binder& b, SlidingWindowOptions& o) { bind_common(b, o, true); }

}  // namespace traverse::inertial
