#include "bags/made_messages.hpp"

#include <map>

namespace traverse::testing {

namespace {

const std::string kRule = "\n" + std::string(80, '=') + "\nMSG: ";

std::string header_of(Wire wire) {
  return wire == Wire::kRos1 ? kRule + "std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id"
                             : kRule +
                                   "std_msgs/Header\nbuiltin_interfaces/Time stamp\n"
                                   "string frame_id" +
                                   kRule + "builtin_interfaces/Time\nint32 sec\nuint32 nanosec";
}

const std::string kVector = kRule + "geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z";
const std::string kQuaternion =
    kRule + "geometry_msgs/Quaternion\n\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w";
const std::string kPose = kRule + "geometry_msgs/Pose\nPoint position\nQuaternion orientation" +
                          kRule + "geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z" +
                          kQuaternion;

/// What follows the header of a message that holds packets; empty for another type.
std::string packets_definition(std::string_view type, Wire wire) {
  const std::string time = wire == Wire::kRos1 ? "time stamp" : "builtin_interfaces/Time stamp";
  if (type == "velodyne_msgs/VelodyneScan") {
    return "\nVelodynePacket[] packets" + kRule + "velodyne_msgs/VelodynePacket\n" + time +
           "\nuint8[1206] data";
  }
  if (type == "pandar_msgs/PandarScan" || type == "hesai_lidar/PandarScan") {
    const std::string package(type.substr(0, type.find('/')));
    return "\nPandarPacket[] packets" + kRule + package + "/PandarPacket\n" + time +
           "\nuint8[1500] data\nuint32 size";
  }
  if (type == "nebula_msgs/NebulaPackets") {
    return "\nNebulaPacket[] packets" + kRule + "nebula_msgs/NebulaPacket\n" + time +
           "\nuint8[] data";
  }
  return {};
}

}  // namespace

std::string definition_text(std::string_view type, Wire wire) {
  const std::string head =
      (wire == Wire::kRos1 ? "Header" : "std_msgs/Header") + std::string(" header");
  if (type == "sensor_msgs/Imu") {
    return "# An IMU\n\n" + head +
           "\ngeometry_msgs/Quaternion orientation\nfloat64[9] orientation_covariance # row major\n"
           "geometry_msgs/Vector3 angular_velocity\nfloat64[9] angular_velocity_covariance\n"
           "geometry_msgs/Vector3 linear_acceleration\nfloat64[9] "
           "linear_acceleration_covariance\n" +
           header_of(wire) + kQuaternion + kVector;
  }
  if (type == "sensor_msgs/PointCloud2") {
    return head +
           "\nuint32 height\nuint32 width\nPointField[] fields\nbool is_bigendian\nuint32 "
           "point_step\n"
           "uint32 row_step\nuint8[] data\nbool is_dense\n" +
           header_of(wire) + kRule +
           "sensor_msgs/PointField\nuint8 INT8    = 1\nuint8 FLOAT64 = 8\nstring name\nuint32 "
           "offset\nuint8 datatype\nuint32 count";
  }
  if (type == "sensor_msgs/NavSatFix") {
    return head +
           "\nNavSatStatus status\nfloat64 latitude\nfloat64 longitude\nfloat64 altitude\n"
           "float64[9] position_covariance\nuint8 COVARIANCE_TYPE_UNKNOWN = 0\nuint8 "
           "position_covariance_type\n" +
           header_of(wire) + kRule +
           "sensor_msgs/NavSatStatus\nint8 STATUS_NO_FIX = -1\nint8 status\nuint16 service";
  }
  if (type == "tf2_msgs/TFMessage") {
    return "geometry_msgs/TransformStamped[] transforms\n" + kRule +
           "geometry_msgs/TransformStamped\n" + head +
           "\nstring child_frame_id\nTransform transform" + header_of(wire) + kRule +
           "geometry_msgs/Transform\nVector3 translation\nQuaternion rotation" + kVector +
           kQuaternion;
  }
  if (type == "nav_msgs/Odometry") {
    return head +
           "\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n"
           "geometry_msgs/TwistWithCovariance twist\n" +
           header_of(wire) + kRule +
           "geometry_msgs/PoseWithCovariance\nPose pose\nfloat64[36] covariance" + kPose + kRule +
           "geometry_msgs/TwistWithCovariance\nTwist twist\nfloat64[36] covariance" + kRule +
           "geometry_msgs/Twist\nVector3 linear\nVector3 angular" + kVector;
  }
  if (type == "sensor_msgs/JointState") {
    return head + "\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort\n" +
           header_of(wire);
  }
  if (const auto packets = packets_definition(type, wire); !packets.empty()) {
    return head + packets + header_of(wire);
  }
  if (type.ends_with("/PacketMsg")) return "uint8[] buf";
  return "string data";
}

std::string packets_message(std::string_view type, Wire wire, std::int64_t ns,
                            std::string_view frame, const std::vector<MadePacket>& packets) {
  constexpr std::size_t kPandarRoom = 1500;
  MessageWriter writer(wire);
  if (type.ends_with("/PacketMsg")) return writer.bytes(packets.at(0).bytes).take();
  writer.header(ns, frame).u32(packets.size());
  for (const MadePacket& packet : packets) {
    writer.time(packet.ns);
    const bool is_pandar = type.ends_with("/PandarScan");
    if (type.ends_with("/NebulaPackets")) writer.u32(packet.bytes.size());
    for (const char byte : packet.bytes) writer.number(byte);
    if (!is_pandar) continue;
    for (std::size_t i = packet.bytes.size(); i < kPandarRoom; ++i) writer.u8(0);
    writer.u32(packet.bytes.size());
  }
  return writer.take();
}

std::string imu_message(Wire wire, std::int64_t ns, std::string_view frame, const double (&rate)[3],
                        const double (&force)[3]) {
  MessageWriter writer(wire);
  writer.header(ns, frame).all(0, 0, 0, 1).zeros(9).all(rate[0], rate[1], rate[2]).zeros(9);
  return writer.all(force[0], force[1], force[2]).zeros(9).take();
}

std::string cloud_message(Wire wire, std::int64_t ns, std::string_view frame,
                          const CloudMessage& cloud) {
  MessageWriter writer(wire);
  writer.header(ns, frame).u32(cloud.height).u32(cloud.width).u32(cloud.fields.size());
  for (const FieldOfPoints& field : cloud.fields) {
    writer.text(field.name).u32(field.offset).u8(field.datatype).u32(1);
  }
  writer.u8(cloud.is_bigendian ? 1 : 0).u32(cloud.point_step).u32(cloud.row_step);
  return writer.bytes(cloud.data).u8(1).take();
}

std::string fix_message(Wire wire, std::int64_t ns, std::string_view frame, int status,
                        double latitude, double longitude, double altitude,
                        const double (&variances)[3]) {
  MessageWriter writer(wire);
  writer.header(ns, frame).number(static_cast<std::int8_t>(status));
  writer.number(std::uint16_t{1}).all(latitude, longitude, altitude);
  return writer.all(variances[0], 0, 0, 0, variances[1], 0, 0, 0, variances[2]).u8(2).take();
}

std::string transforms_message(Wire wire, std::int64_t ns, const std::vector<TransformOf>& all) {
  MessageWriter writer(wire);
  writer.u32(all.size());
  for (const TransformOf& one : all) {
    writer.header(ns, one.parent).text(one.child).all(one.xyz[0], one.xyz[1], one.xyz[2]);
    for (const double part : one.quaternion_xyzw) writer.f64(part);
  }
  return writer.take();
}

std::string odometry_message(Wire wire, std::int64_t ns, std::string_view frame,
                             std::string_view child, const double (&xyz)[3],
                             const double (&quaternion_xyzw)[4], double forward, double yaw_rate) {
  MessageWriter writer(wire);
  writer.header(ns, frame).text(child).all(xyz[0], xyz[1], xyz[2]);
  for (const double part : quaternion_xyzw) writer.f64(part);
  return writer.zeros(36).all(forward, 0, 0, 0, 0, yaw_rate).zeros(36).take();
}

std::string joints_message(Wire wire, std::int64_t ns, const std::vector<JointOf>& joints,
                           bool has_positions) {
  MessageWriter writer(wire);
  writer.header(ns, "").u32(joints.size());
  for (const JointOf& joint : joints) writer.text(joint.name);
  writer.u32(has_positions ? joints.size() : 0);
  for (const JointOf& joint : joints) {
    if (has_positions) writer.f64(joint.position);
  }
  writer.u32(joints.size()).zeros(joints.size()).u32(0);
  return writer.take();
}

}  // namespace traverse::testing
