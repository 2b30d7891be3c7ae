#include "traverse/slam/keyframe_maker.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "traverse/geometry/angle.hpp"
#include "traverse/geometry/so3.hpp"
#include "traverse/geometry/voxel_set.hpp"
#include "traverse/parallel/workers.hpp"
#include "traverse/sensors/rings.hpp"
#include "traverse/sensors/sweep_timing.hpp"
#include "traverse/voxel_map/local_points.hpp"

namespace traverse::slam {

namespace {

double weakest_information(const lidar::RegistrationHealth& health) {
  return health.observability.eigenvalues[0] * static_cast<double>(health.matches());
}

KeyframePoints thinned(const sensors::LidarScan& scan, const lidar::CorrectedScan& used,
                       const sensors::LidarProfile& profile, double cube_m) {
  KeyframePoints points;
  geometry::VoxelSet voxels(cube_m);
  const auto intensity_scale = static_cast<float>(1 / profile.intensity_full_scale);
  const sensors::PointClock clock(scan, profile);
  const std::vector<std::uint16_t> rings = sensors::rings_if_known(scan, profile);
  for (std::size_t i = 0; i < used.x.size(); ++i) {
    if (!voxels.insert({used.x[i], used.y[i], used.z[i]})) continue;
    points.x.push_back(used.x[i]);
    points.y.push_back(used.y[i]);
    points.z.push_back(used.z[i]);
    const std::uint32_t source = used.source[i];
    if (!scan.intensity.empty()) {
      points.intensity.push_back(scan.intensity[source] * intensity_scale);
    }
    if (clock.knows()) points.time.push_back(clock(source));
    if (!rings.empty()) points.ring.push_back(rings[source]);
  }
  return points;
}

void deskew(voxel_map::SweepPoints& points, const geometry::Twist& velocity) {
  const voxel_map::SweepMotion motion(velocity);
  for (std::size_t i = 0; i < points.size(); ++i) {
    motion.apply(points.time[i], points.x[i], points.y[i], points.z[i]);
    points.time[i] = 0;
  }
}

}  // namespace

void bind(config::Binder& b, StepNoiseOptions& o) {
  using config::Range;
  b.number("inflation", o.inflation, Range::positive(),
           "factor on the covariance from the solver's information");
  b.number("drift_m_per_sqrt_m", o.drift_m_per_sqrt_m, Range::positive(),
           "random walk in addition, metres per square root of path length");
  b.number("drift_deg_per_sqrt_m", o.drift_deg_per_sqrt_m, Range::positive(),
           "random walk of the attitude, degrees per square root of path length");
  b.number("unregistered_m", o.unregistered_m, Range::non_negative(),
           "standard deviation added for every frame whose pose is only predicted");
  b.number("unregistered_deg", o.unregistered_deg, Range::non_negative(),
           "the same for the attitude");
}

void bind(config::Binder& b, KeyframeOptions& o) {
  using config::Range;
  b.number("spacing_m", o.spacing_m, Range::positive(), "distance between keyframes");
  b.number("spacing_deg", o.spacing_deg, Range::positive(), "rotation between keyframes");
  b.number("cube_m", o.cube_m, Range::positive(), "voxel size: one map point per voxel is kept");
  b.group("noise", "of the motion between keyframes", [&](config::Binder& g) { bind(g, o.noise); });
  b.group("sampling", "points that keyframes are registered by",
          [&](config::Binder& g) { bind(g, o.sampling); });
}

KeyframeMaker::KeyframeMaker(const KeyframeOptions& options, const sensors::LidarProfile& profile)
    : options_(options), profile_(profile) {}

bool KeyframeMaker::observe(const lidar::Frame& frame) {
  if (made_ == 0) return true;
  if (!frame.health.registered) {
    ++unregistered_;
  } else if (!weakest_ || weakest_information(frame.health) < weakest_information(*weakest_)) {
    weakest_ = frame.health;
  }
  const geometry::Pose3 motion = T_odom_last_.inverse() * frame.T_map_lidar;
  return motion.translation.norm() >= options_.spacing_m ||
         geometry::angle_of(motion.rotation) >= options_.spacing_deg * geometry::kDegree;
}

Keyframe KeyframeMaker::make(const lidar::Frame& frame, const sensors::LidarScan& scan,
                             const lidar::CorrectedScan& points, bool deskewed_by_velocity) {
  parallel::Workers alone(1);
  Keyframe keyframe;
  keyframe.id = made_++;
  keyframe.stamp = frame.stamp;
  keyframe.T_odom_lidar = frame.T_map_lidar;
  keyframe.points = thinned(scan, points, profile_, options_.cube_m);
  keyframe.features = deskewed(sample_sweep(scan, profile_, options_.sampling, alone),
                               deskewed_by_velocity ? frame.velocity : geometry::Twist::Zero());
  keyframe.health = frame.health;
  if (keyframe.id > 0) {
    keyframe.step_covariance = step_covariance(T_odom_last_.inverse() * frame.T_map_lidar);
  }
  T_odom_last_ = frame.T_map_lidar;
  weakest_.reset();
  unregistered_ = 0;
  return keyframe;
}

geometry::Matrix6 KeyframeMaker::step_covariance(const geometry::Pose3& T_i_j) const {
  const StepNoiseOptions& noise = options_.noise;
  const double way_m = std::max(T_i_j.translation.norm(), 0.1 * options_.spacing_m);
  const double turn = noise.drift_deg_per_sqrt_m * geometry::kDegree * std::sqrt(way_m);
  const double shift = noise.drift_m_per_sqrt_m * std::sqrt(way_m);
  geometry::Matrix6 covariance = geometry::Matrix6::Zero();
  covariance.diagonal().head<3>().setConstant(turn * turn);
  covariance.diagonal().tail<3>().setConstant(shift * shift);
  if (weakest_) covariance += noise.inflation * weakest_->covariance();
  const double lost_turn = noise.unregistered_deg * geometry::kDegree * unregistered_;
  const double lost_shift = noise.unregistered_m * unregistered_;
  covariance.diagonal().head<3>().array() += lost_turn * lost_turn;
  covariance.diagonal().tail<3>().array() += lost_shift * lost_shift;
  // The translation of a step is told in the axes of the keyframe before.
  geometry::Matrix6 axes = geometry::Matrix6::Identity();
  axes.bottomRightCorner<3, 3>() = T_i_j.rotation;
  return axes * covariance * axes.transpose();
}

voxel_map::SweepSample deskewed(voxel_map::SweepSample sample, const geometry::Twist& velocity) {
  for (auto* points : {&sample.surface, &sample.planar, &sample.edges}) deskew(*points, velocity);
  sample.edges.step_variance.clear();  // files and spilled keyframes do not hold it
  return sample;
}

}  // namespace traverse::slam
