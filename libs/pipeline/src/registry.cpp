#include "traverse/pipeline/registry.hpp"

#include <functional>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "traverse/files/input_error.hpp"
#include "traverse/inertial/navigation_options.hpp"
#include "traverse/loam/scan_to_map_odometry.hpp"
#include "traverse/loam/two_stage_odometry.hpp"
#include "traverse/voxel_map/voxel_map_odometry.hpp"

#include "lidar_estimator.hpp"
#include "navigation_estimator.hpp"
#include "slam_estimator.hpp"

namespace traverse::pipeline {

namespace {

/// One algorithm: how its settings are read from a document, and how it is made from them.
struct Kind {
  std::vector<config::Setting> (*settings)(const config::Document&);
  std::unique_ptr<Estimator> (*make)(const config::Document&, const dataset::RecordingInfo&,
                                     int threads);
};

/// Options of the type from a preset's document, in which two keys beside them are for people.
template <typename Options>
Options read_options(const config::Document& document) {
  Options options;
  std::string estimator;
  std::string description;
  config::read(document, [&](config::Binder& b) {
    b.text("estimator", estimator, "the algorithm");
    b.text("description", description, "what the preset is");
    bind(b, options);
  });
  return options;
}

template <typename Options>
std::vector<config::Setting> settings_of(const config::Document& document) {
  auto options = read_options<Options>(document);
  return config::list([&](config::Binder& b) { bind(b, options); });
}

/// The options of a lidar odometry, and of the loops that may be closed over any of them.
template <typename Options>
struct LidarOptions {
  Options odometry;
  SlamEstimatorOptions slam;
};

template <typename Options>
void bind(config::Binder& b, LidarOptions<Options>& o) {
  bind(b, o.odometry);
  b.group("slam", "loops over the odometry", [&](config::Binder& g) { bind(g, o.slam); });
}

/// An estimator of the lidar kind: an algorithm and the options it is made from.
template <typename Odometry, typename Options>
std::unique_ptr<Estimator> make_lidar(const config::Document& document,
                                      const dataset::RecordingInfo& recording, int threads) {
  auto options = read_options<LidarOptions<Options>>(document);
  options.odometry.threads = threads;
  const auto make = [&](const sensors::LidarProfile& profile, bool motion_compensated) {
    return std::make_unique<Odometry>(options.odometry, profile, motion_compensated);
  };
  auto odometry = std::make_unique<LidarEstimator>(make, recording);
  if (!options.slam.localization.map.empty()) {
    return std::make_unique<LocalizingEstimator>(std::move(odometry), options.slam.localization,
                                                 options.slam.slam);
  }
  if (!options.slam.use) return odometry;
  return std::make_unique<SlamEstimator>(std::move(odometry), recording, options.slam);
}

template <typename Odometry, typename Options>
constexpr Kind kLidarKind{settings_of<LidarOptions<Options>>, make_lidar<Odometry, Options>};

template <typename Options>
std::unique_ptr<Estimator> make_navigation(const config::Document& document,
                                           const dataset::RecordingInfo& recording, int) {
  return std::make_unique<NavigationEstimator>(read_options<Options>(document), recording);
}

template <typename Options>
constexpr Kind kNavigationKind{settings_of<Options>, make_navigation<Options>};

const Kind& find_kind(const Preset& preset) {
  static const std::map<std::string, Kind, std::less<>> kKinds{
      {"gins_two_frame", kNavigationKind<inertial::TwoFrameOptions>},
      {"gins_window", kNavigationKind<inertial::SlidingWindowOptions>},
      {"scan_to_map", kLidarKind<loam::ScanToMapOdometry, loam::ScanToMapOdometryOptions>},
      {"two_stage", kLidarKind<loam::TwoStageOdometry, loam::TwoStageOdometryOptions>},
      {"voxel_map", kLidarKind<voxel_map::VoxelMapOdometry, voxel_map::VoxelMapOdometryOptions>}};
  const std::string name = preset.resolved.scalar("estimator").value_or("");
  const auto found = kKinds.find(name);
  if (found != kKinds.end()) return found->second;
  std::vector<std::string> known;
  for (const auto& [key, kind] : kKinds) known.push_back(key);
  throw files::InputError(preset.file, files::Place::key("estimator"),
                          fmt::format("one of {}", fmt::join(known, ", ")), files::in_quotes(name));
}

}  // namespace

std::vector<ResolvedSetting> resolve_settings(const Preset& preset) {
  const Kind& kind = find_kind(preset);
  const std::vector<config::Setting> shipped = kind.settings(preset.as_shipped);
  std::vector<ResolvedSetting> resolved;
  for (config::Setting& setting : kind.settings(preset.resolved)) {
    config::Setting::Value in_preset = shipped.at(resolved.size()).value;
    resolved.push_back({std::move(setting), std::move(in_preset)});
  }
  return resolved;
}

Pipeline make_pipeline(const Preset& preset, const dataset::RecordingInfo& recording, int threads) {
  Pipeline pipeline;
  pipeline.name = preset.name;
  pipeline.description = preset.resolved.scalar("description").value_or("");
  pipeline.settings = resolve_settings(preset);
  pipeline.estimator = find_kind(preset).make(preset.resolved, recording, threads);
  return pipeline;
}

}  // namespace traverse::pipeline
