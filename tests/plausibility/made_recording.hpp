#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "traverse/dataset/source.hpp"
#include "traverse/plausibility/stream_checks.hpp"
#include "traverse/sensors/measurement.hpp"

#include "inertial/simulated_vehicle.hpp"

namespace traverse::testing {

/// A recording as a source tells it: what is known of it, and its measurements.
struct MadeRecording {
  dataset::RecordingInfo info;
  std::vector<sensors::Measurement> measurements;

  /// Calls `change` with every measurement of that type.
  template <typename Reading, typename Change>
  void for_each(const Change& change) {
    for (sensors::Measurement& measurement : measurements) {
      if (auto* reading = std::get_if<Reading>(&measurement)) change(*reading);
    }
  }
  void sort() {
    std::stable_sort(measurements.begin(), measurements.end(), [](const auto& a, const auto& b) {
      return sensors::stamp_of(a) < sensors::stamp_of(b);
    });
  }
};

/// The car of SimulatedVehicle with an IMU, a receiver and wheels, as a text log would hold it.
inline MadeRecording made_drive(const SimulatedSensors& sensors = {}, double seconds = 90) {
  SimulatedVehicle car;
  car.light_every_s = 40;  // a town: speeds change
  SimulatedDrive drive = simulate(car, sensors, seconds);
  MadeRecording recording;
  recording.info.format = "navigation log";
  auto& rig = recording.info.rig;
  rig.sensors.push_back({"IMU", sensors::SensorKind::kImu, {}, std::nullopt});
  rig.sensors.push_back({"GNSS",
                         sensors::SensorKind::kGnss,
                         {Eigen::Matrix3d::Identity(), sensors.antenna_body},
                         std::nullopt});
  rig.sensors.push_back({"ODOM",
                         sensors::SensorKind::kWheels,
                         {Eigen::Matrix3d::Identity(), -car.imu_from_axle},
                         std::nullopt,
                         drive.mounts.encoder});
  for (auto& sample : drive.imu) {
    sample.sensor = "IMU";
    recording.measurements.emplace_back(sample);
  }
  for (auto& fix : drive.fixes) {
    fix.sensor = "GNSS";
    recording.measurements.emplace_back(fix);
  }
  for (auto& reading : drive.wheels) {
    reading.sensor = "ODOM";
    recording.measurements.emplace_back(reading);
  }
  recording.sort();
  return recording;
}

inline std::vector<plausibility::Finding> findings_in(const MadeRecording& recording) {
  plausibility::StreamChecks checks(recording.info);
  for (const auto& measurement : recording.measurements) checks.take(measurement);
  return checks.findings();
}

/// The codes of the findings, and their texts where a test fails.
inline std::vector<std::string> codes_of(const std::vector<plausibility::Finding>& findings) {
  std::vector<std::string> codes;
  for (const auto& finding : findings) codes.push_back(finding.code);
  return codes;
}
inline std::string texts_of(const std::vector<plausibility::Finding>& findings) {
  std::string texts;
  for (const auto& finding : findings) texts += plausibility::to_text(finding) + "\n";
  return texts;
}

}  // namespace traverse::testing
