#include "velodyne_position.hpp"

#include "byte_fields.hpp"

namespace traverse::packets {

std::optional<VelodynePosition> decode_velodyne_position(Bytes packet) {
  constexpr std::size_t kTimestampAt = 198;
  constexpr std::size_t kSentenceAt = 206;
  if (packet.size() != kVelodynePositionBytes) return std::nullopt;
  VelodynePosition position;
  position.microseconds = u32_at(packet.data() + kTimestampAt);
  for (std::size_t i = kSentenceAt; i < packet.size(); ++i) {
    const auto c = static_cast<char>(packet[i]);
    if (c < ' ' || c > '~') break;
    position.sentence.push_back(c);
  }
  return position;
}

}  // namespace traverse::packets
