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
    {{"own", Pairing::kOwn}, {"alike", Pairing::kAlike}}};

void bind_common(Binder& b, NavigationOptions& o, bool with_length) {
  b.choice("trigger", o.trigger, kTriggers, "what makes a state");
  b.choice("pairing", o.pairing, kPairings,
           "two states by fixes and wheels: each by what made it, or both by what made the later");
  b.number("longest_step_s", o.longest_step_s, Range::positive(),
           "without a fix, after which the wheels make a state");
  b.number("longest_gap_s", o.longest_gap_s, Range::positive(),
           "of the IMU, after which navigation starts anew");
  b.number("gravity", o.gravity, Range::between(9, 10.5), "m/s^2, where no fix tells the latitude");
  b.group("imu", "how the IMU errs", [&](Binder& g) { bind(g, o.imu); });
  b.group("gnss", "what fixes are worth", [&](Binder& g) { bind(g, o.gnss); });
  b.group("wheels", "what wheels are worth", [&](Binder& g) { bind(g, o.wheels); });
  b.group("window", "the states that are solved for", [&](Binder& g) {
    if (with_length) bind_length(g, o.window);
    bind(g, o.window);
  });
  b.group("start", "how the first state is found", [&](Binder& g) { bind(g, o.start); });
  b.group("outage", "fixes withheld on purpose", [&](Binder& g) { bind(g, o.outage); });
}

}  // namespace

void bind(Binder& b, GnssOptions& o) {
  b.flag("use", o.use, "take fixes at all");
  b.choice("form", o.form, kGnssForms, "antenna's position and a heading, or the book's pose");
  b.number("horizontal_m", o.horizontal_m, Range::positive(),
           "standard deviation without one told");
  b.number("vertical_m", o.vertical_m, Range::positive(), "standard deviation without one told");
  b.flag("use_covariance", o.use_covariance, "take the covariance that a fix tells");
  b.flag("use_heading", o.use_heading, "take the heading of two antennas");
  b.number("heading_deg", o.heading_deg, Range::positive(), "standard deviation of a heading");
  b.number("bias_horizontal_m", o.bias_horizontal_m, Range::positive(),
           "standard deviation of what fixes err by for seconds on end, which is estimated");
  b.number("bias_vertical_m", o.bias_vertical_m, Range::positive(), "the same");
  b.number("bias_s", o.bias_s, Range::positive(), "time after which 1/e of that is left");
  b.number("latency_s", o.latency_s, Range::between(-1, 1),
           "a fix tells where the antenna was so long before its stamp");
  b.number("latency_sigma_s", o.latency_sigma_s, Range::positive(),
           "standard deviation of latency_s, which is estimated");
  b.number("latency_walk", o.latency_walk, Range::positive(), "of the latency, s a sqrt(s)");
  b.flag("gate", o.gate, "leave out fixes that chi-square finds too unlikely (0.1 %)");
  b.integer("max_rejected", o.max_rejected, Range::between(1, 100000),
            "fixes in a row; the next is taken, whatever it says");
  b.number("huber", o.huber, Range::non_negative(), "standard deviations; 0 for least squares");
}

void bind(Binder& b, WheelOptions& o) {
  b.flag("use", o.use, "constrain states by the wheels");
  b.choice("form", o.form, kWheelForms, "in the wheels' axes, or the book's in the map's");
  b.number("forward_mps", o.forward_mps, Range::positive(), "standard deviation of the speed");
  b.number("sideways_mps", o.sideways_mps, Range::positive(), "of slip to the side");
  b.number("upwards_mps", o.upwards_mps, Range::positive(), "of motion off the ground");
  b.number("scale", o.scale, Range::positive(), "standard deviation of the first scale");
  b.number("scale_walk", o.scale_walk, Range::positive(), "of the scale, a sqrt(s)");
  b.number("turn_deg", o.turn_deg, Range::positive(),
           "standard deviation of the pitch and yaw of the wheels' axes, which are estimated");
  b.number("turn_walk_deg", o.turn_walk_deg, Range::positive(), "of these, a sqrt(s)");
  b.flag("gate", o.gate, "leave out readings that chi-square finds too unlikely (0.1 %)");
  b.flag("zero_velocity", o.zero_velocity, "constrain velocity and gyro bias at stand-still");
  b.number("standing_s", o.standing_s, Range::positive(), "slower than standing_mps for so long");
  b.number("standing_mps", o.standing_mps, Range::positive(), "speed of standing wheels");
}

void bind_length(Binder& b, WindowOptions& o) {
  b.integer("states", o.states, Range::between(2, 1000), "at most");
  b.number("seconds", o.seconds, Range::non_negative(), "at most; 0 for any");
  b.choice("output", o.output, kOutputs,
           "which state is given out: at its own moment, or smoothed, when it leaves the window");
}

void bind(Binder& b, WindowOptions& o) {
  b.integer("iterations", o.iterations, Range::between(1, 100), "of Gauss-Newton, at most");
  b.number("converged_step", o.converged_step, Range::positive(), "of any unknown, SI units");
  b.flag("first_estimate_jacobians", o.first_estimate_jacobians,
         "derive at the point at which a state was marginalised onto");
  b.number("reintegrate_gyro", o.reintegrate_gyro, Range::positive(),
           "bias shift beyond which samples are integrated again, rad/s");
  b.number("reintegrate_accelerometer", o.reintegrate_accelerometer, Range::positive(),
           "the same, m/s^2");
}

void bind(Binder& b, StartOptions& o) {
  b.group("stand_still", "when a vehicle counts as standing",
          [&](Binder& g) { bind(g, o.stand_still); });
  b.number("course_m", o.course_m, Range::positive(), "way between two fixes that gives a heading");
  b.number("course_s", o.course_s, Range::positive(), "longest time between them");
  b.number("gnss_wait_s", o.gnss_wait_s, Range::non_negative(),
           "without a fix, after which a stand-still begins dead reckoning");
  b.number("tilt_deg", o.tilt_deg, Range::positive(), "deviation of roll and pitch, in motion");
  b.number("heading_deg", o.heading_deg, Range::positive(), "deviation of a heading from fixes");
  b.number("gyro_bias", o.gyro_bias, Range::positive(), "deviation, rad/s, started in motion");
  b.number("accelerometer_bias", o.accelerometer_bias, Range::positive(), "deviation, m/s^2");
}

void bind(Binder& b, OutageOptions& o) {
  b.numbers("spells_s", o.spells_s,
            "lengths of GNSS outages, for which fixes are withheld, seconds");
  b.number("first_s", o.first_s, Range::non_negative(), "from the start to the first");
  b.number("between_s", o.between_s, Range::non_negative(), "from the end of one to the next");
}

TwoFrameOptions::TwoFrameOptions() { window.states = 2; }

void bind(Binder& b, TwoFrameOptions& o) { bind_common(b, o, false); }
void bind(Binder& b, SlidingWindowOptions& o) { bind_common(b, o, true); }

}  // namespace traverse::inertial
