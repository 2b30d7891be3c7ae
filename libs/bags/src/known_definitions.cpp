#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "traverse/bags/message_definition.hpp"

namespace traverse::bags {

namespace {

struct KnownType {
  std::string_view name;
  std::string_view fields;
  std::string_view uses;  ///< other types of the table, blanks between
};

// The fields of ROS 2 Humble's messages (common_interfaces 4.2, geometry2 0.25) and of the drivers'
// own: the layout is what matters here, so that comments and constants are left out.
constexpr std::array<KnownType, 36> kTypes{{
    {"builtin_interfaces/Time", "int32 sec\nuint32 nanosec", ""},
    {"std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id",
     "builtin_interfaces/Time"},
    {"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z", ""},
    {"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z", ""},
    {"geometry_msgs/Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w", ""},
    {"geometry_msgs/Pose", "Point position\nQuaternion orientation",
     "geometry_msgs/Point geometry_msgs/Quaternion"},
    {"geometry_msgs/PoseWithCovariance", "Pose pose\nfloat64[36] covariance", "geometry_msgs/Pose"},
    {"geometry_msgs/PoseStamped", "std_msgs/Header header\nPose pose",
     "std_msgs/Header geometry_msgs/Pose"},
    {"geometry_msgs/PoseWithCovarianceStamped", "std_msgs/Header header\nPoseWithCovariance pose",
     "std_msgs/Header geometry_msgs/PoseWithCovariance"},
    {"geometry_msgs/Twist", "Vector3 linear\nVector3 angular", "geometry_msgs/Vector3"},
    {"geometry_msgs/TwistWithCovariance", "Twist twist\nfloat64[36] covariance",
     "geometry_msgs/Twist"},
    {"geometry_msgs/TwistStamped", "std_msgs/Header header\nTwist twist",
     "std_msgs/Header geometry_msgs/Twist"},
    {"geometry_msgs/Transform", "Vector3 translation\nQuaternion rotation",
     "geometry_msgs/Vector3 geometry_msgs/Quaternion"},
    {"geometry_msgs/TransformStamped",
     "std_msgs/Header header\nstring child_frame_id\nTransform transform",
     "std_msgs/Header geometry_msgs/Transform"},
    {"tf2_msgs/TFMessage", "geometry_msgs/TransformStamped[] transforms",
     "geometry_msgs/TransformStamped"},
    {"nav_msgs/Odometry",
     "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n"
     "geometry_msgs/TwistWithCovariance twist",
     "std_msgs/Header geometry_msgs/PoseWithCovariance geometry_msgs/TwistWithCovariance"},
    {"sensor_msgs/PointField", "string name\nuint32 offset\nuint8 datatype\nuint32 count", ""},
    {"sensor_msgs/PointCloud2",
     "std_msgs/Header header\nuint32 height\nuint32 width\nPointField[] fields\nbool is_bigendian\n"
     "uint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense",
     "std_msgs/Header sensor_msgs/PointField"},
    {"sensor_msgs/Imu",
     "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\n"
     "float64[9] orientation_covariance\ngeometry_msgs/Vector3 angular_velocity\n"
     "float64[9] angular_velocity_covariance\ngeometry_msgs/Vector3 linear_acceleration\n"
     "float64[9] linear_acceleration_covariance",
     "std_msgs/Header geometry_msgs/Quaternion geometry_msgs/Vector3"},
    {"sensor_msgs/NavSatStatus", "int8 status\nuint16 service", ""},
    {"sensor_msgs/NavSatFix",
     "std_msgs/Header header\nNavSatStatus status\nfloat64 latitude\nfloat64 longitude\n"
     "float64 altitude\nfloat64[9] position_covariance\nuint8 position_covariance_type",
     "std_msgs/Header sensor_msgs/NavSatStatus"},
    {"sensor_msgs/LaserScan",
     "std_msgs/Header header\nfloat32 angle_min\nfloat32 angle_max\nfloat32 angle_increment\n"
     "float32 time_increment\nfloat32 scan_time\nfloat32 range_min\nfloat32 range_max\n"
     "float32[] ranges\nfloat32[] intensities",
     "std_msgs/Header"},
    {"sensor_msgs/JointState",
     "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\n"
     "float64[] effort",
     "std_msgs/Header"},
    {"gps_msgs/GPSStatus",
     "std_msgs/Header header\nuint16 satellites_used\nint32[] satellite_used_prn\n"
     "uint16 satellites_visible\nint32[] satellite_visible_prn\nint32[] satellite_visible_z\n"
     "int32[] satellite_visible_azimuth\nint32[] satellite_visible_snr\nint16 status\n"
     "uint16 motion_source\nuint16 orientation_source\nuint16 position_source",
     "std_msgs/Header"},
    {"gps_msgs/GPSFix",
     "std_msgs/Header header\nGPSStatus status\nfloat64 latitude\nfloat64 longitude\n"
     "float64 altitude\nfloat64 track\nfloat64 speed\nfloat64 climb\nfloat64 pitch\nfloat64 roll\n"
     "float64 dip\nfloat64 time\nfloat64 gdop\nfloat64 pdop\nfloat64 hdop\nfloat64 vdop\n"
     "float64 tdop\nfloat64 err\nfloat64 err_horz\nfloat64 err_vert\nfloat64 err_track\n"
     "float64 err_speed\nfloat64 err_climb\nfloat64 err_time\nfloat64 err_pitch\n"
     "float64 err_roll\nfloat64 err_dip\nfloat64[9] position_covariance\n"
     "uint8 position_covariance_type",
     "std_msgs/Header gps_msgs/GPSStatus"},
    {"nmea_msgs/Sentence", "std_msgs/Header header\nstring sentence", "std_msgs/Header"},
    {"velodyne_msgs/VelodynePacket", "builtin_interfaces/Time stamp\nuint8[1206] data",
     "builtin_interfaces/Time"},
    {"velodyne_msgs/VelodyneScan", "std_msgs/Header header\nVelodynePacket[] packets",
     "std_msgs/Header velodyne_msgs/VelodynePacket"},
    {"pandar_msgs/PandarPacket", "builtin_interfaces/Time stamp\nuint8[1500] data\nuint32 size",
     "builtin_interfaces/Time"},
    {"pandar_msgs/PandarScan", "std_msgs/Header header\npandar_msgs/PandarPacket[] packets",
     "std_msgs/Header pandar_msgs/PandarPacket"},
    {"nebula_msgs/NebulaPacket", "builtin_interfaces/Time stamp\nuint8[] data",
     "builtin_interfaces/Time"},
    {"nebula_msgs/NebulaPackets", "std_msgs/Header header\nNebulaPacket[] packets",
     "std_msgs/Header nebula_msgs/NebulaPacket"},
    {"livox_ros_driver2/CustomPoint",
     "uint32 offset_time\nfloat32 x\nfloat32 y\nfloat32 z\nuint8 reflectivity\nuint8 tag\n"
     "uint8 line",
     ""},
    {"livox_ros_driver2/CustomMsg",
     "std_msgs/Header header\nuint64 timebase\nuint32 point_num\nuint8 lidar_id\nuint8[3] rsvd\n"
     "CustomPoint[] points",
     "std_msgs/Header livox_ros_driver2/CustomPoint"},
    {"ouster_sensor_msgs/PacketMsg", "uint8[] buf", ""},
    {"std_msgs/String", "string data", ""},
}};

const KnownType* known_type(std::string_view name) {
  const auto known = std::find_if(kTypes.begin(), kTypes.end(),
                                  [&](const KnownType& type) { return type.name == name; });
  return known == kTypes.end() ? nullptr : &*known;
}

void add_used(const KnownType& type, std::set<std::string_view>& seen, std::string& text) {
  std::string_view rest = type.uses;
  while (!rest.empty()) {
    const auto blank = rest.find(' ');
    const KnownType* used = known_type(rest.substr(0, blank));
    rest = blank == std::string_view::npos ? std::string_view() : rest.substr(blank + 1);
    if (used == nullptr || !seen.insert(used->name).second) continue;
    text += "\n====\nMSG: " + std::string(used->name) + "\n" + std::string(used->fields);
    add_used(*used, seen, text);
  }
}

}  // namespace

std::string known_definition(std::string_view type) {
  // The drivers' other names for the same messages.
  constexpr std::array<std::pair<std::string_view, std::string_view>, 6> kAlso{
      {{"livox_ros_driver/CustomMsg", "livox_ros_driver2/CustomMsg"},
       {"livox_interfaces/CustomMsg", "livox_ros_driver2/CustomMsg"},
       {"hesai_lidar/PandarScan", "pandar_msgs/PandarScan"},
       {"ouster_msgs/PacketMsg", "ouster_sensor_msgs/PacketMsg"},
       {"ouster_ros/PacketMsg", "ouster_sensor_msgs/PacketMsg"},
       {"tf/tfMessage", "tf2_msgs/TFMessage"}}};
  const KnownType* known = known_type(type);
  for (const auto& [also, name] : kAlso) {
    if (also == type) known = known_type(name);
  }
  if (known == nullptr) return {};
  std::string text;
  std::set<std::string_view> seen{known->name};
  // The first structure has to have the name that was asked for.
  text = std::string(known->fields);
  add_used(*known, seen, text);
  return text;
}

}  // namespace traverse::bags
