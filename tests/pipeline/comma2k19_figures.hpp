#pragma once

#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "traverse/dataset/open_recording.hpp"
#include "traverse/geodesy/local_tangent_plane.hpp"
#include "traverse/geometry/trajectory.hpp"
#include "traverse/pipeline/preset.hpp"
#include "traverse/pipeline/registry.hpp"

#include "test_data.hpp"

namespace traverse::testing {

inline std::filesystem::path comma2k19() { return test_data() / "comma2k19"; }

/// `statements` are laid over those that are shipped for this recording.
inline std::unique_ptr<dataset::Source> open_comma2k19(std::vector<std::string> statements = {}) {
  const std::filesystem::path share = TRAVERSE_SHARE_DIR;
  return dataset::open_recording(
      comma2k19(), {share / "recordings" / "comma2k19.yaml", std::move(statements), share});
}

/// A path against the reference, shifted onto it in the mean: a receiver for the mass market and a
/// reference made from other satellites' signals differ by a metre everywhere.
struct PathError {
  std::size_t poses = 0;
  double horizontal_rmse_m = 0;
  double rmse_m = 0;
  double roughness_m = 0;  ///< rms of the second difference of the horizontal error, pose by pose
  double longer_percent = 0;                        ///< than the reference, between the ends
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();  ///< that was taken off [m]
};

inline PathError path_error(const geometry::Trajectory& path, const dataset::Source& source) {
  const geometry::Trajectory& reference = source.reference()->T_map_body;
  std::vector<Eigen::Vector3d> errors, places, truths;
  for (std::size_t k = 0; k < path.size(); ++k) {
    const auto truth = reference.at(path.stamp(k), 0.1);
    if (!truth) continue;
    errors.emplace_back(path.pose(k).translation - truth->translation);
    places.push_back(path.pose(k).translation);
    truths.push_back(truth->translation);
  }
  PathError e;
  e.poses = errors.size();
  const auto count = static_cast<double>(errors.size());
  for (const auto& error : errors) e.shift += error / count;
  for (const auto& error : errors) {
    e.horizontal_rmse_m += (error - e.shift).head<2>().squaredNorm() / count;
    e.rmse_m += (error - e.shift).squaredNorm() / count;
  }
  for (std::size_t k = 2; k < errors.size(); ++k) {
    const Eigen::Vector3d bend = errors[k] - 2 * errors[k - 1] + errors[k - 2];
    e.roughness_m += bend.head<2>().squaredNorm() / (count - 2);
  }
  const double true_way = (truths.back() - truths.front()).head<2>().norm();
  const double way = (places.back() - places.front()).head<2>().norm();
  e.longer_percent = 100 * (way / true_way - 1);  // the road is all but straight
  e.horizontal_rmse_m = std::sqrt(e.horizontal_rmse_m);
  e.rmse_m = std::sqrt(e.rmse_m);
  e.roughness_m = std::sqrt(e.roughness_m);
  return e;
}

/// The fixes of a recording as they are, in the tangent plane at the first.
inline geometry::Trajectory fixes_of(dataset::Source& source) {
  geometry::Trajectory path;
  std::optional<geodesy::LocalTangentPlane> plane;
  source.rewind();
  while (const auto measurement = source.next()) {
    const auto* fix = std::get_if<sensors::GnssFix>(&*measurement);
    if (fix == nullptr) continue;
    const geodesy::Geodetic place{fix->latitude_deg, fix->longitude_deg, fix->altitude_m};
    if (!plane) plane.emplace(place);
    path.push_back(fix->stamp, {Eigen::Matrix3d::Identity(), plane->to_enu(place)});
  }
  return path;
}

struct NavigationRun {
  geometry::Trajectory path;
  std::vector<pipeline::Decision> decisions;
};

inline NavigationRun navigate(dataset::Source& source, const std::vector<std::string>& settings) {
  const auto preset = pipeline::load_preset({"gins-phone", {}, settings}, TRAVERSE_SHARE_DIR);
  const auto made = pipeline::make_pipeline(preset, source.info(), 1);
  NavigationRun run;
  const auto take = [&](const std::vector<pipeline::PoseFrame>& frames) {
    for (const auto& frame : frames) run.path.push_back(frame.stamp, frame.T_map_body);
  };
  source.rewind();
  while (const auto measurement = source.next()) take(made.estimator->process(*measurement));
  take(made.estimator->finish());
  run.decisions = made.estimator->decisions();
  return run;
}

/// What the estimate must do better than the fixes with.
struct CommaVariant {
  std::string name;
  std::vector<std::string> settings;
  double published_m = 0;  ///< horizontal rmse of reports/published/navigation.md
};

inline std::vector<CommaVariant> comma_variants() {
  const std::vector<std::string> outages{"outage.spells_s=[10, 10]", "outage.between_s=10"};
  return {
      {"GNSS and IMU", {"wheels.use=false"}, 0.166},
      {"GNSS, IMU and wheels", {}, 0.179},
      {"GNSS and IMU, two outages of 10 s", {"wheels.use=false", outages[0], outages[1]}, 0.187},
      {"GNSS, IMU and wheels, two outages of 10 s", outages, 0.187}};
}

}  // namespace traverse::testing
