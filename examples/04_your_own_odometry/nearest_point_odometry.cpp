#include "nearest_point_odometry.hpp"

#include <chrono>
#include <cmath>

#include "traverse/geometry/umeyama.hpp"
#include "traverse/geometry/voxel_set.hpp"
#include "traverse/lidar/deskew.hpp"
#include "traverse/optimization/termination.hpp"

using traverse::config::Range;
using traverse::geometry::Pose3;
namespace geometry = traverse::geometry;
namespace lidar = traverse::lidar;

void bind(traverse::config::Binder& binder, NearestPointOptions& options) {
  binder.group("map", "points to register on", [&](traverse::config::Binder& b) {
    b.number("voxel_m", options.voxel_m, Range::between(0.1, 10), "edge of a voxel, metres");
    b.number("radius_m", options.radius_m, Range::positive(),
             "points beyond are forgotten, metres");
  });
  binder.integer("iterations", options.iterations, Range::between(1, 1000),
                 "of association and alignment, at most");
}

NearestPointOdometry::NearestPointOdometry(const NearestPointOptions& options,
                                           const traverse::sensors::LidarProfile& profile,
                                           bool motion_compensated)
    : options_(options),
      profile_(profile),
      deskew_note_(lidar::deskew_note(true, profile, motion_compensated)) {}

lidar::CorrectedScan NearestPointOdometry::used_scan(const traverse::sensors::LidarScan& scan,
                                                     const geometry::Twist& velocity,
                                                     bool /*with_classes*/) const {
  const bool deskews = deskew_note_ == "on";
  return lidar::corrected(scan, profile_, deskews ? velocity : geometry::Twist::Zero());
}

std::vector<lidar::Frame> NearestPointOdometry::process(const traverse::sensors::LidarScan& scan) {
  const auto begin = std::chrono::steady_clock::now();
  lidar::Frame frame;
  frame.index = frames_;
  frame.stamp = scan.stamp;
  const double seconds = frames_ > 0 ? geometry::seconds_between(last_stamp_, scan.stamp) : 0;
  const Pose3 T_map_last = T_map_lidar_;
  T_map_lidar_ = T_map_last * geometry::exp_se3(seconds * velocity_);  // the prediction

  Points points = thinned(used_scan(scan, velocity_, false));
  if (frames_ > 0) {
    align(points, frame.health);
    const geometry::Twist motion = geometry::log_se3(T_map_last.inverse() * T_map_lidar_);
    if (seconds > 0) velocity_ = motion / seconds;
    points = thinned(used_scan(scan, velocity_, false));  // deskewed by what is known now
  }
  insert(points);

  frame.T_map_lidar = T_map_lidar_;
  frame.velocity = velocity_;
  frame.points = points.size();
  frame.map_points = map_.size();
  frame.ms.solve =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  last_stamp_ = scan.stamp;
  ++frames_;
  return {frame};
}

/// The first point of each voxel of the scan, in the order of the scan.
NearestPointOdometry::Points NearestPointOdometry::thinned(const lidar::CorrectedScan& scan) const {
  geometry::VoxelSet voxels(options_.voxel_m, scan.x.size());
  Points points;
  for (std::size_t i = 0; i < scan.x.size(); ++i) {
    const Eigen::Vector3d p(scan.x[i], scan.y[i], scan.z[i]);
    if (voxels.insert(p)) points.push_back(p);
  }
  return points;
}

const Eigen::Vector3d* NearestPointOdometry::nearest(const Eigen::Vector3d& p_map) const {
  const Eigen::Vector3d* best = nullptr;
  double squared = options_.voxel_m * options_.voxel_m;
  for (int dx = -1; dx <= 1; ++dx) {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dz = -1; dz <= 1; ++dz) {
        const Eigen::Vector3d cell = p_map + options_.voxel_m * Eigen::Vector3d(dx, dy, dz);
        const auto found = map_.find(geometry::voxel_key(cell, options_.voxel_m));
        if (found == map_.end() || (found->second - p_map).squaredNorm() >= squared) continue;
        best = &found->second;
        squared = (found->second - p_map).squaredNorm();
      }
    }
  }
  return best;
}

void NearestPointOdometry::align(const Points& points_lidar, lidar::RegistrationHealth& health) {
  using traverse::optimization::Termination;
  health.end(Termination::kIterationLimit);
  for (int i = 0; i < options_.iterations; ++i) {
    Points from;
    Points to;
    double sum = 0;
    for (const Eigen::Vector3d& p : points_lidar) {
      const Eigen::Vector3d p_map = T_map_lidar_ * p;
      const Eigen::Vector3d* partner = nearest(p_map);
      if (partner == nullptr) continue;
      from.push_back(p_map);
      to.push_back(*partner);
      sum += (p_map - *partner).squaredNorm();
    }
    if (from.size() < 10) {  // the pose stays the prediction, and the report says so
      health.end(Termination::kTooFewMatches);
      return;
    }
    const Pose3 step = geometry::umeyama(from, to, false).T_y_x;
    T_map_lidar_ = (step * T_map_lidar_).orthonormalised();
    health.registered = true;
    health.plane_matches = from.size();
    health.residual_rms_m = std::sqrt(sum / static_cast<double>(from.size()));
    health.inlier_share =
        static_cast<double>(from.size()) / static_cast<double>(points_lidar.size());
    health.steps = i + 1;
    if (geometry::log_se3(step).norm() < 1e-4) {
      health.end(Termination::kConverged);
      return;
    }
  }
}

void NearestPointOdometry::insert(const Points& points_lidar) {
  for (const Eigen::Vector3d& p : points_lidar) {
    const Eigen::Vector3d p_map = T_map_lidar_ * p;
    map_.emplace(geometry::voxel_key(p_map, options_.voxel_m), p_map);
  }
  std::erase_if(map_, [&](const auto& entry) {
    return (entry.second - T_map_lidar_.translation).norm() > options_.radius_m;
  });
}

std::vector<Eigen::Vector3d> NearestPointOdometry::local_map() const {
  Points points;
  for (const auto& [key, p_map] : map_) points.push_back(p_map);
  return points;
}
