#include "probed_path.hpp"

#include "traverse/geometry/so3.hpp"

namespace traverse::app {

void ProbedPath::add(const geometry::Pose3& T_map_body) {
  // Less than this is an odometry's noise, not a motion: it is added to what comes next.
  constexpr double kStep_m = 0.3;
  constexpr double kStep = 0.03;  // rad
  ++frames_;
  if (!last_) last_ = T_map_body;
  const geometry::Pose3 step = last_->inverse() * T_map_body;
  const double angle = geometry::log_so3(step.rotation).norm();
  if (step.translation.norm() < kStep_m && angle < kStep) return;
  length_m_ += step.translation.norm();
  turned_ += angle;
  last_ = T_map_body;
}

bool ProbedPath::is_enough(bool has_others) const {
  constexpr std::size_t kLeastFrames = 60;  // a few seconds' work
  constexpr std::size_t kMostFrames = 300;
  // More than the checks ask for that hold fixes, wheels and an IMU against a path.
  constexpr double kLength_m = 30;
  constexpr double kTurn = 1.5;  // rad
  const bool is_told = !has_others || (length_m_ >= kLength_m && turned_ >= kTurn);
  return frames_ >= (is_told ? kLeastFrames : kMostFrames);
}

}  // namespace traverse::app
