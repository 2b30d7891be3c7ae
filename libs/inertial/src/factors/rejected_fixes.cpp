#include "factors/rejected_fixes.hpp"

namespace traverse::inertial {

using geometry::seconds_between;

void RejectedFixes::add(geometry::Stamp stamp, const Eigen::Vector3d& residual,
                        const Eigen::Matrix3d& covariance) {
  fixes_.push_back({stamp, residual, covariance});
}

std::optional<RejectedFixes::Line> RejectedFixes::line(double seconds) const {
  constexpr std::size_t kLeast = 4;  // two for the line, two for the scatter about it
  if (fixes_.size() < kLeast) return std::nullopt;
  const geometry::Stamp newest = fixes_.back().stamp;
  if (seconds_between(fixes_.front().stamp, newest) < seconds) return std::nullopt;
  // The last ones alone: what a curve or a step has left behind is none of the line's.
  std::size_t first = fixes_.size() - kLeast;
  while (first > 0 && seconds_between(fixes_[first - 1].stamp, newest) <= seconds) --first;
  const auto n = static_cast<double>(fixes_.size() - first);
  double st = 0;
  double stt = 0;
  Eigen::Vector3d sr = Eigen::Vector3d::Zero();
  Eigen::Vector3d str = Eigen::Vector3d::Zero();
  Eigen::Matrix3d R = Eigen::Matrix3d::Zero();
  for (std::size_t k = first; k < fixes_.size(); ++k) {
    const double t = seconds_between(newest, fixes_[k].stamp);
    st += t;
    stt += t * t;
    sr += fixes_[k].residual;
    str += t * fixes_[k].residual;
    R += fixes_[k].covariance / n;
  }
  const double det = n * stt - st * st;
  if (!(det > 0)) return std::nullopt;
  Line line;
  line.offset = (stt * sr - st * str) / det;
  line.slope = (n * str - st * sr) / det;
  Eigen::Vector3d scatter = Eigen::Vector3d::Zero();
  for (std::size_t k = first; k < fixes_.size(); ++k) {
    const double t = seconds_between(newest, fixes_[k].stamp);
    scatter += (fixes_[k].residual - line.offset - t * line.slope).cwiseAbs2() / (n - 2);
  }
  line.of_fix = R;
  line.of_fix.diagonal() = R.diagonal().cwiseMax(scatter);
  line.of_offset = stt / det * line.of_fix;
  line.of_slope = n / det * line.of_fix;
  return line;
}

}  // namespace traverse::inertial
