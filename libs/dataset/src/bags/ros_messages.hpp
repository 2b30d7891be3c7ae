#pragma once

#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "traverse/bags/message_value.hpp"
#include "traverse/geometry/pose3.hpp"
#include "traverse/geometry/stamp.hpp"
#include "traverse/sensors/gnss_fix.hpp"
#include "traverse/sensors/imu_sample.hpp"
#include "traverse/sensors/wheel_odometry.hpp"

#include "point_clouds/point_columns.hpp"

namespace traverse::dataset {

/// What a type of message is to a recording.
enum class TopicKind {
  kCloud,       ///< points of a lidar
  kPackets,     ///< of a lidar, as they came over the wire
  kImuPackets,  ///< of an Ouster's IMU; their types do not tell them from those of the lidar
  kImu,
  kGnss,
  kOdometry,  ///< poses of a vehicle: its wheels', or somebody's estimate
  kTwist,     ///< velocities of a vehicle
  kJoints,    ///< angles of joints, which may be a vehicle's wheels
  kPose,      ///< poses without velocities
  kTransforms,
  kOther,
};

/// \param type "sensor_msgs/PointCloud2"
TopicKind kind_of_type(std::string_view type);

/// Why nothing is made of messages of a type that somebody may expect to be read; empty: there is
/// no more to say.
std::string_view why_unused(std::string_view type);

/// A message that follows its definition but cannot be used.
class UnusableMessage : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Stamp and frame of a header; nothing where the stamp is zero.
std::optional<geometry::Stamp> header_stamp(const bags::MessageValue& message);
std::string header_frame(const bags::MessageValue& message);

/// The points of a sensor_msgs/PointCloud2, any layout and byte order, or of a CustomMsg of Livox.
/// They refer to the bytes of the message.
/// \throws UnusableMessage if the fields reach beyond a point or the points beyond the data
PointColumns columns_of(std::string_view type, const bags::MessageValue& message);

/// Without stamp and sensor, as all here. \throws UnusableMessage
sensors::ImuSample imu_sample_of(const bags::MessageValue& message);
/// Of NavSatFix, GPSFix (gps_msgs, gps_common) or a Sentence of NMEA 0183 with GGA.
sensors::GnssFix gnss_fix_of(std::string_view type, const bags::MessageValue& message);
/// Of Odometry, or of a stamped twist.
sensors::WheelOdometry wheel_odometry_of(TopicKind kind, const bags::MessageValue& message);
/// T_frame_child of Odometry, PoseStamped or PoseWithCovarianceStamped.
geometry::Pose3 pose_of(const bags::MessageValue& message);
/// Calls `use` with parent, child, T_parent_child and stamp of each transform.
void for_each_transform(const bags::MessageValue& message,
                        const std::function<void(const std::string&, const std::string&,
                                                 const geometry::Pose3&, geometry::Stamp)>& use);

}  // namespace traverse::dataset
