#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>

namespace traverse::bags {

/// How messages are written: ROS 1's serialization, or CDR in either byte order.
enum class Wire { kRos1, kCdr, kCdrBigEndian };

/// Messages of our own, for what no common message of ROS can hold; bags carry their definitions. A
/// heading in degrees clockwise from true north, and encoder pulses since the start.
inline constexpr std::string_view kGnssHeadingType = "traverse_msgs/GnssHeading";
inline constexpr std::string_view kWheelPulsesType = "traverse_msgs/WheelPulses";

/// Writes the values of a message one after the other, aligned as the wire wants it.
/// Source: wiki.ros.org/msg; OMG DDS-RTPS, CDR with its header of four bytes.
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
    std::array<char, sizeof(Number)> raw;
    std::memcpy(raw.data(), &value, raw.size());
    if (wire_ == Wire::kCdrBigEndian) std::reverse(raw.begin(), raw.end());
    bytes_.append(raw.data(), raw.size());
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
  /// With their count.
  MessageWriter& bytes(std::string_view value) {
    u32(value.size());
    bytes_ += value;
    return *this;
  }
  MessageWriter& time(std::int64_t ns) {
    return u32(static_cast<std::uint64_t>(ns / 1'000'000'000))
        .u32(static_cast<std::uint64_t>(ns % 1'000'000'000));
  }
  /// std_msgs/Header. \param number of ROS 1, which ROS 2 has not
  MessageWriter& header(std::int64_t ns, std::string_view frame, std::uint32_t number = 0) {
    if (wire_ == Wire::kRos1) u32(number);
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

}  // namespace traverse::bags
