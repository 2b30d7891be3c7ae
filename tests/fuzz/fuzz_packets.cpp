#include "fuzz/fuzz_packets.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>

/// Payloads of datagrams. The first byte chooses the Ouster that is told, or none. Of each packet
/// the first two bytes tell how long it is and the third in which stream it comes and how much
/// later.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace traverse;
  using packets::OusterProfile;
  constexpr std::array kProfiles{OusterProfile::kLegacy, OusterProfile::kSingle,
                                 OusterProfile::kDual, OusterProfile::kLowBandwidth,
                                 OusterProfile::kDualLowBandwidth};
  constexpr std::size_t kHead = 3;
  if (size == 0) return 0;
  const std::size_t profile = data[0] % (kProfiles.size() + 1);
  packets::PacketLidars lidars(profile < kProfiles.size()
                                   ? std::optional(fuzz::small_ouster(kProfiles.at(profile)))
                                   : std::nullopt);
  packets::Bytes rest(data + 1, size - 1);
  geometry::Stamp arrival{1'700'000'000'000'000'000};
  while (rest.size() >= kHead) {
    const std::size_t length = static_cast<std::size_t>(rest[0]) << 8 | rest[1];
    const std::uint8_t third = rest[2];
    rest = rest.subspan(kHead);
    const packets::Bytes packet = rest.first(std::min(length, rest.size()));
    rest = rest.subspan(packet.size());
    arrival.nanoseconds += std::int64_t{third / 4} * std::int64_t{third / 4} * 100'000;
    lidars.add(std::to_string(third % 4), packet, arrival, fuzz::look_at);
  }
  lidars.finish(fuzz::look_at);
  return 0;
}
