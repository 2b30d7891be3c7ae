#include <string>

#include "traverse/files/input_error.hpp"
#include "traverse/packets/udp_capture.hpp"

#include "fuzz/fuzz_packets.hpp"
#include "fuzz/input_in_memory.hpp"

/// A capture, as any recorder writes it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace traverse;
  static const packets::OusterMetadata ouster = fuzz::small_ouster(packets::OusterProfile::kSingle);
  const fuzz::InputInMemory input(data, size);
  try {
    packets::UdpCapture capture(input.path());
    packets::PacketLidars lidars(ouster);
    while (const auto datagram = capture.next()) {
      lidars.add(std::to_string(datagram->target_port), datagram->payload, datagram->arrival,
                 fuzz::look_at);
    }
    lidars.finish(fuzz::look_at);
  } catch (const files::InputError&) {
  }
  return 0;
}
