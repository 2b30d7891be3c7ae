#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "traverse/sensors/lidar_scan.hpp"

namespace traverse::packets {

/// Points on their way to the end of a scan: they are put down side by side here, and go over
/// together, so that nothing is asked of the scan's vectors point by point.
class PointRows {
 public:
  static constexpr std::size_t kMost = 1024;

  explicit PointRows(sensors::LidarScan& scan) : scan_(scan) {}
  ~PointRows() { hand_over(); }
  PointRows(const PointRows&) = delete;
  PointRows& operator=(const PointRows&) = delete;

  /// Room for `count` points, kMost at most, is where x() and the others point to.
  void reserve(std::size_t count) {
    if (size_ + count > kMost) hand_over();
  }
  float* x() { return x_.data() + size_; }
  float* y() { return y_.data() + size_; }
  float* z() { return z_.data() + size_; }
  float* intensity() { return intensity_.data() + size_; }
  float* time() { return time_.data() + size_; }
  std::uint16_t* ring() { return ring_.data() + size_; }
  /// The next `points` are filled.
  void take(std::size_t points) { size_ += points; }

 private:
  void hand_over() {
    const auto append = [this](auto& to, const auto& from) {
      to.insert(to.end(), from.data(), from.data() + size_);
    };
    append(scan_.x, x_);
    append(scan_.y, y_);
    append(scan_.z, z_);
    append(scan_.intensity, intensity_);
    append(scan_.time, time_);
    append(scan_.ring, ring_);
    size_ = 0;
  }

  sensors::LidarScan& scan_;
  std::size_t size_ = 0;
  std::array<float, kMost> x_, y_, z_, intensity_, time_;
  std::array<std::uint16_t, kMost> ring_;
};

}  // namespace traverse::packets
