#include "traverse/optimization/random_states.hpp"

#include "traverse/geometry/so3.hpp"

namespace traverse::optimization {

double RandomStates::uniform(double least, double most) {
  return std::uniform_real_distribution<double>(least, most)(generator_);
}

Eigen::Vector3d RandomStates::vector(double largest) {
  const double x = uniform(-largest, largest);
  const double y = uniform(-largest, largest);
  const double z = uniform(-largest, largest);
  return {x, y, z};
}

Eigen::Vector3d RandomStates::unit_vector() {
  Eigen::Vector3d v;
  do {  // inside the ball, so that no direction is preferred, and not too near its centre
    v = vector(1);
  } while (v.squaredNorm() > 1 || v.squaredNorm() < 1e-4);
  return v.normalized();
}

Eigen::Vector4d RandomStates::quaternion(double largest_angle) {
  const double angle = uniform(0, largest_angle);
  return geometry::exp_quaternion(angle * unit_vector()).normalized().coeffs();
}

}  // namespace traverse::optimization
