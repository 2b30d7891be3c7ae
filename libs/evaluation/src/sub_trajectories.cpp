#include "traverse/evaluation/sub_trajectories.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "traverse/evaluation/path_figures.hpp"
#include "traverse/geometry/so3.hpp"

#include "require_matched.hpp"

namespace traverse::evaluation {

using geometry::Pose3;

namespace {

constexpr std::array<double, 5> kShares{0.1, 0.2, 0.3, 0.4, 0.5};
constexpr double kMostOffShare = 0.2;  // of the length
constexpr std::size_t kFewestStretches = 2;
constexpr double kDegrees = 180 / std::numbers::pi;

/// The pose at the end of the stretch from pose `first`; of equally near ones the first.
std::optional<std::size_t> end_of(const std::vector<double>& path_m, std::size_t first,
                                  double length_m) {
  const double target_m = path_m[first] + length_m;
  const auto begin = path_m.begin() + static_cast<std::ptrdiff_t>(first);
  auto best = std::lower_bound(begin, path_m.end(), target_m);
  const auto off_m = [&](auto at) { return std::abs(*at - target_m); };
  if (best != begin) {
    // The first pose of those at the last distance before the target.
    const auto before = std::lower_bound(begin, best, *(best - 1));
    if (best == path_m.end() || off_m(before) <= off_m(best)) best = before;
  }
  if (best == path_m.end() || !(off_m(best) < kMostOffShare * length_m)) return std::nullopt;
  return static_cast<std::size_t>(best - path_m.begin());
}

/// Of the errors over the stretches of one length.
struct Values {
  std::vector<double> translation_m;
  std::vector<double> translation_percent;
  std::vector<double> rotation_deg;
  std::vector<double> rotation_deg_per_m;
  std::vector<double> yaw_deg;
  std::vector<double> gravity_deg;
};

void add_error(const Pose3& E, const Eigen::Matrix3d& R_world_to, double length_m, Values& values) {
  values.translation_m.push_back(E.translation.norm());
  values.translation_percent.push_back(values.translation_m.back() / length_m * 100);
  values.rotation_deg.push_back(geometry::angle_of(E.rotation) * kDegrees);
  values.rotation_deg_per_m.push_back(values.rotation_deg.back() / length_m);
  // Z-Y-X angles of the error in the estimate's frame.
  const Eigen::Matrix3d R = R_world_to * E.rotation * R_world_to.transpose();
  const double yaw = std::atan2(R(1, 0), R(0, 0));
  const double pitch = std::atan2(-R(2, 0), std::hypot(R(0, 0), R(1, 0)));
  const double roll = std::atan2(R(2, 1), R(2, 2));
  values.yaw_deg.push_back(std::abs(yaw) * kDegrees);
  values.gravity_deg.push_back(std::hypot(pitch, roll) * kDegrees);
}

std::optional<SubTrajectoryErrors> errors_over(const Poses& estimate, const Poses& reference,
                                               const std::vector<double>& path_m, double scale,
                                               double length_m) {
  Values values;
  for (std::size_t first = 0; first < path_m.size(); ++first) {
    const auto last = end_of(path_m, first, length_m);
    if (!last) continue;
    const Pose3 to = estimate[*last].orthonormalised();
    Pose3 moved = estimate[first].orthonormalised().inverse() * to;
    moved.translation *= scale;
    const Pose3 truly =
        reference[first].orthonormalised().inverse() * reference[*last].orthonormalised();
    add_error(truly.inverse() * moved, to.rotation, length_m, values);
  }
  if (values.translation_m.size() < kFewestStretches) return std::nullopt;
  return SubTrajectoryErrors{length_m,
                             statistics_of(values.translation_m),
                             statistics_of(values.translation_percent),
                             statistics_of(values.rotation_deg),
                             statistics_of(values.rotation_deg_per_m),
                             statistics_of(values.yaw_deg),
                             statistics_of(values.gravity_deg)};
}

}  // namespace

std::vector<double> sub_trajectory_lengths(double path_m) {
  std::vector<double> lengths_m;
  for (const double share : kShares) {
    const double length_m = std::trunc(share * path_m * 100) / 100;
    if (length_m > 0) lengths_m.push_back(length_m);
  }
  return lengths_m;
}

std::vector<SubTrajectoryErrors> sub_trajectory_errors(const Poses& estimate,
                                                       const Poses& reference, double scale,
                                                       const std::vector<double>& lengths_m) {
  require_matched(estimate, reference);
  const std::vector<double> path_m = accumulated_distances(reference);
  std::vector<SubTrajectoryErrors> list;
  for (const double length_m : lengths_m) {
    if (!(length_m > 0)) throw std::invalid_argument("a sub-trajectory needs a length above zero");
    if (auto errors = errors_over(estimate, reference, path_m, scale, length_m)) {
      list.push_back(*errors);
    }
  }
  return list;
}

}  // namespace traverse::evaluation
