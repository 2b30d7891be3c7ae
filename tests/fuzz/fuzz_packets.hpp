#pragma once

#include <cstddef>

#include "traverse/packets/ouster_metadata.hpp"
#include "traverse/packets/packet_lidars.hpp"

/// What the fuzz targets of captures and packets share.
namespace traverse::fuzz {

/// Of a small Ouster, whose packets are soon made up.
inline packets::OusterMetadata small_ouster(packets::OusterProfile profile) {
  constexpr std::size_t kRows = 8;
  packets::OusterMetadata metadata;
  metadata.product = "OS-0";
  metadata.lidar_mode = "512x10";
  metadata.columns = 512;
  metadata.columns_per_packet = 4;
  metadata.profile = profile;
  for (std::size_t row = 0; row < kRows; ++row) {
    metadata.altitude_deg.push_back(20 - 5 * static_cast<double>(row));
    metadata.azimuth_deg.push_back(3 - static_cast<double>(row % 4));
  }
  return metadata;
}

/// Takes what packets give and looks at it.
inline void look_at(packets::PacketMeasurement&& found) {
  if (const auto* scan =
          std::get_if<std::shared_ptr<const sensors::LidarScan>>(&found.measurement)) {
    float sum = 0;
    for (std::size_t i = 0; i < (*scan)->size(); ++i) sum += (*scan)->x[i];
    static_cast<void>(sum);
  }
}

}  // namespace traverse::fuzz
