#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "traverse/packets/packet_decoder.hpp"

namespace traverse::packets {

enum class HesaiModel { kPandar40p, kPandar64, kXt16, kXt32, kQt64, kPandar128 };

/// "Pandar64"
std::string_view name_of(HesaiModel model);

/// How a laser of a Hesai looks out of the head.
struct HesaiLaser {
  double elevation_deg = 0;
  double azimuth_deg = 0;  ///< added to the head's azimuth
};

/// The model by size and header; nothing: no data packet of one that is known.
std::optional<HesaiModel> hesai_model(Bytes packet);

/// The lasers by channel, as the files cited beside the tables have them. Units differ by some
/// hundredths of a degree, which is in the file that comes with each.
std::vector<HesaiLaser> hesai_lasers(HesaiModel model);

/// When a channel fires after its block's time [us].
double hesai_firing_us(HesaiModel model, std::size_t channel);

/// Makes points of packets. Layout and firing times are those of tier4/nebula 606ac41,
/// nebula_hesai_decoders/decoders, and were not held against the maker's manuals.
class HesaiDecoder : public PacketDecoder {
 public:
  /// \throws std::invalid_argument if the model has another number of lasers
  HesaiDecoder(HesaiModel model, const std::vector<HesaiLaser>& lasers);

  PacketKind outline(Bytes packet, PacketOutline& outline) override;
  ReturnCounts append(Bytes packet, const PacketOutline& outline, std::size_t first,
                      std::size_t last, double zero_s, sensors::LidarScan& scan) const override;

 private:
  static constexpr std::size_t kMostChannels = 128;
  using Row = std::array<float, kMostChannels>;

  HesaiModel model_;
  Row sin_elevation_{}, cos_elevation_{}, sin_azimuth_{}, cos_azimuth_{};
  /// Of each channel; of a Pandar128 by the state of the block's azimuth, standard and high
  /// resolution, far and near.
  struct Delays {
    Row far_us{};
    Row near_us{};
  };
  std::vector<Delays> delays_;
};

}  // namespace traverse::packets
