#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "traverse/geometry/pose3.hpp"
#include "traverse/geometry/stamp.hpp"

namespace traverse::geometry {

/// A sequence of poses T_map_body, with a stamp each or, as in KITTI pose files, without.
class Trajectory {
 public:
  Trajectory() = default;
  /// \throws std::invalid_argument if the sizes differ.
  static Trajectory stamped(std::vector<Stamp> stamps, std::vector<Pose3> poses);
  static Trajectory unstamped(std::vector<Pose3> poses);

  bool is_stamped() const { return stamped_; }
  bool empty() const { return poses_.empty(); }
  std::size_t size() const { return poses_.size(); }

  const std::vector<Pose3>& poses() const { return poses_; }
  const Pose3& pose(std::size_t i) const { return poses_.at(i); }
  /// One a pose; empty when not is_stamped().
  const std::vector<Stamp>& stamps() const { return stamps_; }
  Stamp stamp(std::size_t i) const { return stamps_.at(i); }

  /// \throws std::logic_error if the trajectory has poses without stamps.
  void push_back(Stamp stamp, const Pose3& T_map_body);

  /// Sum of the distances between successive positions, metres.
  double path_length() const;
  /// Path length from the first pose to each, metres; the first is 0.
  std::vector<double> accumulated_distances() const;

  /// The pose at `stamp` at constant twist between its neighbours; nothing outside the span or
  /// where the neighbours are more than `longest_gap_seconds` apart. Stamps must not decrease.
  std::optional<Pose3> at(Stamp stamp, double longest_gap_seconds) const;

  /// Every pose multiplied from the left: T_new_body = T_new_map T_map_body (another map frame).
  Trajectory transformed_left(const Pose3& T_new_map) const;
  /// Every pose multiplied from the right: T_map_new = T_map_body T_body_new (another body frame).
  Trajectory transformed_right(const Pose3& T_body_new) const;

 private:
  bool stamped_ = true;
  std::vector<Stamp> stamps_;
  std::vector<Pose3> poses_;
};

}  // namespace traverse::geometry
