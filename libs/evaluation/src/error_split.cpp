#include "traverse/evaluation/error_split.hpp"

#include <algorithm>
#include <cmath>

#include "require_matched.hpp"

namespace traverse::evaluation {

namespace {

using Eigen::Vector3d;

constexpr double kReach_m = 1;
constexpr std::size_t kFewestErrors = 20;

/// The mean direction of the body's up axis in the map of the reference.
Vector3d up_of(const Poses& reference) {
  Vector3d body_motion = Vector3d::Zero();
  Vector3d z_axis = Vector3d::Zero();
  Vector3d y_axis = Vector3d::Zero();
  Vector3d last = reference.front().translation;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const geometry::Pose3 pose = reference[i];
    body_motion += (pose.rotation.transpose() * (pose.translation - last)).cwiseAbs();
    z_axis += pose.rotation.col(2);
    y_axis += pose.rotation.col(1);
    last = pose.translation;
  }
  const bool is_camera = body_motion.z() > body_motion.x() && body_motion.z() > body_motion.y();
  const Vector3d up = is_camera ? Vector3d(-y_axis) : z_axis;
  return up.norm() > 0 ? Vector3d(up.normalized()) : Vector3d(Vector3d::UnitZ());
}

/// Directions of the path at one pose after the other.
class PathDirection {
 public:
  explicit PathDirection(const Poses& path) : path_(path) {}

  /// Unit vector, nothing where the path stays within reach on both sides. \param k never falls
  std::optional<Vector3d> at(std::size_t k) {
    const Vector3d here = place(k);
    find_before(k, here);
    find_after(k, here);
    const Vector3d come =
        is_far(before_, here) ? Vector3d(here - place(before_)) : Vector3d::Zero();
    const Vector3d go = is_far(after_, here) ? Vector3d(place(after_) - here) : Vector3d::Zero();
    // Where it turns round the two nearly cancel each other.
    const Vector3d along = (come + go).norm() > kReach_m / 2 ? Vector3d(come + go) : come;
    if (along.norm() < kReach_m / 2) return std::nullopt;
    return along.normalized();
  }

 private:
  /// The last pose before k out of reach. A path that goes back where it came from leaves the reach
  /// and comes into it again, so the search begins at k; where the vehicle stands for long it goes
  /// on from the one that was found last.
  void find_before(std::size_t k, const Vector3d& here) {
    for (std::size_t i = k; i > before_ && k - i < kMostSteps;) {
      if (!is_far(--i, here)) continue;
      before_ = i;
      return;
    }
    while (before_ > 0 && !is_far(before_, here)) --before_;
  }
  /// The first pose after k out of reach, in the same way.
  void find_after(std::size_t k, const Vector3d& here) {
    for (std::size_t i = k + 1; i < path_.size() && i - k < kMostSteps; ++i) {
      if (!is_far(i, here)) continue;
      after_ = i;
      return;
    }
    after_ = std::max(after_, k);
    while (after_ + 1 < path_.size() && !is_far(after_, here)) ++after_;
  }

  static constexpr std::size_t kMostSteps = 256;

  Vector3d place(std::size_t i) const { return path_[i].translation; }
  bool is_far(std::size_t i, const Vector3d& here) const {
    return (place(i) - here).norm() >= kReach_m;
  }

  const Poses& path_;
  std::size_t before_ = 0;
  std::size_t after_ = 0;
};

class PartSum {
 public:
  void add(double error_m) {
    squares_ += error_m * error_m;
    sum_ += error_m;
    largest_ = std::max(largest_, std::abs(error_m));
    ++count_;
  }
  ErrorPart part() const { return {std::sqrt(squares_ / count_), sum_ / count_, largest_}; }
  double count() const { return count_; }

 private:
  double squares_ = 0;
  double sum_ = 0;
  double largest_ = 0;
  double count_ = 0;
};

/// Of white noise on a smooth series the differences d from one value to the next have a covariance
/// of minus its variance with those after them, half as much as their own variance; of a value that
/// alternates strictly, minus all of it; of what drifts, none.
class Alternation {
 public:
  void add(double error_m) {
    if (last_) {
      const double difference = error_m - *last_;
      if (last_difference_) {
        products_ += difference * *last_difference_;
        ++pairs_;
      }
      squares_ += difference * difference;
      ++differences_;
      last_difference_ = difference;
    }
    last_ = error_m;
  }
  void interrupt() { last_ = last_difference_ = std::nullopt; }

  std::optional<double> deviation_m() const {
    if (pairs_ + 2 < kFewestErrors) return std::nullopt;
    const double variance = squares_ / static_cast<double>(differences_);
    const double covariance = products_ / static_cast<double>(pairs_);
    if (!(variance > 0) || covariance >= 0) return 0;
    const double correlation = std::min(1.0, -covariance / variance);
    return std::sqrt(correlation <= 0.5 ? -covariance : variance / (4 * correlation));
  }

 private:
  std::optional<double> last_;
  std::optional<double> last_difference_;
  double products_ = 0;
  double squares_ = 0;
  std::size_t pairs_ = 0;
  std::size_t differences_ = 0;
};

}  // namespace

bool ErrorSplit::alternates() const {
  if (!alternating_m) return false;
  const double all_m = std::hypot(along.rmse_m, across.rmse_m, up.rmse_m);
  return *alternating_m >= along.rmse_m / 2 && along.rmse_m >= all_m / 2 && all_m > 0;
}

std::optional<ErrorSplit> error_split(const Poses& estimate, const Poses& reference) {
  require_matched(estimate, reference);
  const Vector3d up_map = up_of(reference);
  PathDirection direction(reference);
  PartSum along, across, up;
  Alternation alternation;
  for (std::size_t k = 0; k < reference.size(); ++k) {
    const auto ahead = direction.at(k);
    const Vector3d left = ahead ? Vector3d(up_map.cross(*ahead)) : Vector3d::Zero();
    if (left.norm() < 0.1) {  // it stands, or goes straight up
      alternation.interrupt();
      continue;
    }
    const Vector3d error = estimate[k].translation - reference[k].translation;
    const Vector3d left_unit = left.normalized();
    along.add(error.dot(*ahead));
    across.add(error.dot(left_unit));
    up.add(error.dot(ahead->cross(left_unit)));
    alternation.add(error.dot(*ahead));
  }
  if (along.count() == 0) return std::nullopt;
  return ErrorSplit{along.part(), across.part(), up.part(), static_cast<std::size_t>(along.count()),
                    alternation.deviation_m()};
}

}  // namespace traverse::evaluation
