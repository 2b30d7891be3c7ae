#include "traverse/inertial/stand_still.hpp"

#include <cmath>

#include <fmt/format.h>

#include "traverse/geometry/so3.hpp"

namespace traverse::inertial {

void bind(config::Binder& b, StandStillOptions& o) {
  using config::Range;
  b.number("seconds", o.seconds, Range::between(0.1, 60),
           "duration of the stand-still at the start");
  b.number("rate_std", o.rate_std, Range::positive(),
           "largest standard deviation of the angular rate, rad/s");
  b.number("force_std", o.force_std, Range::positive(),
           "largest standard deviation of the specific force, m/s^2");
  b.number("rate", o.rate, Range::positive(), "largest mean angular rate, rad/s");
  b.number("gravity_error", o.gravity_error, Range::positive(),
           "largest difference between the mean specific force and gravity, m/s^2");
}

Eigen::Matrix3d levelled(const Eigen::Vector3d& up_body) {
  const Eigen::Vector3d up = up_body.normalized();
  const double roll = std::atan2(up.y(), up.z());
  const double pitch = std::atan2(-up.x(), std::hypot(up.y(), up.z()));
  return geometry::exp_so3({0, pitch, 0}) * geometry::exp_so3({roll, 0, 0});
}

StandStillFinder::StandStillFinder(const StandStillOptions& options, double gravity)
    : options_(options), gravity_(gravity) {}

void StandStillFinder::add(const sensors::ImuSample& sample) {
  window_.push_back(sample);
  while (geometry::seconds_between(window_.front().stamp, sample.stamp) > options_.seconds) {
    window_.pop_front();
  }
}

void StandStillFinder::add_wheels(geometry::Stamp stamp, bool are_turning) {
  if (are_turning) last_turning_ = stamp;
}

std::optional<StandStill> StandStillFinder::find() const { return judge().found; }

std::string StandStillFinder::why_not() const { return judge().why_not; }

StandStillFinder::Verdict StandStillFinder::judge() const {
  constexpr std::size_t kLeastSamples = 10;
  // The window is full when the next sample would push one out.
  const double covered =
      window_.size() < 2 ? 0
                         : geometry::seconds_between(window_.front().stamp, window_.back().stamp);
  if (window_.size() < kLeastSamples || covered < 0.9 * options_.seconds) {
    return {{},
            fmt::format("{:.2f} s of IMU readings, {} s are needed", covered, options_.seconds)};
  }
  if (last_turning_ && *last_turning_ > window_.front().stamp) {
    return {{}, fmt::format("the wheels turned less than {} s ago", options_.seconds)};
  }
  const auto count = static_cast<double>(window_.size());
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  for (const auto& sample : window_) {
    rate += sample.angular_rate / count;
    force += sample.specific_force / count;
  }
  Eigen::Vector3d rate_variance = Eigen::Vector3d::Zero();
  Eigen::Vector3d force_variance = Eigen::Vector3d::Zero();
  for (const auto& sample : window_) {
    rate_variance += (sample.angular_rate - rate).cwiseAbs2() / count;
    force_variance += (sample.specific_force - force).cwiseAbs2() / count;
  }
  const double rate_std = std::sqrt(rate_variance.maxCoeff());
  const double force_std = std::sqrt(force_variance.maxCoeff());
  const auto too_much = [](const char* what, double value, double most, const char* unit) {
    return Verdict{{}, fmt::format("{} {:.3g} {}, more than {:.3g}", what, value, unit, most)};
  };
  if (rate_std > options_.rate_std) {
    return too_much("the angular rate spreads by", rate_std, options_.rate_std, "rad/s");
  }
  if (force_std > options_.force_std) {
    return too_much("the specific force spreads by", force_std, options_.force_std, "m/s^2");
  }
  if (rate.norm() > options_.rate) {
    return too_much("the mean angular rate is", rate.norm(), options_.rate, "rad/s");
  }
  const double gravity_error = std::abs(force.norm() - gravity_);
  if (gravity_error > options_.gravity_error) {
    return too_much("the specific force differs from gravity by", gravity_error,
                    options_.gravity_error, "m/s^2");
  }
  return {StandStill{rate, force * (1 - gravity_ / force.norm()), rate_std / std::sqrt(count),
                     levelled(force)},
          ""};
}

}  // namespace traverse::inertial
