#include "kitti/oxts.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "traverse/files/input_error.hpp"
#include "traverse/files/numbers.hpp"
#include "traverse/files/text_file.hpp"
#include "traverse/geometry/angle.hpp"

namespace traverse::dataset {

using files::InputError;
using files::Place;
using geometry::Pose3;

namespace {

namespace fs = std::filesystem;

constexpr double kEarthRadius = 6378137;  // metres

const std::vector<std::string>& standard_names() {
  static const std::vector<std::string> kNames{
      "lat",          "lon",     "alt",     "roll",    "pitch",   "yaw",    "vn", "ve",
      "vf",           "vl",      "vu",      "ax",      "ay",      "az",     "af", "al",
      "au",           "wx",      "wy",      "wz",      "wf",      "wl",     "wu", "pos_accuracy",
      "vel_accuracy", "navstat", "numsats", "posmode", "velmode", "orimode"};
  return kNames;
}

/// "lat:   latitude of the oxts-unit (deg)"
std::vector<std::string> read_names(const fs::path& dataformat) {
  constexpr std::size_t kMostNames = 1000;
  std::vector<std::string> names;
  files::LineReader reader(dataformat);
  while (reader.next()) {
    if (names.size() == kMostNames) {
      throw reader.error(fmt::format("at most {} values", kMostNames), "more");
    }
    const std::size_t colon = reader.line().find(':');
    if (colon == std::string::npos) throw reader.error("NAME: MEANING");
    names.push_back(reader.line().substr(0, colon));
  }
  return names;
}

Pose3 mercator_pose(const OxtsPacket& packet, double scale) {
  Pose3 pose;
  pose.translation = {
      scale * packet.longitude_deg * geometry::kDegree * kEarthRadius,
      scale * kEarthRadius * std::log(std::tan((90 + packet.latitude_deg) * geometry::kDegree / 2)),
      packet.altitude_m};
  pose.rotation = (Eigen::AngleAxisd(packet.yaw, Eigen::Vector3d::UnitZ()) *
                   Eigen::AngleAxisd(packet.pitch, Eigen::Vector3d::UnitY()) *
                   Eigen::AngleAxisd(packet.roll, Eigen::Vector3d::UnitX()))
                      .toRotationMatrix();
  return pose;
}

}  // namespace

OxtsReader::OxtsReader(const fs::path& dataformat)
    : names_(fs::exists(dataformat) ? read_names(dataformat) : standard_names()) {
  for (const char* needed : {"lat", "lon", "alt", "roll", "pitch", "yaw", "ax", "ay", "az", "wx",
                             "wy", "wz", "pos_accuracy"}) {
    if (std::find(names_.begin(), names_.end(), needed) == names_.end()) {
      throw InputError(dataformat, Place::key(needed), "the line of this value", "none");
    }
  }
}

std::size_t OxtsReader::column_of(const std::string& name) const {
  return static_cast<std::size_t>(std::find(names_.begin(), names_.end(), name) - names_.begin());
}

OxtsPacket OxtsReader::read(const fs::path& file, geometry::Stamp stamp) const {
  files::LineReader reader(file);
  if (!reader.next()) {
    throw InputError(file, Place::whole_file(), "a line of numbers", "an empty file");
  }
  const std::vector<std::string_view> words = files::split_words(reader.line());
  if (words.size() != names_.size()) {
    throw reader.error(fmt::format("{} numbers", names_.size()), fmt::format("{}", words.size()));
  }
  const auto value = [&](const char* name) {
    const std::string_view word = words[column_of(name)];
    const auto number = files::parse_double(word);
    if (!number || !std::isfinite(*number)) {
      throw reader.error(std::string("a number for ") + name, files::in_quotes(word));
    }
    return *number;
  };
  OxtsPacket packet;
  packet.stamp = stamp;
  packet.latitude_deg = value("lat");
  packet.longitude_deg = value("lon");
  packet.altitude_m = value("alt");
  packet.roll = value("roll");
  packet.pitch = value("pitch");
  packet.yaw = value("yaw");
  packet.specific_force = {value("ax"), value("ay"), value("az")};
  packet.angular_rate = {value("wx"), value("wy"), value("wz")};
  packet.position_accuracy_m = value("pos_accuracy");
  return packet;
}

sensors::ImuSample imu_sample(const OxtsPacket& packet, const std::string& label) {
  return {packet.stamp, label, packet.angular_rate, packet.specific_force};
}

sensors::GnssFix gnss_fix(const OxtsPacket& packet, const std::string& label) {
  sensors::GnssFix fix;
  fix.stamp = packet.stamp;
  fix.sensor = label;
  fix.latitude_deg = packet.latitude_deg;
  fix.longitude_deg = packet.longitude_deg;
  fix.altitude_m = packet.altitude_m;
  const double heading_deg = 90 - packet.yaw / geometry::kDegree;
  fix.heading_deg = heading_deg - 360 * std::floor(heading_deg / 360);
  // The unit gives one number, for north and east; up is taken to be as good.
  const double variance = packet.position_accuracy_m * packet.position_accuracy_m;
  if (variance > 0) fix.covariance_enu = variance * Eigen::Matrix3d::Identity();
  return fix;
}

geometry::Trajectory mercator_trajectory(const std::vector<OxtsPacket>& packets) {
  geometry::Trajectory T_map_imu;
  if (packets.empty()) return T_map_imu;
  const double scale = std::cos(packets.front().latitude_deg * geometry::kDegree);
  const Pose3 T_first_mercator = mercator_pose(packets.front(), scale).inverse();
  for (const OxtsPacket& packet : packets) {
    T_map_imu.push_back(packet.stamp, T_first_mercator * mercator_pose(packet, scale));
  }
  return T_map_imu;
}

Eigen::Vector3d north_imu(const OxtsPacket& packet) {
  // A Mercator map keeps angles: its y axis points to true north everywhere.
  const Pose3 T_mercator_imu = mercator_pose(packet, 1);
  return T_mercator_imu.rotation.transpose() * Eigen::Vector3d::UnitY();
}

}  // namespace traverse::dataset
