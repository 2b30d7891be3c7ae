#include "navigation/fix_scatter.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace traverse::inertial {

using geometry::seconds_between;

namespace {

double median_of(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

void FixScatter::add_motion(double seconds, const Eigen::Vector3d& dv_map) {
  p_ += seconds * (v_ + 0.5 * dv_map);
  v_ += dv_map;
}

void FixScatter::add(geometry::Stamp stamp, const Eigen::Vector3d& p_antenna_map,
                     const Eigen::Vector3d& arm_map) {
  constexpr std::size_t kPoints = 4;
  constexpr std::size_t kMost = 100;    // differences
  constexpr double kLeastStep = 0.095;  // s; closer fixes of a receiver err alike
  constexpr double kLongestStep = 2;    // s; over more the IMU's drift is no parabola
  if (!last_.empty()) {
    const double step = seconds_between(last_.back().stamp, stamp);
    if (step < kLeastStep) return;
    if (step > kLongestStep) last_.clear();
  }
  last_.push_back({stamp, p_antenna_map - arm_map - p_});
  if (last_.size() > kPoints) last_.pop_front();
  if (last_.size() < kPoints) return;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double squares = 0;
  for (std::size_t i = 0; i < kPoints; ++i) {
    double product = 1;
    for (std::size_t j = 0; j < kPoints; ++j) {
      if (j != i) product *= seconds_between(last_[j].stamp, last_[i].stamp);
    }
    sum += last_[i].e / product;
    squares += 1 / (product * product);
  }
  differences_.push_back(sum / std::sqrt(squares));
  if (differences_.size() > kMost) differences_.pop_front();
}

std::optional<FixScatter::Sigma> FixScatter::sigma() const {
  constexpr double kMedianOfNormal = 0.6745;  // of |x|, standard deviation 1
  // Multipath of a carrier's phase that is received well; less is a replay's rounding.
  constexpr double kLeastSigma = 0.005;
  if (differences_.size() < kLeast) return std::nullopt;
  std::vector<double> horizontal;
  std::vector<double> vertical;
  for (const Eigen::Vector3d& d : differences_) {
    horizontal.insert(horizontal.end(), {std::abs(d.x()), std::abs(d.y())});
    vertical.push_back(std::abs(d.z()));
  }
  return Sigma{std::max(kLeastSigma, median_of(horizontal) / kMedianOfNormal),
               std::max(kLeastSigma, median_of(vertical) / kMedianOfNormal)};
}

}  // namespace traverse::inertial
