#include "traverse/geometry/trajectory.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace traverse::geometry {

Trajectory Trajectory::stamped(std::vector<Stamp> stamps, std::vector<Pose3> poses) {
  if (stamps.size() != poses.size()) {
    throw std::invalid_argument("a stamped trajectory needs one stamp a pose");
  }
  Trajectory trajectory;
  trajectory.stamps_ = std::move(stamps);
  trajectory.poses_ = std::move(poses);
  return trajectory;
}

Trajectory Trajectory::unstamped(std::vector<Pose3> poses) {
  Trajectory trajectory;
  trajectory.stamped_ = false;
  trajectory.poses_ = std::move(poses);
  return trajectory;
}

void Trajectory::push_back(Stamp stamp, const Pose3& T_map_body) {
  if (!stamped_) throw std::logic_error("a trajectory without stamps takes no stamped pose");
  stamps_.push_back(stamp);
  poses_.push_back(T_map_body);
}

double Trajectory::path_length() const {
  const std::vector<double> distances = accumulated_distances();
  return distances.empty() ? 0 : distances.back();
}

std::vector<double> Trajectory::accumulated_distances() const {
  std::vector<double> distances;
  distances.reserve(size());
  for (std::size_t i = 0; i < size(); ++i) {
    distances.push_back(
        i == 0 ? 0 : distances.back() + (poses_[i].translation - poses_[i - 1].translation).norm());
  }
  return distances;
}

std::optional<Pose3> Trajectory::at(Stamp stamp, double longest_gap_seconds) const {
  if (!stamped_ || empty() || stamp < stamps_.front() || stamp > stamps_.back()) {
    return std::nullopt;
  }
  const auto after = std::lower_bound(stamps_.begin(), stamps_.end(), stamp);
  const auto i = static_cast<std::size_t>(after - stamps_.begin());
  if (stamps_[i] == stamp) return poses_[i];
  const double gap = seconds_between(stamps_[i - 1], stamps_[i]);
  if (gap > longest_gap_seconds) return std::nullopt;
  return interpolate(poses_[i - 1], poses_[i], seconds_between(stamps_[i - 1], stamp) / gap);
}

Trajectory Trajectory::transformed_left(const Pose3& T_new_map) const {
  Trajectory result = *this;
  for (Pose3& pose : result.poses_) pose = T_new_map * pose;
  return result;
}

Trajectory Trajectory::transformed_right(const Pose3& T_body_new) const {
  Trajectory result = *this;
  for (Pose3& pose : result.poses_) pose = pose * T_body_new;
  return result;
}

}  // namespace traverse::geometry
