#pragma once

#include <random>

#include <Eigen/Core>

#include "traverse/geometry/pose3.hpp"
#include "traverse/geometry/so3.hpp"

namespace traverse::testing {

/// Repeatable random vectors, rotations and poses, the same from every compiler: each draw is a
/// statement of its own or stands in braces, which alone have an order.
class RandomMotion {
 public:
  explicit RandomMotion(unsigned seed) : generator_(seed) {}

  double uniform(double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(generator_);
  }
  Eigen::Vector3d vector(double largest) {
    return {uniform(-largest, largest), uniform(-largest, largest), uniform(-largest, largest)};
  }
  /// A rotation vector with a random axis and an angle up to `largest_angle`.
  Eigen::Vector3d rotation_vector(double largest_angle) {
    const Eigen::Vector3d axis = vector(1).normalized();
    return uniform(0, largest_angle) * axis;
  }
  geometry::Pose3 pose(double largest_angle, double largest_translation) {
    return {geometry::exp_so3(rotation_vector(largest_angle)), vector(largest_translation)};
  }

 private:
  std::mt19937 generator_;
};

}  // namespace traverse::testing
