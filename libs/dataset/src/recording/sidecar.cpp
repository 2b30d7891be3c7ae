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

}  // namespace

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
          b.group("lidar", "", [&](config::Binder& lidar) { bind(lidar, *values.profile); });
        }
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
