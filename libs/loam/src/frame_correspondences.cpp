#include "traverse/loam/frame_correspondences.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "traverse/loam/features.hpp"
#include "traverse/sensors/sweep_timing.hpp"

namespace traverse::loam {

namespace {

Line moved(const geometry::Pose3& T_b_a, const Line& line_a) {
  return {T_b_a * line_a.point, T_b_a.rotation * line_a.direction};
}

Plane moved(const geometry::Pose3& T_b_a, const Plane& plane_a) {
  const Eigen::Vector3d normal = T_b_a.rotation * plane_a.normal;
  return {normal, plane_a.offset - normal.dot(T_b_a.translation)};
}

/// The interval of the sweep in which the features were measured, seconds after the stamp.
struct Sweep {
  double begin = std::numeric_limits<double>::infinity();
  double end = -std::numeric_limits<double>::infinity();

  explicit Sweep(const ScanFeatures& features) {
    for (const auto* times : {&features.edges.time, &features.planar.time}) {
      for (const double time : *times) {
        begin = std::min(begin, time);
        end = std::max(end, time);
      }
    }
  }
  double duration() const { return end - begin; }
  double share(double time) const { return (time - begin) / duration(); }
};

/// Puts the points back to where they were measured and the shapes into the frame of the begin.
/// Without point times there is no sweep to speak of and nothing is made.
void make_swept(const ScanFeatures& features, const geometry::Twist& velocity,
                FrameCorrespondences& frame) {
  const Sweep sweep(features);
  if (!features.timed || !(sweep.duration() > 0)) return;
  const geometry::Pose3 T_begin_map =
      (frame.guess_T_map_lidar * geometry::exp_se3(sweep.begin * velocity)).inverse();
  frame.guess_T_begin_end = geometry::exp_se3(sweep.duration() * velocity);
  frame.swept = frame.matches;
  const auto unskew = [&](auto& match, const lidar::TimedPoints& measured) {
    match.p_lidar = measured.point(match.feature);
    match.fraction = sweep.share(measured.time[match.feature]);
  };
  for (LineMatch& match : frame.swept.lines) {
    unskew(match, features.thin_edges);
    match.line = moved(T_begin_map, match.line);
  }
  for (PlaneMatch& match : frame.swept.planes) {
    unskew(match, features.thin_planar);
    match.plane = moved(T_begin_map, match.plane);
  }
}

}  // namespace

FrameCorrespondences correspondences_of_last(std::span<const sensors::LidarScan> scans,
                                             const sensors::LidarProfile& profile,
                                             bool motion_compensated,
                                             const ScanToMapOdometryOptions& options) {
  if (scans.size() < 2) {
    throw std::invalid_argument("correspondences need a scan and at least one before it");
  }
  ScanToMapOdometry odometry(options, profile, motion_compensated);
  std::vector<lidar::Frame> frames;
  const auto take = [&](const std::vector<lidar::Frame>& known) {
    frames.insert(frames.end(), known.begin(), known.end());
  };
  for (const sensors::LidarScan& scan : scans.first(scans.size() - 1)) take(odometry.process(scan));
  take(odometry.finish());

  const sensors::LidarScan& scan = scans.back();
  const lidar::ScanLines lines = lidar::organise(scan, profile);
  const ScanFeatures features = collect_features(
      scan, profile, lines, extract_features(lines, options.features), options.thinning);
  const lidar::Frame& last = frames.back();
  const double dt = sensors::scan_interval(last.stamp, scan.stamp, profile);

  FrameCorrespondences result;
  result.guess_T_map_lidar = last.T_map_lidar * geometry::exp_se3(dt * last.velocity);
  ScanToMap map = odometry.map();
  lidar::StageTimes ms;
  result.matches = map.align(features, result.guess_T_map_lidar, last.velocity, 1, ms).matches;
  if (odometry.deskew_note() == "on") make_swept(features, last.velocity, result);
  return result;
}

}  // namespace traverse::loam
