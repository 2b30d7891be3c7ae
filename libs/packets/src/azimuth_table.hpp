#pragma once

#include <array>
#include <cstddef>

namespace traverse::packets {

/// Sines and cosines of all azimuths that packets can hold, hundredths of a degree.
struct AzimuthTable {
  static constexpr std::size_t kTurn = 36000;
  struct Entry {
    float sin;
    float cos;
  };
  std::array<Entry, kTurn> entries;
};

const AzimuthTable& azimuth_table();

}  // namespace traverse::packets
