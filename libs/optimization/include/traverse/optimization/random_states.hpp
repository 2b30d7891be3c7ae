#pragma once

#include <cstdint>
#include <random>

#include <Eigen/Core>

namespace traverse::optimization {

/// Repeatable random numbers for the instances and states of factors that are checked.
class RandomStates {
 public:
  explicit RandomStates(std::uint32_t seed) : generator_(seed) {}

  double uniform(double least, double most);
  /// Uniform in a cube: each coordinate up to `largest` in size.
  Eigen::Vector3d vector(double largest);
  Eigen::Vector3d unit_vector();
  /// A unit quaternion [x y z w] about a random axis, with an angle up to `largest_angle`, radians.
  Eigen::Vector4d quaternion(double largest_angle);

 private:
  std::mt19937 generator_;
};

}  // namespace traverse::optimization
