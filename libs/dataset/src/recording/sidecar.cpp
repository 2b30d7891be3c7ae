#include "recording/sidecar.hpp"

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "traverse/config/binder.hpp"
#include "traverse/config/settings.hpp"
#include "traverse/dataset/trajectory_streams.hpp"
#include "traverse/files/numbers.hpp"

#include "recording/recording_files.hpp"

namespace traverse::dataset {

namespace {

constexpr const char* kReference = "reference.tum";
constexpr const char* kCalibration = "calib.txt";

std::string calibration_text(const geometry::Pose3& T_camera_lidar) {
  std::string line = "Tr:";
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      line += " " + files::to_text(T_camera_lidar.rotation(row, column));
    }
    line += " " + files::to_text(T_camera_lidar.translation(row));
  }
  return line + "\n";
}

void bind_cloud_topic(config::Binder& lidar, BagStatements& bag) {
  if (bag.lidar.empty()) return;
  lidar.text("topic", bag.lidar, "");
  if (!bag.has_times) return;
  std::string unit = "s";
  std::string zero = "stamp";
  lidar.text("time_unit", unit, "");
  lidar.text("time_zero", zero, "");
}

void bind_topics(config::Binder& b, BagStatements& bag) {
  const auto add = [&](const char* sensor, std::string& topic) {
    if (topic.empty()) return;
    b.group(sensor, "", [&](config::Binder& group) { group.text("topic", topic, ""); });
  };
  add("imu", bag.imu);
  add("gnss", bag.gnss);
  add("wheels", bag.wheels);
  add("laser", bag.laser);
}

}  // namespace

Sidecar sidecar_of_whole_rig(const RecordingInfo& info, const std::optional<Reference>& reference,
                             bool has_rings, bool has_times) {
  Sidecar sidecar;
  sidecar.name = info.name;
  sidecar.motion_compensated = info.motion_compensated;
  sidecar.body_frame = info.rig.body_frame;
  if (reference) {
    sidecar.reference = reference->T_map_body;
    sidecar.north_map = reference->north_map;
  }
  if (const auto* lidar = info.rig.first(sensors::SensorKind::kLidar)) {
    sidecar.profile =
        stored_in_data(lidar->lidar.value_or(sensors::LidarProfile()), has_rings, has_times);
    if (info.T_body_camera) {
      sidecar.T_camera_lidar = info.T_body_camera->inverse() * lidar->T_body_sensor;
    }
  }
  if (const auto* wheels = info.rig.first(sensors::SensorKind::kWheels)) {
    sidecar.wheels = *wheels;  // neither MRPT's odometry nor that of ROS has a mounting
  }
  return sidecar;
}

void commit_with_sidecar(const Sidecar& sidecar, RecordingFiles& files) {
  Sidecar values = sidecar;  // a Binder binds variables, also to list them
  std::string reference_file = files.full_name(kReference);
  std::string reference_format = "tum";
  std::string reference_frame = "body";
  const Eigen::Vector3d north = values.north_map.value_or(Eigen::Vector3d::UnitX());
  double north_deg = std::atan2(north.y(), north.x()) * 180 / std::numbers::pi;
  std::string calibration = files.full_name(kCalibration);
  const std::string yaml = config::to_yaml(
      [&](config::Binder& b) {
        b.text("name", values.name, "");
        b.flag("motion_compensated", values.motion_compensated, "");
        b.text("body_frame", values.body_frame, "");
        if (values.reference) {
          b.group("reference", "", [&](config::Binder& reference) {
            reference.text("file", reference_file, "");
            reference.text("format", reference_format, "");
            reference.text("frame", reference_frame, "");
            if (values.north_map) {
              reference.number("north_deg", north_deg, config::Range::between(-360, 360), "");
            }
          });
        }
        if (values.T_camera_lidar) b.text("calibration", calibration, "");
        if (values.vehicle) {
          b.group("vehicle", "", [&](config::Binder& vehicle) { bind(vehicle, *values.vehicle); });
        } else if (values.wheels) {
          auto encoder = values.wheels->encoder.value_or(sensors::WheelEncoder{});
          const Eigen::Vector3d& p = values.wheels->T_body_sensor.translation;
          std::vector<double> position{p.x(), p.y(), p.z()};
          b.group("vehicle", "", [&](config::Binder& vehicle) {
            vehicle.group("wheels", "", [&](config::Binder& wheels) {
              const auto positive = config::Range::any();
              wheels.numbers("position_m", position, "");
              wheels.number("left_m_per_pulse", encoder.left_m_per_pulse, positive, "");
              wheels.number("right_m_per_pulse", encoder.right_m_per_pulse, positive, "");
            });
          });
        }
        if (values.log) {
          b.group("log", "", [&](config::Binder& log) { bind(log, *values.log); });
        }
        if (values.profile) {
          b.group("lidar", "", [&](config::Binder& lidar) {
            bind(lidar, *values.profile);
            if (values.bag) bind_cloud_topic(lidar, *values.bag);
          });
        }
        if (values.bag) bind_topics(b, *values.bag);
      },
      false);
  if (sidecar.reference) write_tum(files.add(kReference).stream(), *sidecar.reference);
  if (sidecar.T_camera_lidar) {
    files.write(kCalibration, calibration_text(*sidecar.T_camera_lidar));
  }
  files.commit(yaml);
}

sensors::LidarProfile stored_in_data(sensors::LidarProfile profile, bool has_rings,
                                     bool has_times) {
  if (has_rings) profile.ring_source = sensors::RingSource::kData;
  if (has_times) profile.time_source = sensors::TimeSource::kData;
  return profile;
}

}  // namespace traverse::dataset
