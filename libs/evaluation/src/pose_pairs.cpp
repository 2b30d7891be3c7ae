#include "traverse/evaluation/pose_pairs.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>

#include "traverse/evaluation/path_figures.hpp"
#include "traverse/geometry/so3.hpp"

#include "names.hpp"

namespace traverse::evaluation {

using geometry::Pose3;
using Pairs = std::vector<IndexPair>;

namespace {

constexpr double kRelativeTolerance = 0.1;  // of the delta, for all pairs
constexpr double kMostFrames = 1e15;        // still a whole number as a double

double angle_between(const Pose3& a, const Pose3& b) {
  return geometry::angle_of(a.rotation.transpose() * b.rotation);
}

Pairs frame_pairs(std::size_t poses, std::size_t delta, std::size_t step) {
  Pairs pairs;
  if (delta < poses) pairs.reserve((poses - delta + step - 1) / step);
  for (std::size_t i = 0; i < poses && delta < poses - i; i += step)
    pairs.push_back({i, i + delta});
  return pairs;
}

Pairs consecutive_path_pairs(const Poses& poses, double delta_m) {
  Pairs pairs;
  std::optional<std::size_t> recorded;
  double path_m = 0;
  Eigen::Vector3d last = poses.empty() ? Eigen::Vector3d::Zero().eval() : poses[0].translation;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const Eigen::Vector3d here = poses[i].translation;
    path_m += (here - last).norm();
    last = here;
    if (path_m < delta_m) continue;
    if (recorded) pairs.push_back({*recorded, i});
    recorded = i;
    path_m = 0;
  }
  return pairs;
}

/// Path lengths do not decrease, so the pose nearest to `delta_m` is found by bisection.
Pairs all_path_pairs(const Poses& poses, double delta_m) {
  Pairs pairs;
  const std::vector<double> path_m = accumulated_distances(poses);
  for (auto from = path_m.begin(); from != path_m.end() && from + 1 != path_m.end(); ++from) {
    const auto surplus = [&](double length_m) { return length_m - *from - delta_m; };
    const auto first_with = [&](double min_surplus) {
      return std::partition_point(from + 1, path_m.end(),
                                  [&](double length_m) { return surplus(length_m) < min_surplus; });
    };
    auto to = first_with(0);
    if (to == path_m.end() || (to != from + 1 && -surplus(*(to - 1)) <= surplus(*to))) {
      to = first_with(surplus(*(to - 1)));  // the first of those that stand still
    }
    if (std::abs(surplus(*to)) <= delta_m * kRelativeTolerance) {
      pairs.push_back({static_cast<std::size_t>(from - path_m.begin()),
                       static_cast<std::size_t>(to - path_m.begin())});
    }
  }
  return pairs;
}

Pairs consecutive_angle_pairs(const Poses& poses, double delta_rad) {
  Pairs pairs;
  std::size_t start = 0;
  double angle_rad = 0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    angle_rad += angle_between(poses[i - 1], poses[i]);
    if (angle_rad < delta_rad) continue;
    pairs.push_back({start, i});
    start = i;
    angle_rad = 0;
  }
  return pairs;
}

/// Every two poses are looked at; those whose trace(R_i^T R_j) = 1 + 2 cos(angle) is clearly
/// outside cost nine products, only the others the exact angle.
Pairs all_angle_pairs(const Poses& poses, double delta_rad) {
  const double min_rad = delta_rad * (1 - kRelativeTolerance);
  const double max_rad = delta_rad * (1 + kRelativeTolerance);
  constexpr double kMargin = 0.05;  // the traces of matrices rounded to a few decimals are off
  const double max_trace = 1 + 2 * std::cos(min_rad) + kMargin;
  const double min_trace =
      max_rad < std::numbers::pi ? 1 + 2 * std::cos(max_rad) - kMargin : -1 - kMargin;
  std::vector<Eigen::Matrix3d> rotations;
  rotations.reserve(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) rotations.push_back(poses[i].rotation);
  Pairs pairs;
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    for (std::size_t j = i + 1; j < rotations.size(); ++j) {
      const double trace = rotations[i].cwiseProduct(rotations[j]).sum();
      if (trace < min_trace || trace > max_trace) continue;
      const double angle_rad = geometry::angle_of(rotations[i].transpose() * rotations[j]);
      if (angle_rad >= min_rad && angle_rad <= max_rad) pairs.push_back({i, j});
    }
  }
  return pairs;
}

}  // namespace

std::string_view name_of(DeltaUnit unit) { return name_in(kDeltaUnitNames, unit); }

bool Delta::is_valid() const {
  switch (unit) {
    case DeltaUnit::kFrames:
      return value >= 1 && value <= kMostFrames && value == std::floor(value);
    case DeltaUnit::kMetres:
      return value > 0 && std::isfinite(value);
    case DeltaUnit::kDegrees:
      return value >= 0 && value <= 180;
    case DeltaUnit::kRadians:
      return value >= 0 && value <= std::numbers::pi;
  }
  return false;
}

std::optional<Delta> parse_delta(std::string_view text) {
  Delta delta;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), delta.value);
  if (error != std::errc{}) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  const auto unit = value_in(kDeltaUnitNames, text);
  if (!unit) return std::nullopt;
  delta.unit = *unit;
  return delta.is_valid() ? std::optional(delta) : std::nullopt;
}

std::string to_text(const Delta& delta) {
  if (delta.unit != DeltaUnit::kFrames) {
    return fmt::format("{} {}", delta.value, name_of(delta.unit));
  }
  return fmt::format("{} frame{}", delta.value, delta.value == 1 ? "" : "s");
}

Pairs select_pairs(const Poses& poses, const Delta& delta, bool all_pairs) {
  if (!delta.is_valid()) throw std::invalid_argument("not a valid delta: " + to_text(delta));
  switch (delta.unit) {
    case DeltaUnit::kFrames: {
      const auto frames = static_cast<std::size_t>(delta.value);
      return frame_pairs(poses.size(), frames, all_pairs ? 1 : frames);
    }
    case DeltaUnit::kMetres:
      return all_pairs ? all_path_pairs(poses, delta.value)
                       : consecutive_path_pairs(poses, delta.value);
    case DeltaUnit::kDegrees:
    case DeltaUnit::kRadians: {
      const bool degrees = delta.unit == DeltaUnit::kDegrees;
      const double delta_rad = degrees ? delta.value * std::numbers::pi / 180 : delta.value;
      return all_pairs ? all_angle_pairs(poses, delta_rad)
                       : consecutive_angle_pairs(poses, delta_rad);
    }
  }
  return {};
}

}  // namespace traverse::evaluation
