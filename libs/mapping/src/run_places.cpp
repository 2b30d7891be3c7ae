#include "run_places.hpp"

#include <algorithm>
#include <utility>

#include <Eigen/Dense>

#include "traverse/geometry/voxel.hpp"
#include "traverse/slam/submap.hpp"

#include "surface_cubes.hpp"

namespace traverse::mapping {

namespace {

/// A map's points as the registration takes them: all make surfaces, those on flat patches are
/// registered, of each cube of a metre's quarter one. Ends of surfaces are not told by points
/// alone.
voxel_map::SweepSample features_of(const MapKeyframe& keyframe) {
  constexpr double kPatch_m = 0.2;    // fitted in cubes four times as large
  constexpr double kThinned_m = 0.4;  // what is registered
  MapKeyframe at_sensor = keyframe;
  at_sensor.T_map_body = geometry::Pose3{Eigen::Matrix3d::Identity(), -keyframe.p_body_sensor};
  const SurfaceCubes surface = surface_cubes({&at_sensor, 1}, kPatch_m);
  voxel_map::SweepSample sample;
  sample.stamp = keyframe.stamp;
  sample.points = keyframe.size();
  std::vector<std::uint8_t> is_flat;
  for (std::size_t i = 0; i < keyframe.size(); ++i) {
    const Eigen::Vector3d p = keyframe.p_body(i) - keyframe.p_body_sensor;
    const auto source = static_cast<std::uint32_t>(i);
    sample.surface.push_back(static_cast<float>(p.x()), static_cast<float>(p.y()),
                             static_cast<float>(p.z()), static_cast<float>(p.norm()), source);
    const auto cube = surface.at.find(geometry::voxel_key(p, kPatch_m));
    const bool flat = cube != surface.at.end() && !surface.cubes[cube->second].normal.isZero();
    is_flat.push_back(flat ? 1 : 0);
  }
  sample.surface_is_planar = is_flat;
  sample.surface.time.assign(sample.surface.size(), 0);
  for (const std::uint32_t i : voxel_map::first_of_each_cube(sample.surface, is_flat, kThinned_m)) {
    sample.planar.append(sample.surface, i);
  }
  return sample;
}

}  // namespace

RunPlaces::RunPlaces(const std::vector<MapKeyframe>& keyframes) {
  for (std::size_t k = 0; k < keyframes.size(); ++k) {
    const MapKeyframe& keyframe = keyframes[k];
    T_map_sensor_.push_back(keyframe.T_map_body *
                            geometry::Pose3{Eigen::Matrix3d::Identity(), keyframe.p_body_sensor});
    auto made = std::make_shared<slam::Keyframe>();
    made->id = k;
    made->stamp = keyframe.stamp;
    made->T_odom_lidar = T_map_sensor_.back();
    made->features = features_of(keyframe);
    const auto& points = made->features.surface;
    contexts_.emplace_back(points.x, points.y, points.z, slam::ScanContextOptions{});
    keyframes_.push_back(std::move(made));
  }
}

slam::ScanContext RunPlaces::context_beside(std::size_t k, double left_m) const {
  const auto& points = keyframes_[k]->features.surface;
  std::vector<float> y = points.y;
  for (float& value : y) value -= static_cast<float>(left_m);
  return {points.x, y, points.z, slam::ScanContextOptions{}};
}

slam::Submap RunPlaces::submap(std::size_t k, int keyframes_around) const {
  const auto around = static_cast<std::size_t>(keyframes_around);
  std::vector<slam::PlacedKeyframe> placed;
  const std::size_t end = std::min(size(), k + around + 1);
  for (std::size_t i = k > around ? k - around : 0; i < end; ++i) {
    placed.push_back({keyframes_[i], T_map_sensor_[k].inverse() * T_map_sensor_[i]});
  }
  return slam::make_submap(k, placed, {});
}

std::optional<Placement> place(const RunPlaces& run, std::size_t keyframe, const slam::Submap& on,
                               const geometry::Pose3& guess_other_keyframe,
                               const slam::SearchRegion& region, const MergeOptions& options) {
  const slam::LoopRegistrationOptions registration;
  const auto starts = slam::starts_around(guess_other_keyframe, region, registration);
  const auto found = slam::register_in(on, run.features(keyframe), starts, registration);
  const bool is_sure = found.health.registered && found.health.observability.degenerate == 0 &&
                       found.overlap >= options.min_overlap &&
                       found.health.residual_rms_m <= options.max_residual_m;
  if (!is_sure) return std::nullopt;
  return Placement{found.T_centre_lidar, found.overlap, found.health.residual_rms_m};
}

}  // namespace traverse::mapping
