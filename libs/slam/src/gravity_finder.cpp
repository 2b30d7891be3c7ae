#include "traverse/slam/gravity_finder.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Dense>

namespace traverse::slam {

namespace {

constexpr double kGravity = 9.81;  // m/s^2; a hundredth more or less from place to place
constexpr std::size_t kLeastFrames = 5;
constexpr double kMostFrameGap_s = 0.45;  // how the vehicle turned in between is unknown

/// Seconds of the moments from the middle of their window.
Eigen::VectorXd times_of(const std::vector<OdometryMoment>& window) {
  const geometry::Stamp first = window.front().stamp;
  const double half = geometry::seconds_between(first, window.back().stamp) / 2;
  Eigen::VectorXd times(window.size());
  for (std::size_t i = 0; i < window.size(); ++i) {
    times[static_cast<Eigen::Index>(i)] = geometry::seconds_between(first, window[i].stamp) - half;
  }
  return times;
}

/// The c for which sum c_i p(t_i) is the second derivative of the parabola that fits p best.
Eigen::VectorXd acceleration_weights(const Eigen::VectorXd& times) {
  Eigen::MatrixXd powers(times.size(), 3);
  powers.col(0).setOnes();
  powers.col(1) = times;
  powers.col(2) = times.array().square() / 2;
  const Eigen::Matrix3d normal = powers.transpose() * powers;
  return powers * normal.inverse().col(2);
}

/// k(s) = sum c_i max(t_i - s, 0).
double kernel(const Eigen::VectorXd& weights, const Eigen::VectorXd& times, double s) {
  return weights.dot((times.array() - s).max(0).matrix());
}

Eigen::Vector3d acceleration_of(const Eigen::Vector3d& p_lidar,
                                const std::vector<OdometryMoment>& window,
                                const Eigen::VectorXd& weights) {
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < window.size(); ++i) {
    const geometry::Pose3& T_odom_lidar = window[i].T_odom_lidar;
    acceleration += weights[static_cast<Eigen::Index>(i)] * (T_odom_lidar * p_lidar);
  }
  return acceleration;
}

/// The average of readings and the standard deviation of what one differs from the next by.
class Average {
 public:
  void add(const Eigen::Vector3d& value, double weight) {
    sum_ += weight * value;
    weights_ += weight;
    squared_weights_ += weight * weight;
    if (count_++ > 0) steps_ += (value - last_).squaredNorm();
    last_ = value;
  }
  std::size_t count() const { return count_; }
  Eigen::Vector3d mean() const { return sum_ / weights_; }
  /// Of one axis of the mean: a step has three, each with twice the variance of a reading.
  double sigma() const {
    const double variance = steps_ / (6 * static_cast<double>(count_ - 1));
    return std::sqrt(variance * squared_weights_) / weights_;
  }

 private:
  Eigen::Vector3d sum_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d last_ = Eigen::Vector3d::Zero();
  double weights_ = 0, squared_weights_ = 0, steps_ = 0;
  std::size_t count_ = 0;
};

}  // namespace

void bind(config::Binder& b, GravityOptions& o) {
  using config::Range;
  b.number("window_s", o.window_s, Range::between(0.3, 60),
           "duration of driving on which one direction of gravity is measured");
  b.number("odometry_sigma_m", o.odometry_sigma_m, Range::positive(),
           "standard deviation of the odometry positions in it, each frame for itself");
  b.number("acceleration_share", o.acceleration_share, Range::non_negative(),
           "share of the vehicle's acceleration that is assumed to remain");
  b.number("min_sigma_deg", o.min_sigma_deg, Range::positive(),
           "smallest standard deviation of a direction that is used");
  b.number("max_gap_s", o.max_gap_s, Range::positive(),
           "longest gap between samples; slower IMUs do not see a vehicle's vibration");
  b.number("max_off_m_s2", o.max_off_m_s2, Range::positive(),
           "largest difference between the measured length and that of gravity");
}

GravityFinder::GravityFinder(const GravityOptions& options, const geometry::Pose3& T_lidar_imu)
    : options_(options), T_lidar_imu_(T_lidar_imu) {}

void GravityFinder::observe(const sensors::ImuSample& sample) {
  if (!sample.specific_force.allFinite()) return;
  if (!samples_.empty() && sample.stamp <= samples_.back().stamp) return;
  samples_.push_back(sample);
}

/// A window ends with the frame before the one that is added: by then its samples have come.
std::optional<MeasuredUp> GravityFinder::add(const lidar::Frame& frame) {
  std::optional<MeasuredUp> up;
  const bool is_full =
      !window_.empty() &&
      geometry::seconds_between(window_.front().stamp, window_.back().stamp) >= options_.window_s;
  if (is_full) {
    up = up_in_window();
    window_.erase(window_.begin(), window_.end() - 1);  // the next one begins where this one ends
  }
  const bool goes_on =
      !window_.empty() &&
      geometry::seconds_between(window_.back().stamp, frame.stamp) <= kMostFrameGap_s;
  if (!goes_on) window_.clear();
  // The first frame of a drive is where the map begins; later ones without registration are
  // guesses.
  if (frame.health.registered || frame.index == 0) {
    window_.push_back({frame.stamp, frame.T_map_lidar});
  } else {
    window_.clear();
  }
  forget_samples_before(window_.empty() ? frame.stamp : window_.front().stamp);
  return up;
}

/// All but the last: the first one used needs one before it.
void GravityFinder::forget_samples_before(geometry::Stamp stamp) {
  while (samples_.size() > 1 && samples_[1].stamp <= stamp) samples_.pop_front();
}

bool GravityFinder::samples_cover_window() const {
  geometry::Stamp covered = window_.front().stamp;
  for (const sensors::ImuSample& sample : samples_) {
    if (sample.stamp <= covered) continue;
    if (geometry::seconds_between(covered, sample.stamp) > options_.max_gap_s) return false;
    covered = sample.stamp;
    if (covered >= window_.back().stamp) return true;
  }
  return geometry::seconds_between(covered, window_.back().stamp) <= options_.max_gap_s;
}

std::optional<MeasuredUp> GravityFinder::up_in_window() {
  if (window_.size() < kLeastFrames) return std::nullopt;
  if (!samples_cover_window()) {
    ++with_gaps_;
    return std::nullopt;
  }
  const Eigen::VectorXd times = times_of(window_);
  const Eigen::VectorXd weights = acceleration_weights(times);
  const Eigen::Vector3d acceleration = acceleration_of(T_lidar_imu_.translation, window_, weights);

  // The kernel is zero at both ends of the window, so the trapezoids need no samples there.
  Average force;
  std::size_t after = 1;  // the moment of odometry after the sample
  for (std::size_t j = 1; j + 1 < samples_.size(); ++j) {
    const geometry::Stamp stamp = samples_[j].stamp;
    if (stamp <= window_.front().stamp) continue;
    if (stamp >= window_.back().stamp) break;
    while (window_[after].stamp < stamp) ++after;
    const OdometryMoment& from = window_[after - 1];
    const OdometryMoment& to = window_[after];
    const double share = geometry::seconds_between(from.stamp, stamp) /
                         geometry::seconds_between(from.stamp, to.stamp);
    const geometry::Pose3 T_odom_lidar =
        geometry::interpolate(from.T_odom_lidar, to.T_odom_lidar, share);
    const double seconds =
        geometry::seconds_between(samples_[j - 1].stamp, samples_[j + 1].stamp) / 2;
    const double s = times[0] + geometry::seconds_between(window_.front().stamp, stamp);
    force.add(T_odom_lidar.rotation * T_lidar_imu_.rotation * samples_[j].specific_force,
              kernel(weights, times, s) * seconds);
  }
  if (force.count() < kLeastFrames) return std::nullopt;

  const Eigen::Vector3d gravity = force.mean() - acceleration;
  const double sigma = std::hypot(force.sigma(), options_.odometry_sigma_m * weights.norm(),
                                  options_.acceleration_share * acceleration.norm());
  if (std::abs(gravity.norm() - kGravity) > options_.max_off_m_s2 + 3 * sigma) {
    ++turned_away_;
    return std::nullopt;
  }
  ++found_;
  const double least = options_.min_sigma_deg * std::numbers::pi / 180;
  return MeasuredUp{gravity.normalized(), std::max(least, sigma / kGravity)};
}

}  // namespace traverse::slam
