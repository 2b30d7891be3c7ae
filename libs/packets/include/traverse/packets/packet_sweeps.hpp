#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "traverse/geometry/stamp.hpp"
#include "traverse/packets/packet_decoder.hpp"
#include "traverse/packets/sensor_clock.hpp"

namespace traverse::packets {

/// What came in and what went out.
struct PacketCounts {
  std::size_t packets = 0;
  std::size_t data = 0;     ///< packets of returns
  std::size_t other = 0;    ///< of another size or beginning
  std::size_t damaged = 0;  ///< begin like data and contradict themselves
  std::size_t late = 0;     ///< of a sweep that was given out already
  ReturnCounts returns;     ///< of packets of returns that are not late
};

/// A turn of the head, or the part of one that was recorded.
struct Sweep {
  sensors::LidarScan scan;  ///< its stamp is that of its first firing
  double turned_deg = 0;
};

/// Puts packets together to sweeps, which begin where the head passes a fixed azimuth or where the
/// sensor says so (Ouster's frames), or after a quarter of a second without packets.
class PacketSweeps {
 public:
  using Sink = std::function<void(Sweep&&)>;

  /// \param label of the scans \param seam_azimuth_deg in the sense of the turn; behind: 180
  PacketSweeps(std::unique_ptr<PacketDecoder> decoder, std::string label,
               double seam_azimuth_deg = 180);

  /// Takes the next packet, and gives the sweeps that end with it to `sink`.
  /// \param arrival of the packet where it was recorded
  void add(Bytes packet, geometry::Stamp arrival, const Sink& sink);
  /// Gives the sweep that is not over.
  void finish(const Sink& sink);

  const PacketCounts& counts() const { return counts_; }
  const SensorClock& clock() const { return clock_; }
  /// For what else the sensor stamps by the same clock.
  SensorClock& clock() { return clock_; }

 private:
  bool begins_sweep(std::int32_t azimuth);
  void close(const Sink& sink);

  std::unique_ptr<PacketDecoder> decoder_;
  std::string label_;
  std::int32_t seam_;
  SensorClock clock_;
  PacketOutline outline_;
  PacketCounts counts_;

  Sweep sweep_;
  std::size_t usual_points_ = 0;
  bool is_open_ = false;
  std::optional<std::int32_t> last_turned_;
  std::int64_t turned_ = 0;  ///< in this sweep
  std::optional<std::uint32_t> frame_;
  std::optional<geometry::Stamp> last_stamp_;
};

}  // namespace traverse::packets
