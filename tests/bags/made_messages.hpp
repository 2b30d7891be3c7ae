#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "traverse/bags/message_writer.hpp"

/// Messages as ROS 1 and ROS 2 write them, made by tests.
namespace traverse::testing {

using bags::MessageWriter;
using bags::Wire;

/// Definitions as `rosmsg show` and ROS 2's own files have them.
std::string definition_text(std::string_view type, Wire wire);

std::string imu_message(Wire wire, std::int64_t ns, std::string_view frame, const double (&rate)[3],
                        const double (&force)[3]);

struct MadePacket {
  std::int64_t ns = 0;
  std::string bytes;
};
/// \param type a VelodyneScan, PandarScan or NebulaPackets, or a PacketMsg, which holds the first
std::string packets_message(std::string_view type, Wire wire, std::int64_t ns,
                            std::string_view frame, const std::vector<MadePacket>& packets);

struct FieldOfPoints {
  std::string name;
  std::uint32_t offset = 0;
  int datatype = 7;  ///< 1 to 8: int8, uint8, int16, uint16, int32, uint32, float32, float64
};
struct CloudMessage {
  std::vector<FieldOfPoints> fields;
  std::uint32_t height = 1;
  std::uint32_t width = 0;
  std::uint32_t point_step = 0;
  std::uint32_t row_step = 0;
  bool is_bigendian = false;
  std::string data;
};
std::string cloud_message(Wire wire, std::int64_t ns, std::string_view frame,
                          const CloudMessage& cloud);

/// \param variances of east, north and up [m^2]
std::string fix_message(Wire wire, std::int64_t ns, std::string_view frame, int status,
                        double latitude, double longitude, double altitude,
                        const double (&variances)[3] = {4, 4, 9});

struct TransformOf {
  std::string parent;
  std::string child;
  double xyz[3] = {0, 0, 0};
  double quaternion_xyzw[4] = {0, 0, 0, 1};
};
std::string transforms_message(Wire wire, std::int64_t ns, const std::vector<TransformOf>& all);

std::string odometry_message(Wire wire, std::int64_t ns, std::string_view frame,
                             std::string_view child, const double (&xyz)[3],
                             const double (&quaternion_xyzw)[4], double forward, double yaw_rate);

struct JointOf {
  std::string name;
  double position = 0;
};
/// \param has_positions else the message tells velocities only
std::string joints_message(Wire wire, std::int64_t ns, const std::vector<JointOf>& joints,
                           bool has_positions = true);

}  // namespace traverse::testing
