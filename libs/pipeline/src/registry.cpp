#include "traverse/pipeline/registry.hpp"

#include <functional>
#include <map>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "traverse/files/input_error.hpp"
#include "traverse/fusion/inertial_odometry.hpp"
#include "traverse/inertial/navigation_options.hpp"
#include "traverse/loam/scan_to_map_odometry.hpp"
#include "traverse/loam/two_stage_odometry.hpp"
#include "traverse/pipeline/odometry_kind.hpp"
#include "traverse/voxel_map/voxel_map_odometry.hpp"

#include "imported_estimator.hpp"
#include "lidar_estimator.hpp"
#include "localizing_estimator.hpp"
#include "navigation_estimator.hpp"
#include "slam_estimator.hpp"

namespace traverse::pipeline {

namespace {

/// Before the name of an odometry: the estimator that follows it in a map.
const std::string kLocalize = "localize_";

struct ListedSettings {
  std::vector<config::Setting> settings;
  std::vector<std::string> notes;  // on keys given by former names
};

/// One algorithm: how its settings are read from a document, and how it is made from them.
struct EstimatorKind {
  std::function<ListedSettings(const config::Document&)> settings;
  std::function<std::unique_ptr<Estimator>(const config::Document&, const dataset::RecordingInfo&,
                                           int threads)>
      make;
};

/// Reads a preset's document, in which two keys beside the settings are for people.
template <typename Settings>
std::vector<std::string> read_preset(const config::Document& document, Settings& settings) {
  std::string estimator;
  std::string description;
  return config::read(document, [&](config::Binder& b) {
    b.text("estimator", estimator, "the algorithm");
    b.text("description", description, "one line about the preset");
    bind(b, settings);
  });
}

template <typename Settings>
ListedSettings list_settings(const config::Document& document, Settings settings) {
  std::vector<std::string> notes = read_preset(document, settings);
  return {config::list([&](config::Binder& b) { bind(b, settings); }), std::move(notes)};
}

/// The settings of a lidar odometry, and of the loops that may be closed over any of them.
struct LidarSettings {
  std::unique_ptr<OdometrySettings> odometry;
  SlamEstimatorOptions slam;
};

void bind(config::Binder& b, LidarSettings& s) {
  s.odometry->present(b);
  b.group("slam", "loop closure over the odometry", [&](config::Binder& g) { bind(g, s.slam); });
}

/// Those of an odometry that is followed in a map; the same presets serve, whose checks of places
/// (slam) hold for it too.
struct LocalizingSettings {
  LidarSettings lidar;
  LocalizationOptions localization;
};

void bind(config::Binder& b, LocalizingSettings& s) {
  bind(b, s.lidar);
  b.group("localize", "the map that the recording is followed in",
          [&](config::Binder& g) { bind(g, s.localization); });
}

std::unique_ptr<LidarEstimator> make_odometry(const OdometrySettings& settings,
                                              const dataset::RecordingInfo& recording,
                                              int threads) {
  const auto make = [&](const sensors::LidarProfile& profile, bool motion_compensated) {
    return settings.make(profile, motion_compensated, threads);
  };
  return std::make_unique<LidarEstimator>(make, recording);
}

/// An odometry of some kind, with or without loops over it.
EstimatorKind lidar_kind(const OdometryKind& odometry) {
  return {[odometry](const config::Document& document) {
            return list_settings(document, LidarSettings{odometry(), {}});
          },
          [odometry](const config::Document& document, const dataset::RecordingInfo& recording,
                     int threads) -> std::unique_ptr<Estimator> {
            LidarSettings settings{odometry(), {}};
            read_preset(document, settings);
            auto estimator = make_odometry(*settings.odometry, recording, threads);
            if (!settings.slam.use) return estimator;
            return std::make_unique<SlamEstimator>(std::move(estimator), recording, settings.slam);
          }};
}

/// An odometry of some kind, followed in a map.
EstimatorKind localizing_kind(const OdometryKind& odometry) {
  return {[odometry](const config::Document& document) {
            return list_settings(document, LocalizingSettings{{odometry(), {}}, {}});
          },
          [odometry](const config::Document& document, const dataset::RecordingInfo& recording,
                     int threads) {
            LocalizingSettings settings{{odometry(), {}}, {}};
            read_preset(document, settings);
            return std::make_unique<LocalizingEstimator>(
                make_odometry(*settings.lidar.odometry, recording, threads), settings.localization,
                settings.lidar.slam.slam);
          }};
}

template <typename Options>
EstimatorKind navigation_kind() {
  return {[](const config::Document& document) { return list_settings(document, Options{}); },
          [](const config::Document& document, const dataset::RecordingInfo& recording, int) {
            Options options;
            read_preset(document, options);
            return std::make_unique<NavigationEstimator>(options, recording);
          }};
}

/// Poses that another program made.
EstimatorKind imported_kind() {
  return {[](const config::Document& document) { return list_settings(document, ImportOptions{}); },
          [](const config::Document& document, const dataset::RecordingInfo& recording, int) {
            ImportOptions options;
            read_preset(document, options);
            return std::make_unique<ImportedEstimator>(options, recording);
          }};
}

using EstimatorKinds = std::map<std::string, EstimatorKind, std::less<>>;

/// An odometry makes two kinds: itself, and itself followed in a map. \returns false if there is
/// one of either name
bool add_odometry(const std::string& name, const OdometryKind& odometry, EstimatorKinds& kinds) {
  return kinds.emplace(name, lidar_kind(odometry)).second &&
         kinds.emplace(kLocalize + name, localizing_kind(odometry)).second;
}

/// Those that Traverse has, and those that were registered.
EstimatorKinds& estimator_kinds() {
  static EstimatorKinds all = [] {
    EstimatorKinds kinds{{"gins_two_frame", navigation_kind<inertial::TwoFrameOptions>()},
                         {"gins_window", navigation_kind<inertial::SlidingWindowOptions>()},
                         {"imported_poses", imported_kind()}};
    add_odometry("scan_to_map",
                 odometry_kind<loam::ScanToMapOdometry, loam::ScanToMapOdometryOptions>(), kinds);
    add_odometry("two_stage",
                 odometry_kind<loam::TwoStageOdometry, loam::TwoStageOdometryOptions>(), kinds);
    add_odometry("voxel_map",
                 odometry_kind<voxel_map::VoxelMapOdometry, voxel_map::VoxelMapOdometryOptions>(),
                 kinds);
    add_odometry("voxel_map_inertial",
                 odometry_kind<fusion::InertialOdometry, fusion::InertialOdometryOptions>(), kinds);
    return kinds;
  }();
  return all;
}

const EstimatorKind& find_kind(const Preset& preset) {
  const std::string name = preset.resolved.scalar("estimator").value_or("");
  const auto found = estimator_kinds().find(name);
  if (found != estimator_kinds().end()) return found->second;
  std::vector<std::string> known;
  for (const auto& [key, kind] : estimator_kinds()) known.push_back(key);
  throw files::InputError(preset.file, files::Place::key("estimator"),
                          fmt::format("one of {}", fmt::join(known, ", ")), files::in_quotes(name));
}

}  // namespace

void register_odometry(const std::string& name, const OdometryKind& kind) {
  if (!add_odometry(name, kind, estimator_kinds())) {
    throw std::invalid_argument("there is an estimator of the name " + files::in_quotes(name));
  }
}

PresetRequest localizing_in(const std::filesystem::path& map, const std::vector<double>& start,
                            PresetRequest request, const std::filesystem::path& share_folder) {
  const Preset preset = load_preset(request, share_folder);
  const std::string odometry = preset.resolved.scalar("estimator").value_or("");
  if (estimator_kinds().find(kLocalize + odometry) == estimator_kinds().end()) {
    throw files::InputError(preset.file, files::Place::key("estimator"),
                            "a lidar odometry, which can be followed in a map",
                            files::in_quotes(odometry));
  }
  request.assignments.push_back("estimator=" + kLocalize + odometry);
  request.assignments.push_back("localize.map=" + config::to_text(map.string()));
  request.assignments.push_back(fmt::format("localize.start=[{}]", fmt::join(start, ", ")));
  return request;
}

std::vector<ResolvedSetting> resolve_settings(const Preset& preset) {
  const EstimatorKind& kind = find_kind(preset);
  const std::vector<config::Setting> shipped = kind.settings(preset.as_shipped).settings;
  std::vector<ResolvedSetting> resolved;
  for (config::Setting& setting : kind.settings(preset.resolved).settings) {
    config::Setting::Value in_preset = shipped.at(resolved.size()).value;
    resolved.push_back({std::move(setting), std::move(in_preset)});
  }
  return resolved;
}

std::vector<std::string> settings_notes(const Preset& preset) {
  return find_kind(preset).settings(preset.resolved).notes;
}

Pipeline make_pipeline(const Preset& preset, const dataset::RecordingInfo& recording, int threads) {
  Pipeline pipeline;
  pipeline.name = preset.name;
  pipeline.estimator_kind = preset.resolved.scalar("estimator").value_or("");
  pipeline.description = preset.resolved.scalar("description").value_or("");
  pipeline.settings = resolve_settings(preset);
  pipeline.estimator = find_kind(preset).make(preset.resolved, recording, threads);
  return pipeline;
}

}  // namespace traverse::pipeline
