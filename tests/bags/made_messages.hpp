#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

/// Messages as ROS 1 and ROS 2 write them, made by tests.
namespace traverse::testing {

enum class Wire { kRos1, kCdr, kCdrBigEndian };

/// Writes the values of a message one after the other, aligned as the wire wants it.
class MessageWriter {
 public:
  explicit MessageWriter(Wire wire) : wire_(wire) {
    if (wire != Wire::kRos1) bytes_ = {'\0', wire == Wire::kCdr ? '\1' : '\0', '\0', '\0'};
    begin_ = bytes_.size();
  }

  template <typename Number>
  MessageWriter& number(Number value) {
    if (wire_ != Wire::kRos1) {
      while ((bytes_.size() - begin_) % sizeof(Number) != 0) bytes_ += '\0';
    }
    char raw[sizeof(Number)];
    std::memcpy(raw, &value, sizeof raw);
    if (wire_ == Wire::kCdrBigEndian) std::reverse(raw, raw + sizeof raw);
    bytes_.append(raw, sizeof raw);
    return *this;
  }
  MessageWriter& u8(int value) { return number(static_cast<std::uint8_t>(value)); }
  MessageWriter& u32(std::uint64_t value) { return number(static_cast<std::uint32_t>(value)); }
  MessageWriter& f64(double value) { return number(value); }
  MessageWriter& text(std::string_view value) {
    const bool has_end = wire_ != Wire::kRos1;
    u32(value.size() + (has_end ? 1 : 0));
    bytes_ += value;
    if (has_end) bytes_ += '\0';
    return *this;
  }
  MessageWriter& bytes(std::string_view value) {
    u32(value.size());
    bytes_ += value;
    return *this;
  }
  MessageWriter& time(std::int64_t ns) {
    return u32(static_cast<std::uint64_t>(ns / 1'000'000'000))
        .u32(static_cast<std::uint64_t>(ns % 1'000'000'000));
  }
  MessageWriter& header(std::int64_t ns, std::string_view frame) {
    if (wire_ == Wire::kRos1) u32(7);  // its number, which ROS 2 has not
    return time(ns).text(frame);
  }
  template <typename... Number>
  MessageWriter& all(Number... values) {
    (f64(values), ...);
    return *this;
  }
  MessageWriter& zeros(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) f64(0);
    return *this;
  }

  Wire wire() const { return wire_; }
  std::string take() { return std::move(bytes_); }

 private:
  Wire wire_;
  std::string bytes_;
  std::size_t begin_ = 0;
};

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

std::string fix_message(Wire wire, std::int64_t ns, std::string_view frame, int status,
                        double latitude, double longitude, double altitude);

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
