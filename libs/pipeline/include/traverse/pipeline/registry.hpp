#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "traverse/config/settings.hpp"
#include "traverse/dataset/source.hpp"
#include "traverse/pipeline/estimator.hpp"
#include "traverse/pipeline/preset.hpp"

namespace traverse::pipeline {

/// One setting of the configuration and what the preset says of it.
struct ResolvedSetting {
  config::Setting setting;
  config::Setting::Value in_preset;

  bool is_changed() const { return setting.value != in_preset; }
};

/// An estimator ready to run on one recording.
struct Pipeline {
  std::string name;
  std::string description;
  std::string estimator_kind;  ///< the key `estimator`: "voxel_map", "localize_voxel_map"
  std::unique_ptr<Estimator> estimator;
  std::vector<ResolvedSetting> settings;
};

/// The request of a preset of lidar odometry, turned into one that follows a recording in a map.
/// \param map keyframes.simplemap of a run  \param start x, y, z [m] and yaw [deg] of the body at
/// the first scan; empty: it is searched for
/// \throws files::InputError as load_preset(), and if the preset is of no lidar odometry
PresetRequest localizing_in(const std::filesystem::path& map, const std::vector<double>& start,
                            PresetRequest request, const std::filesystem::path& share_folder);

/// Every setting of the preset's algorithm with its resolved value.
/// \throws files::InputError for an unknown estimator or a wrong setting (file, line, key).
std::vector<ResolvedSetting> resolve_settings(const Preset& preset);

/// What the user should know of the preset's settings: keys that were given by former names.
/// \throws as resolve_settings()
std::vector<std::string> settings_notes(const Preset& preset);

/// Builds the estimator that the preset names for the recording's sensors.
/// \throws files::InputError for an unknown estimator or a wrong setting (file, line, key);
/// std::runtime_error if the recording lacks a sensor that the estimator needs.
Pipeline make_pipeline(const Preset& preset, const dataset::RecordingInfo& recording, int threads);

}  // namespace traverse::pipeline
