#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "traverse/packets/velodyne.hpp"

namespace traverse::testing {

/// A data packet, built byte by byte as the manual draws it.
class MadeVelodynePacket {
 public:
  /// \param turn_deg from one block to the next \param model as the factory byte names it
  MadeVelodynePacket(double first_deg, double turn_deg, std::uint32_t us, std::uint8_t mode = 0x37,
                     std::uint8_t model = 0x22) {
    for (std::size_t block = 0; block < 12; ++block) {
      set_flag(block, 0xEEFF);
      set_azimuth(block, first_deg + turn_deg * static_cast<double>(block));
    }
    for (std::size_t i = 0; i < 4; ++i) bytes_[1200 + i] = static_cast<std::uint8_t>(us >> 8 * i);
    bytes_[1204] = mode;
    bytes_[1205] = model;
  }
  void set_flag(std::size_t block, std::uint16_t flag) { put(100 * block, flag); }
  void set_azimuth(std::size_t block, double deg) {
    put(100 * block + 2, static_cast<std::uint16_t>(std::lround(100 * deg) % 36000));
  }
  void set_return(std::size_t block, std::size_t k, double distance_m, std::uint8_t intensity) {
    put(100 * block + 4 + 3 * k, static_cast<std::uint16_t>(std::lround(distance_m / 0.002)));
    bytes_[100 * block + 4 + 3 * k + 2] = intensity;
  }
  void fill(double distance_m) {
    for (std::size_t block = 0; block < 12; ++block) {
      for (std::size_t k = 0; k < 32; ++k) set_return(block, k, distance_m, 7);
    }
  }
  packets::VelodynePacket bytes() const { return packets::VelodynePacket(bytes_); }

 private:
  void put(std::size_t at, std::uint16_t value) {
    bytes_[at] = static_cast<std::uint8_t>(value & 255);
    bytes_[at + 1] = static_cast<std::uint8_t>(value >> 8);
  }

  std::array<std::uint8_t, packets::kVelodynePacketBytes> bytes_{};
};

}  // namespace traverse::testing
