#include "bags/ros_messages.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "traverse/files/numbers.hpp"

#include "point_clouds/field_values.hpp"

namespace traverse::dataset {

using bags::MessageValue;
using geometry::Pose3;
using geometry::Stamp;

namespace {

constexpr std::array<std::pair<std::string_view, TopicKind>, 25> kTypes{{
    {"sensor_msgs/PointCloud2", TopicKind::kCloud},
    {"livox_ros_driver/CustomMsg", TopicKind::kCloud},
    {"livox_ros_driver2/CustomMsg", TopicKind::kCloud},
    {"livox_interfaces/CustomMsg", TopicKind::kCloud},
    {"velodyne_msgs/VelodyneScan", TopicKind::kPackets},
    {"pandar_msgs/PandarScan", TopicKind::kPackets},
    {"hesai_lidar/PandarScan", TopicKind::kPackets},
    {"nebula_msgs/NebulaPackets", TopicKind::kPackets},
    {"ouster_ros/PacketMsg", TopicKind::kPackets},
    {"ouster_msgs/PacketMsg", TopicKind::kPackets},
    {"ouster_sensor_msgs/PacketMsg", TopicKind::kPackets},
    {"rslidar_msg/RslidarPacket", TopicKind::kPackets},
    {"sensor_msgs/Imu", TopicKind::kImu},
    {"sensor_msgs/NavSatFix", TopicKind::kGnss},
    {"gps_msgs/GPSFix", TopicKind::kGnss},
    {"gps_common/GPSFix", TopicKind::kGnss},
    {"nmea_msgs/Sentence", TopicKind::kGnss},
    {"nav_msgs/Odometry", TopicKind::kOdometry},
    {"geometry_msgs/TwistStamped", TopicKind::kTwist},
    {"geometry_msgs/TwistWithCovarianceStamped", TopicKind::kTwist},
    {"sensor_msgs/JointState", TopicKind::kJoints},
    {"geometry_msgs/PoseStamped", TopicKind::kPose},
    {"geometry_msgs/PoseWithCovarianceStamped", TopicKind::kPose},
    {"tf2_msgs/TFMessage", TopicKind::kTransforms},
    {"tf/tfMessage", TopicKind::kTransforms},
}};

constexpr std::string_view kPlanar =
    "a laser that scans one plane: a trajectory in space needs a lidar with several rings";
constexpr std::array<std::pair<std::string_view, std::string_view>, 9> kUnusedTypes{{
    {"sensor_msgs/LaserScan", kPlanar},
    {"sensor_msgs/MultiEchoLaserScan", kPlanar},
    {"sensor_msgs/PointCloud",
     "the cloud that PointCloud2 replaced: point_cloud_converter of ROS makes one of the other"},
    {"point_cloud_interfaces/CompressedPointCloud2",
     "packed clouds: point_cloud_transport's `republish` with raw as the output makes PointCloud2"},
    {"draco_point_cloud_transport/CompressedPointCloud2",
     "packed clouds: point_cloud_transport's `republish` with raw as the output makes PointCloud2"},
    {"geometry_msgs/Pose", "poses without stamps"},
    {"geometry_msgs/Twist", "velocities without stamps: commands to a vehicle, most often"},
    {"sensor_msgs/Image", "pictures"},
    {"sensor_msgs/CompressedImage", "pictures"},
}};

/// The codes of sensor_msgs/PointField.
std::optional<ScalarType> type_of_field(std::int64_t datatype) {
  switch (datatype) {
    case 1:
      return ScalarType::kInt8;
    case 2:
      return ScalarType::kUint8;
    case 3:
      return ScalarType::kInt16;
    case 4:
      return ScalarType::kUint16;
    case 5:
      return ScalarType::kInt32;
    case 6:
      return ScalarType::kUint32;
    case 7:
      return ScalarType::kFloat;
    case 8:
      return ScalarType::kDouble;
    default:
      return std::nullopt;
  }
}

PointColumns point_cloud_2(const MessageValue& message) {
  const auto data = message["data"].bytes();
  const auto size_named = [&](std::string_view name) {
    return static_cast<std::uint64_t>(message[name].integer());
  };
  const std::uint64_t height = size_named("height");
  const std::uint64_t width = size_named("width");
  const std::uint64_t step = size_named("point_step");
  // All of them are numbers of 32 bits.
  const std::uint64_t row_bytes = width * step;
  const std::uint64_t row_step = std::max(size_named("row_step"), row_bytes);
  PointColumns points;
  if (height == 0 || width == 0) return points;
  const bool fits =
      step > 0 && row_bytes <= data.size() && (height - 1) <= (data.size() - row_bytes) / row_step;
  if (!fits) {
    throw UnusableMessage(fmt::format("a cloud of {} x {} points of {} bytes in {} bytes of data",
                                      height, width, step, data.size()));
  }
  const bool is_big = message["is_bigendian"].integer() != 0;
  points.points = static_cast<std::size_t>(height * width);
  points.rows = static_cast<std::size_t>(height);
  message["fields"].for_each([&](const MessageValue& field) {
    if (field["count"].integer() > 1) return;
    const std::string_view name = field["name"].text();
    const auto type = type_of_field(field["datatype"].integer());
    const auto offset = static_cast<std::uint64_t>(field["offset"].integer());
    if (!type || offset + bytes_of(*type) > step) {
      throw UnusableMessage(
          fmt::format("a cloud whose field {} reaches beyond its points of {} bytes", name, step));
    }
    points.columns.push_back({std::string(name), *type, data.data() + offset,
                              static_cast<std::size_t>(step), static_cast<std::size_t>(row_step),
                              is_big});
  });
  return points;
}

ScalarType scalar_type(bags::Primitive primitive) {
  switch (primitive) {
    case bags::Primitive::kInt8:
      return ScalarType::kInt8;
    case bags::Primitive::kInt16:
      return ScalarType::kInt16;
    case bags::Primitive::kUint16:
      return ScalarType::kUint16;
    case bags::Primitive::kInt32:
      return ScalarType::kInt32;
    case bags::Primitive::kUint32:
      return ScalarType::kUint32;
    case bags::Primitive::kInt64:
      return ScalarType::kInt64;
    case bags::Primitive::kUint64:
      return ScalarType::kUint64;
    case bags::Primitive::kFloat:
      return ScalarType::kFloat;
    case bags::Primitive::kDouble:
      return ScalarType::kDouble;
    default:
      return ScalarType::kUint8;
  }
}

PointColumns livox_points(const MessageValue& message) {
  const MessageValue& all = message["points"];
  PointColumns points;
  points.points = all.size();
  if (points.points == 0) return points;
  for (const char* name : {"x", "y", "z", "reflectivity", "line", "tag", "offset_time"}) {
    const bags::NumberColumn column = all.column(name);
    points.columns.push_back(
        {name, scalar_type(column.primitive), column.first, column.step, 0, column.swap_bytes});
  }
  return points;
}

Eigen::Vector3d vector_in(const MessageValue& value) {
  return {value["x"].number(), value["y"].number(), value["z"].number()};
}

Pose3 pose_in(const MessageValue& rotation, const MessageValue& translation) {
  const Eigen::Quaterniond q(rotation["w"].number(), rotation["x"].number(), rotation["y"].number(),
                             rotation["z"].number());
  const Eigen::Vector3d t = vector_in(translation);
  if (!(std::abs(q.norm() - 1) < 0.1) || !t.allFinite()) {
    throw UnusableMessage("a pose whose quaternion has not the length 1");
  }
  return Pose3::from_quaternion(q.normalized(), t);
}

bool is_unknown(const MessageValue& message, std::string_view covariance) {
  const MessageValue* values = message.find(covariance);
  return values != nullptr && values->numbers().count > 0 && values->numbers()[0] == -1;
}

void take_covariance(const MessageValue& message, sensors::GnssFix& fix) {
  const MessageValue* type = message.find("position_covariance_type");
  const MessageValue* covariance = message.find("position_covariance");
  if (type == nullptr || covariance == nullptr || type->integer() == 0) return;
  const bags::NumberColumn numbers = covariance->numbers();
  if (numbers.count != 9) return;
  Eigen::Matrix3d matrix;
  for (int i = 0; i < 9; ++i) matrix(i / 3, i % 3) = numbers[static_cast<std::size_t>(i)];
  if (matrix.allFinite() && matrix.diagonal().minCoeff() > 0) fix.covariance_enu = matrix;
}

/// "4807.038" and "N" as degrees.
double nmea_angle(std::string_view text, std::string_view side) {
  const auto value = files::parse_double(text);
  if (!value || side.size() != 1) throw UnusableMessage("a sentence of NMEA with a damaged place");
  const double degrees = std::floor(*value / 100);
  const double angle = degrees + (*value - 100 * degrees) / 60;
  return side == "S" || side == "W" ? -angle : angle;
}

sensors::GnssFix fix_of_sentence(std::string_view sentence) {
  constexpr std::size_t kFields = 12;
  while (!sentence.empty() && (sentence.back() == '\r' || sentence.back() == '\n')) {
    sentence.remove_suffix(1);
  }
  const auto star = sentence.find('*');
  if (star != std::string_view::npos && sentence.starts_with('$')) {
    unsigned sum = 0;
    for (const char c : sentence.substr(1, star - 1)) sum ^= static_cast<unsigned char>(c);
    if (fmt::format("{:02X}", sum) != sentence.substr(star + 1) &&
        fmt::format("{:02x}", sum) != sentence.substr(star + 1)) {
      throw UnusableMessage("a sentence of NMEA whose checksum does not fit");
    }
    sentence = sentence.substr(0, star);
  }
  std::vector<std::string_view> fields;
  for (std::size_t at = 0; at <= sentence.size();) {
    const auto comma = std::min(sentence.find(',', at), sentence.size());
    fields.push_back(sentence.substr(at, comma - at));
    at = comma + 1;
  }
  if (fields.front().size() != 6 || fields.front().substr(3) != "GGA") {
    throw UnusableMessage("a sentence of NMEA that is not GGA");
  }
  if (fields.size() < kFields || fields[6] == "0" || fields[6].empty()) {
    throw UnusableMessage("GNSS record without a fix");
  }
  sensors::GnssFix fix;
  fix.latitude_deg = nmea_angle(fields[2], fields[3]);
  fix.longitude_deg = nmea_angle(fields[4], fields[5]);
  const auto above_sea = files::parse_double(fields[9]);
  const auto geoid = files::parse_double(fields[11]);
  fix.altitude_m =
      above_sea ? *above_sea + geoid.value_or(0) : std::numeric_limits<double>::quiet_NaN();
  return fix;
}

}  // namespace

TopicKind kind_of_type(std::string_view type) {
  for (const auto& [known, kind] : kTypes) {
    if (known == type) return kind;
  }
  return TopicKind::kOther;
}

std::string_view why_unused(std::string_view type) {
  for (const auto& [known, why] : kUnusedTypes) {
    if (known == type) return why;
  }
  return {};
}

std::optional<Stamp> header_stamp(const MessageValue& message) {
  const std::int64_t ns = message["header"]["stamp"].time_ns();
  if (ns == 0) return std::nullopt;
  return Stamp{ns};
}

std::string header_frame(const MessageValue& message) {
  return std::string(message["header"]["frame_id"].text());
}

PointColumns columns_of(std::string_view type, const MessageValue& message) {
  return type == "sensor_msgs/PointCloud2" ? point_cloud_2(message) : livox_points(message);
}

sensors::ImuSample imu_sample_of(const MessageValue& message) {
  if (is_unknown(message, "angular_velocity_covariance") ||
      is_unknown(message, "linear_acceleration_covariance")) {
    throw UnusableMessage("IMU message that says it has no rates or no accelerations");
  }
  sensors::ImuSample sample;
  sample.angular_rate = vector_in(message["angular_velocity"]);
  sample.specific_force = vector_in(message["linear_acceleration"]);
  if (!sample.angular_rate.allFinite() || !sample.specific_force.allFinite()) {
    throw UnusableMessage("IMU message with a number that is not finite");
  }
  return sample;
}

sensors::GnssFix gnss_fix_of(std::string_view type, const MessageValue& message) {
  if (type == "nmea_msgs/Sentence") return fix_of_sentence(message["sentence"].text());
  if (message["status"]["status"].integer() < 0) throw UnusableMessage("GNSS record without a fix");
  sensors::GnssFix fix;
  fix.latitude_deg = message["latitude"].number();
  fix.longitude_deg = message["longitude"].number();
  fix.altitude_m = message["altitude"].number();
  if (!std::isfinite(fix.latitude_deg) || !std::isfinite(fix.longitude_deg)) {
    throw UnusableMessage("GNSS record without a fix");
  }
  take_covariance(message, fix);
  return fix;
}

sensors::WheelOdometry wheel_odometry_of(TopicKind kind, const MessageValue& message) {
  sensors::WheelOdometry odometry;
  if (kind == TopicKind::kOdometry) odometry.T_odom_body = pose_of(message);
  const MessageValue& outer = message["twist"];
  const MessageValue* inner = outer.find("twist");
  const MessageValue& twist = inner == nullptr ? outer : *inner;
  odometry.velocity = {twist["linear"]["x"].number(), twist["linear"]["y"].number(),
                       twist["angular"]["z"].number()};
  return odometry;
}

Pose3 pose_of(const MessageValue& message) {
  const MessageValue& outer = message["pose"];
  const MessageValue* inner = outer.find("pose");
  const MessageValue& pose = inner == nullptr ? outer : *inner;
  return pose_in(pose["orientation"], pose["position"]);
}

void for_each_transform(
    const MessageValue& message,
    const std::function<void(const std::string&, const std::string&, const Pose3&, Stamp)>& use) {
  message["transforms"].for_each([&](const MessageValue& one) {
    const MessageValue& transform = one["transform"];
    use(header_frame(one), std::string(one["child_frame_id"].text()),
        pose_in(transform["rotation"], transform["translation"]),
        header_stamp(one).value_or(Stamp{}));
  });
}

}  // namespace traverse::dataset
