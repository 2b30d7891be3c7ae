#include "traverse/evaluation/kitti_drift.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "traverse/evaluation/path_figures.hpp"

#include "require_matched.hpp"

namespace traverse::evaluation {

using geometry::Pose3;

namespace {

constexpr double kLengthTolerance_m = 1;
constexpr double kSpeedTolerance_mps = 2;  // wider than half the step: the bins overlap

Poses in_frame(const Poses& poses, const std::optional<Pose3>& T_body_frame) {
  if (!T_body_frame) return poses;
  return {poses.size(), [poses, T = *T_body_frame](std::size_t i) { return poses[i] * T; }};
}

/// The angle by the trace, as the devkit has it.
double angle_by_trace(const Eigen::Matrix3d& R) {
  return std::acos(std::clamp((R.trace() - 1) / 2, -1.0, 1.0));
}

KittiSegment segment_between(const Poses& estimate, const Poses& reference, std::size_t first,
                             std::size_t last, double length_m, double frame_seconds) {
  const Pose3 estimated_motion = estimate[first].inverse() * estimate[last];
  const Pose3 reference_motion = reference[first].inverse() * reference[last];
  const Pose3 E = estimated_motion.inverse() * reference_motion;
  KittiSegment segment{first, last, length_m, 0, 0, 0};
  segment.translation_percent = 100 * E.translation.norm() / length_m;
  segment.rotation_deg_per_m = angle_by_trace(E.rotation) / length_m * 180 / std::numbers::pi;
  segment.speed_mps = length_m / (frame_seconds * static_cast<double>(last - first + 1));
  return segment;
}

std::vector<KittiSegment> all_segments(const Poses& estimate, const Poses& reference,
                                       const KittiDriftOptions& options) {
  const std::vector<double> path_m = accumulated_distances(reference);
  std::vector<KittiSegment> segments;
  segments.reserve(((path_m.size() - 1) / options.step + 1) * kKittiLengths_m.size());
  for (std::size_t first = 0; first < path_m.size(); first += options.step) {
    for (const double length_m : kKittiLengths_m) {
      const auto end = std::upper_bound(path_m.begin(), path_m.end(), path_m[first] + length_m);
      if (end == path_m.end()) break;
      segments.push_back(segment_between(estimate, reference, first,
                                         static_cast<std::size_t>(end - path_m.begin()), length_m,
                                         options.frame_seconds));
    }
  }
  return segments;
}

/// The mean over the segments that `belongs` picks.
template <typename Predicate>
KittiBin mean_of(const std::vector<KittiSegment>& segments, double centre, Predicate belongs) {
  KittiBin bin{centre, 0, 0, 0};
  for (const KittiSegment& segment : segments) {
    if (!belongs(segment)) continue;
    ++bin.segments;
    bin.translation_percent += segment.translation_percent;
    bin.rotation_deg_per_m += segment.rotation_deg_per_m;
  }
  if (bin.segments > 0) {
    bin.translation_percent /= static_cast<double>(bin.segments);
    bin.rotation_deg_per_m /= static_cast<double>(bin.segments);
  }
  return bin;
}

template <std::size_t N>
std::vector<KittiBin> bins_of(const std::vector<KittiSegment>& segments,
                              const std::array<double, N>& centres, double KittiSegment::*quantity,
                              double tolerance) {
  std::vector<KittiBin> bins;
  for (const double centre : centres) {
    const KittiBin bin = mean_of(segments, centre, [&](const KittiSegment& segment) {
      return std::abs(segment.*quantity - centre) < tolerance;
    });
    if (bin.segments > 0) bins.push_back(bin);
  }
  return bins;
}

}  // namespace

std::optional<KittiDrift> kitti_drift(const Poses& estimate, const Poses& reference,
                                      const KittiDriftOptions& options) {
  require_matched(estimate, reference);
  if (options.step == 0 || !(options.frame_seconds > 0)) {
    throw std::invalid_argument("KITTI drift needs a step and a frame time above zero");
  }
  KittiDrift drift;
  drift.frame = options.T_body_camera ? options.camera_frame : options.body_frame;
  drift.T_body_camera = options.T_body_camera;
  drift.step = options.step;
  drift.frame_seconds = options.frame_seconds;
  drift.segments = all_segments(in_frame(estimate, options.T_body_camera),
                                in_frame(reference, options.T_body_camera), options);
  if (drift.segments.empty()) return std::nullopt;

  const KittiBin all = mean_of(drift.segments, 0, [](const KittiSegment&) { return true; });
  drift.translation_percent = all.translation_percent;
  drift.rotation_deg_per_m = all.rotation_deg_per_m;
  drift.by_length =
      bins_of(drift.segments, kKittiLengths_m, &KittiSegment::length_m, kLengthTolerance_m);
  drift.by_speed =
      bins_of(drift.segments, kKittiSpeeds_mps, &KittiSegment::speed_mps, kSpeedTolerance_mps);
  return drift;
}

}  // namespace traverse::evaluation
