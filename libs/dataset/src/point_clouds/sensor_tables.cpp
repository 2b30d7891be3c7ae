#include "point_clouds/sensor_tables.hpp"

#include <cmath>
#include <memory>
#include <type_traits>
#include <variant>

#include <fmt/format.h>

#include "traverse/files/numbers.hpp"

namespace traverse::dataset {

using sensors::SensorKind;

namespace {

std::string three_cells(const Eigen::Vector3d& v) {
  return files::to_text(v.x()) + "," + files::to_text(v.y()) + "," + files::to_text(v.z());
}

}  // namespace

SensorTables::SensorTables(const sensors::Rig& rig, std::map<std::string, std::size_t>& left_out)
    : rig_(rig), left_out_(left_out) {}

bool SensorTables::add(const sensors::Measurement& measurement) {
  return std::visit(
      [this](const auto& held) {
        using Held = std::decay_t<decltype(held)>;
        if constexpr (std::is_same_v<Held, sensors::ImuSample> ||
                      std::is_same_v<Held, sensors::GnssFix> ||
                      std::is_same_v<Held, sensors::WheelOdometry>) {
          return add(held);
        } else {
          return false;
        }
      },
      measurement);
}

bool SensorTables::is_first(SensorKind kind, const std::string& label) const {
  const auto* first = rig_.first(kind);
  return first == nullptr || first->label == label;
}

void SensorTables::add_row(const char* file, const char* header, const std::string& row) {
  std::string& text = files_[file];
  if (text.empty()) text = std::string(header) + "\n";
  text += row + "\n";
}

bool SensorTables::add(const sensors::ImuSample& sample) {
  if (!is_first(SensorKind::kImu, sample.sensor)) return false;
  add_row("imu.csv", "t,gx,gy,gz,ax,ay,az",
          fmt::format("{},{},{}", geometry::to_text(sample.stamp), three_cells(sample.angular_rate),
                      three_cells(sample.specific_force)));
  return true;
}

bool SensorTables::add(const sensors::GnssFix& fix) {
  if (!is_first(SensorKind::kGnss, fix.sensor)) return false;
  if (std::isnan(fix.altitude_m)) {
    ++left_out_["fixes without an altitude"];
    return true;
  }
  std::string sigmas = ",,";
  if (fix.covariance_enu) {
    const Eigen::Vector3d deviations = fix.covariance_enu->diagonal().cwiseSqrt();
    sigmas = three_cells(deviations);
    const Eigen::Matrix3d back = deviations.cwiseAbs2().asDiagonal();
    if (back != *fix.covariance_enu) {
      ++left_out_["correlations of fixes, or last digits of their deviations"];
    }
  }
  add_row("gnss.csv",
          "t,latitude_deg,longitude_deg,altitude_m,heading_deg,east_sigma_m,north_sigma_m,"
          "up_sigma_m",
          fmt::format("{},{},{},{},{},{}", geometry::to_text(fix.stamp),
                      files::to_text(fix.latitude_deg), files::to_text(fix.longitude_deg),
                      files::to_text(fix.altitude_m),
                      fix.heading_deg ? files::to_text(*fix.heading_deg) : "", sigmas));
  return true;
}

bool SensorTables::add(const sensors::WheelOdometry& reading) {
  if (!is_first(SensorKind::kWheels, reading.sensor)) return false;
  if (reading.T_odom_body) ++left_out_["poses of wheel odometry"];
  if (reading.ticks) ++left_out_["pulses of wheels"];
  if (!reading.velocity) return true;
  if (reading.velocity->left_mps != 0 || reading.velocity->yaw_rate != 0) {
    ++left_out_["sideward and turning speeds of wheel odometry"];
  }
  add_row("wheels.csv", "t,speed_m_s",
          fmt::format("{},{}", geometry::to_text(reading.stamp),
                      files::to_text(reading.velocity->forward_mps)));
  return true;
}

}  // namespace traverse::dataset
