#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "traverse/statistics/quantile.hpp"

#include "checks/check.hpp"

namespace traverse::plausibility {

namespace {

// An accelerometer reads what holds it up against gravity, plus what accelerates it. At rest that
// is 9.78 to 9.83 m/s^2 anywhere on the ground. What vehicles, robots and people add goes all ways
// and is seldom large for long: to move the median length by a quarter, a body has to accelerate by
// three quarters of g (the grip of a tyre) half of the time.
constexpr double kGravity = 9.80665;
constexpr double kTolerance = 0.25;

constexpr std::array<CodeMeaning, 5> kGravityCodes{{
    {"imu_in_g",
     "The median length of the specific force, averaged over tenths of a second, is 1 "
     "within 25 % instead of 9.81 m/s^2: it is in units of g."},
    {"imu_in_mg", "The same with 1000: thousandths of g."},
    {"imu_increments",
     "The same with 9.81 m/s^2 times the interval between readings: they are "
     "increments of velocity."},
    {"imu_without_gravity",
     "The same with less than a quarter of g: gravity was taken out, as "
     "phones do for `linear acceleration`."},
    {"imu_gravity", "The same with any other length that is more than 25 % off 9.81 m/s^2."},
}};

struct ForceLength {
  double median = 0;
  double spread = 0;  // half of the interquartile range as a share of the median
  double seconds = 0;
};

std::optional<ForceLength> force_length(const ImuTrack& track) {
  constexpr double kMinSeconds = 1;
  std::vector<double> lengths;
  ForceLength force;
  track.push().for_each_piece([&](double t0, double t1, const Eigen::Vector3d& sum) {
    lengths.push_back(sum.norm() / (t1 - t0));
    force.seconds += t1 - t0;
  });
  if (force.seconds < kMinSeconds) return std::nullopt;
  force.median = statistics::quantile(lengths, 0.5);
  const double quartiles =
      statistics::quantile(lengths, 0.75) - statistics::quantile(lengths, 0.25);
  force.spread = force.median > 0 ? quartiles / 2 / force.median : 1;
  return force;
}

bool is_near(double value, double expected) { return std::abs(value / expected - 1) < kTolerance; }

Finding gravity_finding(const ForceLength& force, std::optional<double> interval_s,
                        const std::string& label) {
  Finding finding{"imu_gravity", Severity::kRefuse, label, {}, {}, {}};
  finding.figure = fmt::format(
      "the specific force has a median length of {:.3f} over {:.1f} s; "
      "{:.2f} m/s^2, gravity, expected",
      force.median, force.seconds, kGravity);
  finding.consequence =
      "What is left of it after taking gravity off would be integrated to metres within seconds";
  // Gravity stands still while accelerations come and go: a length that spreads is not of gravity.
  const bool is_steady = force.spread < kTolerance;
  if (is_steady && is_near(force.median, 1)) {
    finding.code = "imu_in_g";
    finding.figure += "; in units of g that is 1";
    finding.statement = "--recording imu.unit=g";
  } else if (is_steady && is_near(force.median, 1000)) {
    finding.code = "imu_in_mg";
    finding.figure += "; in thousandths of g that is 1000";
    finding.statement = "--recording imu.unit=mg";
  } else if (is_steady && interval_s && is_near(force.median, kGravity * *interval_s)) {
    finding.code = "imu_increments";
    finding.figure += fmt::format("; times the {:.4g} s between readings that is {:.3f}",
                                  *interval_s, kGravity * *interval_s);
    finding.statement = "--recording imu.unit=increment";
  } else if (force.median < kTolerance * kGravity) {
    finding.code = "imu_without_gravity";
    finding.figure += ", so that gravity was taken out or the unit is another";
    finding.consequence =
        "Up cannot be told without gravity, and taking it off again would be integrated to metres "
        "within seconds; record the specific force itself (not `linear acceleration`)";
  }
  return finding;
}

void look_at_gravity(const View& view, std::vector<Finding>& findings) {
  const Evidence& evidence = view.evidence;
  for (const auto& [label, track] : evidence.imus) {
    const auto force = force_length(track);
    if (!force || is_near(force->median, kGravity)) continue;
    findings.push_back(gravity_finding(*force, track.interval_s(), label));
  }
}

}  // namespace

const Check kImuGravity{kGravityCodes, look_at_gravity};

}  // namespace traverse::plausibility
