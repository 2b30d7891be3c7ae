#include "dataset/bag_of_recording.hpp"

#include <algorithm>
#include <map>

namespace traverse::testing {

namespace {

using sensors::SensorKind;

std::string frame_of(SensorKind kind) {
  switch (kind) {
    case SensorKind::kLidar:
      return "lidar";
    case SensorKind::kImu:
      return "imu";
    case SensorKind::kGnss:
      return "gnss";
    default:
      return "wheels";
  }
}

template <typename Number>
void put(std::string& data, std::size_t at, Number value) {
  std::memcpy(data.data() + at, &value, sizeof value);
}

}  // namespace

std::string message_of_scan(const sensors::LidarScan& scan, std::string_view frame, Wire wire) {
  CloudMessage cloud;
  constexpr std::size_t kStep = 24;
  cloud.fields = {{"x", 0, 7},          {"y", 4, 7},     {"z", 8, 7},
                  {"intensity", 12, 7}, {"time", 16, 7}, {"ring", 20, 4}};
  if (scan.time.empty())
    std::erase_if(cloud.fields, [](const auto& f) { return f.name == "time"; });
  if (scan.ring.empty())
    std::erase_if(cloud.fields, [](const auto& f) { return f.name == "ring"; });
  cloud.width = static_cast<std::uint32_t>(scan.size());
  cloud.point_step = kStep;
  cloud.row_step = static_cast<std::uint32_t>(kStep * scan.size());
  cloud.data.assign(kStep * scan.size(), '\0');
  for (std::size_t i = 0; i < scan.size(); ++i) {
    put(cloud.data, kStep * i, scan.x[i]);
    put(cloud.data, kStep * i + 4, scan.y[i]);
    put(cloud.data, kStep * i + 8, scan.z[i]);
    if (!scan.intensity.empty()) put(cloud.data, kStep * i + 12, scan.intensity[i]);
    if (!scan.time.empty()) put(cloud.data, kStep * i + 16, scan.time[i]);
    if (!scan.ring.empty()) put(cloud.data, kStep * i + 20, scan.ring[i]);
  }
  return cloud_message(wire, scan.stamp.nanoseconds, frame, cloud);
}

std::vector<MadeMessage> messages_of(dataset::Source& source, Wire wire) {
  std::vector<MadeMessage> messages;
  std::vector<TransformOf> transforms;
  for (const sensors::MountedSensor& sensor : source.info().rig.sensors) {
    TransformOf transform{"base_link", frame_of(sensor.kind)};
    const Eigen::Quaterniond q = sensor.T_body_sensor.quaternion();
    for (int i = 0; i < 3; ++i) transform.xyz[i] = sensor.T_body_sensor.translation[i];
    transform.quaternion_xyzw[0] = q.x();
    transform.quaternion_xyzw[1] = q.y();
    transform.quaternion_xyzw[2] = q.z();
    transform.quaternion_xyzw[3] = q.w();
    transforms.push_back(transform);
  }
  constexpr std::int64_t kSweep_ns = 110'000'000;
  constexpr std::int64_t kWire_ns = 1'000'000;
  while (const auto measurement = source.next()) {
    const std::int64_t ns = stamp_of(*measurement).nanoseconds;
    if (messages.empty()) {
      messages.push_back(
          {"/tf_static", "tf2_msgs/TFMessage", ns, transforms_message(wire, ns, transforms)});
    }
    if (const auto* scan = std::get_if<std::shared_ptr<const sensors::LidarScan>>(&*measurement)) {
      messages.push_back({"/points", "sensor_msgs/PointCloud2", ns + kSweep_ns,
                          message_of_scan(**scan, "lidar", wire)});
    } else if (const auto* imu = std::get_if<sensors::ImuSample>(&*measurement)) {
      const auto& w = imu->angular_rate;
      const auto& f = imu->specific_force;
      messages.push_back(
          {"/imu", "sensor_msgs/Imu", ns + kWire_ns,
           imu_message(wire, ns, "imu", {w.x(), w.y(), w.z()}, {f.x(), f.y(), f.z()})});
    } else if (const auto* fix = std::get_if<sensors::GnssFix>(&*measurement)) {
      const auto variance = [&](int axis) { return fix->covariance_enu.value()(axis, axis); };
      messages.push_back({"/fix", "sensor_msgs/NavSatFix", ns + kWire_ns,
                          fix_message(wire, ns, "gnss", 0, fix->latitude_deg, fix->longitude_deg,
                                      fix->altitude_m, {variance(0), variance(1), variance(2)})});
    }
  }
  std::stable_sort(messages.begin(), messages.end(),
                   [](const auto& a, const auto& b) { return a.log_time_ns < b.log_time_ns; });
  return messages;
}

std::vector<BagKind> bag_kinds() {
  return {{"bag_none", ".bag"},        {"bag_bz2", ".bag"},      {"bag_lz4", ".bag"},
          {"bag_shuffled", ".bag"},    {"bag_no_index", ".bag"}, {"db3_split", ""},
          {"mcap_none", ".mcap"},      {"mcap_lz4", ".mcap"},    {"mcap_zstd", ".mcap"},
          {"mcap_no_summary", ".mcap"}};
}

std::filesystem::path write_bag(const BagKind& kind, const std::filesystem::path& folder,
                                dataset::Source& source) {
  source.rewind();
  const std::filesystem::path path = folder / (kind.name + kind.extension);
  const auto is = [&](std::string_view part) { return kind.name.find(part) != std::string::npos; };
  const Wire wire = kind.extension == ".bag" ? Wire::kRos1
                    : is("lz4")              ? Wire::kCdrBigEndian
                                             : Wire::kCdr;
  const std::vector<MadeMessage> messages = messages_of(source, wire);
  ChunkOptions options;
  for (const char* packing : {"bz2", "lz4", "zstd"}) {
    if (is(packing)) options.packing = packing;
  }
  options.shuffle = is("shuffled");
  options.has_index = !is("no_index") && !is("no_summary");
  if (kind.extension == ".bag") {
    write_ros1_bag(path, messages, options);
  } else if (kind.extension == ".mcap") {
    write_mcap(path, messages, options, wire);
  } else {
    write_ros2_bag(path, messages, {3, false, false, true, true});
  }
  return path;
}

}  // namespace traverse::testing
