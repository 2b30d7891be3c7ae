#include "written_definitions.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <stdexcept>

namespace traverse::bags {

namespace {

struct WrittenType {
  std::string_view name;
  std::string_view fields;  ///< "$T" is a time, "$H" what a header has before it
  std::string_view uses;    ///< other types of the table, blanks between
  std::string_view digest;  ///< of the type in ROS 1; empty of those that only others use
};

// Common definitions of ROS (std_msgs, geometry_msgs, sensor_msgs, nav_msgs, tf2_msgs) with all of
// their constants, because these count in the digest, and two of our own for what no common message
// can hold.
constexpr std::array<WrittenType, 21> kWritten{{
    {"std_msgs/Header", "$H$T stamp\nstring frame_id", "$T", ""},
    {"builtin_interfaces/Time", "int32 sec\nuint32 nanosec", "", ""},
    {"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z", "", ""},
    {"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z", "", ""},
    {"geometry_msgs/Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w", "", ""},
    {"geometry_msgs/Pose", "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation",
     "geometry_msgs/Point geometry_msgs/Quaternion", ""},
    {"geometry_msgs/PoseWithCovariance", "geometry_msgs/Pose pose\nfloat64[36] covariance",
     "geometry_msgs/Pose", ""},
    {"geometry_msgs/Twist", "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular",
     "geometry_msgs/Vector3", ""},
    {"geometry_msgs/TwistWithCovariance", "geometry_msgs/Twist twist\nfloat64[36] covariance",
     "geometry_msgs/Twist", ""},
    {"geometry_msgs/Transform",
     "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation",
     "geometry_msgs/Vector3 geometry_msgs/Quaternion", ""},
    {"geometry_msgs/TransformStamped",
     "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform",
     "std_msgs/Header geometry_msgs/Transform", ""},
    {"tf2_msgs/TFMessage", "geometry_msgs/TransformStamped[] transforms",
     "geometry_msgs/TransformStamped", "94810edda583a504dfda3829e70d7eec"},
    {"nav_msgs/Odometry",
     "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n"
     "geometry_msgs/TwistWithCovariance twist",
     "std_msgs/Header geometry_msgs/PoseWithCovariance geometry_msgs/TwistWithCovariance",
     "cd5e73d190d741a2f92e81eda573aca7"},
    {"sensor_msgs/PointField",
     "uint8 INT8=1\nuint8 UINT8=2\nuint8 INT16=3\nuint8 UINT16=4\nuint8 INT32=5\nuint8 UINT32=6\n"
     "uint8 FLOAT32=7\nuint8 FLOAT64=8\nstring name\nuint32 offset\nuint8 datatype\nuint32 count",
     "", ""},
    {"sensor_msgs/PointCloud2",
     "std_msgs/Header header\nuint32 height\nuint32 width\nsensor_msgs/PointField[] fields\n"
     "bool is_bigendian\nuint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense",
     "std_msgs/Header sensor_msgs/PointField", "1158d486dd51d683ce2f1be655c3c181"},
    {"sensor_msgs/Imu",
     "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\n"
     "float64[9] orientation_covariance\ngeometry_msgs/Vector3 angular_velocity\n"
     "float64[9] angular_velocity_covariance\ngeometry_msgs/Vector3 linear_acceleration\n"
     "float64[9] linear_acceleration_covariance",
     "std_msgs/Header geometry_msgs/Quaternion geometry_msgs/Vector3",
     "6a62c6daae103f4ff57a132d6f95cec2"},
    {"sensor_msgs/LaserScan",
     "std_msgs/Header header\nfloat32 angle_min\nfloat32 angle_max\nfloat32 angle_increment\n"
     "float32 time_increment\nfloat32 scan_time\nfloat32 range_min\nfloat32 range_max\n"
     "float32[] ranges\nfloat32[] intensities",
     "std_msgs/Header", "90c7ef2dc6895d81024acba2ac42f369"},
    {"sensor_msgs/NavSatStatus",
     "int8 STATUS_NO_FIX=-1\nint8 STATUS_FIX=0\nint8 STATUS_SBAS_FIX=1\nint8 STATUS_GBAS_FIX=2\n"
     "int8 status\nuint16 SERVICE_GPS=1\nuint16 SERVICE_GLONASS=2\nuint16 SERVICE_COMPASS=4\n"
     "uint16 SERVICE_GALILEO=8\nuint16 service",
     "", ""},
    {"sensor_msgs/NavSatFix",
     "std_msgs/Header header\nsensor_msgs/NavSatStatus status\nfloat64 latitude\n"
     "float64 longitude\nfloat64 altitude\nfloat64[9] position_covariance\n"
     "uint8 COVARIANCE_TYPE_UNKNOWN=0\nuint8 COVARIANCE_TYPE_APPROXIMATED=1\n"
     "uint8 COVARIANCE_TYPE_DIAGONAL_KNOWN=2\nuint8 COVARIANCE_TYPE_KNOWN=3\n"
     "uint8 position_covariance_type",
     "std_msgs/Header sensor_msgs/NavSatStatus", "2d3a8cd499b9b4a0249fb98fd05cfa48"},
    {kGnssHeadingType, "std_msgs/Header header\nfloat64 heading_deg", "std_msgs/Header",
     "e978bf01bd2567b0831121f55538f769"},
    {kWheelPulsesType, "std_msgs/Header header\nint64 left\nint64 right", "std_msgs/Header",
     "82342e527a66bde1272594b975713bf2"},
}};

const WrittenType& written_type(std::string_view name) {
  const auto known = std::find_if(kWritten.begin(), kWritten.end(),
                                  [&](const WrittenType& type) { return type.name == name; });
  if (known == kWritten.end()) {
    throw std::invalid_argument("no definition of " + std::string(name) + " to write");
  }
  return *known;
}

std::string fields_of(const WrittenType& type, Wire wire) {
  const bool is_ros1 = wire == Wire::kRos1;
  std::string text(type.fields);
  const auto replace = [&](std::string_view mark, std::string_view by) {
    const auto at = text.find(mark);
    if (at != std::string::npos) text.replace(at, mark.size(), by);
  };
  replace("$H", is_ros1 ? "uint32 seq\n" : "");
  replace("$T", is_ros1 ? "time" : "builtin_interfaces/Time");
  return text + "\n";
}

void add_types_used_by(const WrittenType& type, Wire wire, std::set<std::string_view>& seen,
                       std::string& text) {
  constexpr std::size_t kRule = 80;  // readers split by exactly so many
  std::string_view rest = type.uses;
  while (!rest.empty()) {
    const auto blank = rest.find(' ');
    std::string_view name = rest.substr(0, blank);
    rest = blank == std::string_view::npos ? std::string_view() : rest.substr(blank + 1);
    if (name == "$T") {
      if (wire == Wire::kRos1) continue;  // there a time is no message
      name = "builtin_interfaces/Time";
    }
    const WrittenType& used = written_type(name);
    if (!seen.insert(used.name).second) continue;
    text +=
        std::string(kRule, '=') + "\nMSG: " + std::string(used.name) + "\n" + fields_of(used, wire);
    add_types_used_by(used, wire, seen, text);
  }
}

}  // namespace

std::string written_definition(std::string_view type, Wire wire) {
  const WrittenType& known = written_type(type);
  std::set<std::string_view> seen{known.name};
  std::string text = fields_of(known, wire);
  add_types_used_by(known, wire, seen, text);
  return text;
}

std::string_view ros1_digest(std::string_view type) {
  const WrittenType& known = written_type(type);
  if (known.digest.empty()) {
    throw std::invalid_argument(std::string(type) + " is written in other messages only");
  }
  return known.digest;
}

}  // namespace traverse::bags
