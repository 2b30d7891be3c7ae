#include "trajectories/quaternion_order.hpp"

#include <algorithm>

#include <Eigen/Geometry>
#include <fmt/format.h>

namespace traverse::dataset {

namespace {

Eigen::Quaterniond rotation_from(const Eigen::Vector4d& columns, bool is_w_first) {
  return is_w_first ? Eigen::Quaterniond(columns[0], columns[1], columns[2], columns[3])
                    : Eigen::Quaterniond(columns[3], columns[0], columns[1], columns[2]);
}

}  // namespace

void QuaternionOrder::add(const Eigen::Vector3d& p_map, const Eigen::Vector4d& columns) {
  if (seen_++ % every_ != 0) return;
  kept_.push_back({p_map, columns});
  if (kept_.size() < kMostKept) return;
  for (std::size_t i = 0; i < kept_.size() / 2; ++i) kept_[i] = kept_[2 * i];
  kept_.resize(kept_.size() / 2);
  every_ *= 2;
}

double QuaternionOrder::steadiness(bool is_w_first, std::size_t stride) const {
  Eigen::Vector3d sum_body = Eigen::Vector3d::Zero();
  double length = 0;
  for (std::size_t i = stride; i < kept_.size(); i += stride) {
    const Eigen::Vector3d step = kept_[i].p_map - kept_[i - stride].p_map;
    // Half way the body heads along the chord: the mean of the two rotations.
    Eigen::Quaterniond before = rotation_from(kept_[i - stride].columns, is_w_first);
    const Eigen::Quaterniond after = rotation_from(kept_[i].columns, is_w_first);
    if (before.dot(after) < 0) before.coeffs() = -before.coeffs();
    const Eigen::Quaterniond between(before.coeffs() + after.coeffs());
    sum_body += between.normalized().conjugate() * step;
    length += step.norm();
  }
  return length > 0 ? sum_body.norm() / length : 1;
}

std::optional<std::string> QuaternionOrder::hint(bool was_w_first) const {
  constexpr double kSteady = 0.9;
  constexpr double kUnsteady = 0.99;
  constexpr double kRatio = 0.25;  // of what is missing to perfectly steady
  constexpr std::size_t kFewestSteps = 6;
  double as_taken = 1;
  double otherwise = 0;
  for (std::size_t stride = 1; stride * kFewestSteps < kept_.size(); stride *= 2) {
    const double taken = steadiness(was_w_first, stride);
    const double other = steadiness(!was_w_first, stride);
    if (std::max(taken, other) < std::max(as_taken, otherwise) && stride > 1) continue;
    as_taken = taken;
    otherwise = other;
  }
  const bool is_other =
      otherwise > kSteady && as_taken < kUnsteady && 1 - otherwise < kRatio * (1 - as_taken);
  if (!is_other) return std::nullopt;
  constexpr const char* kWFirst = "w x y z";
  constexpr const char* kWLast = "x y z w";
  return fmt::format(
      "the quaternions were taken as {}, the order of this format, but look like {}: so the body "
      "keeps its direction of travel while it turns ({:.3f} of 1 against {:.3f})",
      was_w_first ? kWFirst : kWLast, was_w_first ? kWLast : kWFirst, otherwise, as_taken);
}

}  // namespace traverse::dataset
