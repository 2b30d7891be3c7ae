#include "rawlog/rawlog_sensors.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "point_clouds/point_statements.hpp"
#include "recording/gga_quality_fact.hpp"

namespace traverse::dataset {

using sensors::SensorKind;

RawlogSensors::RawlogSensors(const Statements& statements, std::filesystem::path share_folder,
                             RecordingInfo& info)
    : statements_(statements), share_folder_(std::move(share_folder)), info_(info) {}

std::string RawlogSensors::unique_label(SensorKind kind, const std::string& name) const {
  std::string label = name.empty() ? std::string(sensors::name_of(kind)) : name;
  std::replace_if(
      label.begin(), label.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, '?');
  if (info_.rig.find(label) != nullptr) {
    label += fmt::format(" ({})", sensors::name_of(kind));
  }
  return label;
}

std::string RawlogSensors::label_of(SensorKind kind, const std::string& name,
                                    const geometry::Pose3& T_body_sensor) {
  const auto [known, is_new] = labels_.try_emplace({kind, name});
  if (is_new) {
    known->second = unique_label(kind, name);
    info_.rig.sensors.push_back({known->second, kind, T_body_sensor, std::nullopt});
    apply_vehicle(statements_, info_.rig.sensors.back());
  }
  return known->second;
}

const sensors::MountedSensor& RawlogSensors::lidar(const std::string& name,
                                                   const geometry::Pose3& T_body_sensor,
                                                   const sensors::LidarProfile& from_data,
                                                   bool has_named_fields) {
  if (const auto known = labels_.find({SensorKind::kLidar, name}); known != labels_.end()) {
    return *info_.rig.find(known->second);
  }
  const bool is_first = info_.rig.first(SensorKind::kLidar) == nullptr;
  ProfileChoice choice = choose_profile(statements_, share_folder_,
                                        {from_data, "default; from the first observation"});
  const std::string label = label_of(SensorKind::kLidar, name, T_body_sensor);
  if (choice.profile.name == sensors::LidarProfile().name) choice.profile.name = label;
  info_.rig.sensors.back().lidar = choice.profile;
  const std::string prefix = is_first ? "" : label + ": ";
  add_profile_facts(choice, statements_, prefix, info_.facts);
  if (!has_named_fields) {
    note_idle_point_statements(statements_, prefix, "the rawlog stores rings and times of its own",
                               info_.facts);
  }
  if (!is_first && !statements_.states("lidars")) {
    const std::string& first = info_.rig.first(SensorKind::kLidar)->label;
    info_.facts.push_back(
        {"lidar not used", label,
         fmt::format("the first is; --recording 'lidars={},{}' takes both as one", first, label)});
  }
  return info_.rig.sensors.back();
}

void RawlogSensors::note_gga_quality(const Eigen::Matrix3d& covariance_enu) {
  dataset::note_gga_quality(covariance_enu, info_.facts);
}

}  // namespace traverse::dataset
