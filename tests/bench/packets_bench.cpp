// Packets a second of one core, by processor time: full packets, put together to sweeps.

#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "traverse/packets/packet_sweeps.hpp"
#include "traverse/packets/velodyne.hpp"

#include "bench/cpu_seconds.hpp"
#include "packets/made_velodyne_packet.hpp"

namespace traverse::packets {
namespace {

void measure(VelodyneModel model, std::uint8_t factory, double packet_us) {
  constexpr int kPackets = 1'000'000;
  constexpr std::size_t kMade = 800;
  std::vector<testing::MadeVelodynePacket> made;
  for (std::size_t n = 0; n < kMade; ++n) {
    const double us = packet_us * static_cast<double>(n);
    made.emplace_back(std::fmod(us * 3600e-6, 360), 3600e-6 * packet_us / 12,
                      static_cast<std::uint32_t>(us), std::uint8_t{0x37}, factory);
    made.back().fill(20);
    // A tenth of the firings meets nothing.
    for (std::size_t k = n % 10; k < 384; k += 10) made.back().set_return(k / 32, k % 32, 0, 0);
  }
  PacketSweeps sweeps(std::make_unique<VelodyneDecoder>(model, velodyne_lasers(model)), "lidar");
  std::size_t points = 0;
  const PacketSweeps::Sink sink = [&](Sweep&& sweep) { points += sweep.scan.size(); };
  const double seconds = testing::cpu_seconds_of([&] {
    for (int n = 0; n < kPackets; ++n) {
      const std::size_t i = static_cast<std::size_t>(n) % kMade;
      sweeps.add(made[i].bytes(), {1'700'000'000'000'000'000 + std::int64_t{n}}, sink);
    }
    sweeps.finish(sink);
  });
  std::printf("%s: %.0f packets a second, %.1f ns a point\n", std::string(name_of(model)).c_str(),
              kPackets / seconds, 1e9 * seconds / static_cast<double>(points));
}

}  // namespace
}  // namespace traverse::packets

int main() {
  using traverse::packets::VelodyneModel;
  traverse::packets::measure(VelodyneModel::kVlp16, 0x22, 1327.104);
  traverse::packets::measure(VelodyneModel::kHdl32e, 0x21, 552.96);
}
