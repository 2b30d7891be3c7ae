#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "traverse/geometry/stamp.hpp"
#include "traverse/packets/ouster_metadata.hpp"
#include "traverse/packets/packet_sweeps.hpp"
#include "traverse/sensors/lidar_profile.hpp"
#include "traverse/sensors/measurement.hpp"

namespace traverse::packets {

/// A lidar that was found among packets.
struct PacketLidar {
  std::string label;  ///< of its scans: "lidar", "lidar 2"
  std::string model;  ///< "VLP-16"
  std::string maker;  ///< "Velodyne"
  sensors::LidarProfile profile;
};

/// What a stream of packets gives. A sweep of less than half a turn, with which a recording begins
/// or ends, is not given out but counted.
struct PacketMeasurement {
  sensors::Measurement measurement;
  std::size_t lidar = 0;  ///< index into lidars(), for scans
};

/// What was found among packets, for the user.
struct PacketStatistics {
  std::size_t packets = 0;
  std::size_t unknown = 0;          ///< of no sensor that is known
  std::size_t of_other_ouster = 0;  ///< that look like an Ouster's, but not of this metadata
  std::size_t positions = 0;        ///< a Velodyne's, with or without a sentence
  std::size_t sentences = 0;        ///< NMEA sentences that say something new
  std::size_t bad_sentences = 0;    ///< whose checksum is wrong
  std::size_t fixes = 0;
  std::size_t imu = 0;
  std::size_t part_sweeps = 0;  ///< less than half a turn
  std::size_t part_sweep_points = 0;
  /// Of the lidar's microseconds against the second of the sentences, at most [s]; a receiver tells
  /// its second within it.
  std::optional<double> clock_apart_s;
};

/// Takes packets as they come, from a capture or from messages of a bag, finds out which sensor
/// each stream is of, and gives scans, fixes and readings of IMUs.
///
///     PacketLidars lidars;
///     for (const auto& packet : message.packets) {
///       lidars.add(topic, packet.data, packet.stamp, [&](PacketMeasurement&& m) { ... });
///     }
///     lidars.finish(sink);
class PacketLidars {
 public:
  using Sink = std::function<void(PacketMeasurement&&)>;
  static constexpr const char* kImu = "imu";
  static constexpr const char* kGnss = "gnss";

  /// \param ouster of the Ouster whose packets are among them, if one's are
  /// \param label of the first lidar, to which others add their number
  explicit PacketLidars(std::optional<OusterMetadata> ouster = std::nullopt,
                        std::string label = "lidar");
  ~PacketLidars();
  PacketLidars(PacketLidars&&) noexcept;
  PacketLidars& operator=(PacketLidars&&) noexcept;

  /// \param stream that the packet belongs to: packets of one lidar come in one
  /// \param arrival where the packet was recorded
  void add(const std::string& stream, Bytes packet, geometry::Stamp arrival, const Sink& sink);
  /// Gives what was not over.
  void finish(const Sink& sink);

  const std::vector<PacketLidar>& lidars() const { return lidars_; }
  const PacketCounts& counts(std::size_t lidar) const;
  const SensorClock& clock(std::size_t lidar) const;
  const PacketStatistics& statistics() const { return statistics_; }

 private:
  struct Stream;

  Stream* stream_for(const std::string& name, Bytes packet);
  void add_position(Bytes packet, geometry::Stamp arrival, const Sink& sink);
  void add_imu(Bytes packet, geometry::Stamp arrival, const Sink& sink);
  PacketSweeps::Sink scans_to(std::size_t lidar, const Sink& sink);

  std::optional<OusterMetadata> ouster_;
  std::string label_;
  std::map<std::string, std::unique_ptr<Stream>> streams_;
  std::vector<Stream*> by_lidar_;
  std::vector<PacketLidar> lidars_;
  PacketStatistics statistics_;
  SensorClock ouster_clock_;
  std::string last_sentence_;
  std::optional<double> last_altitude_;
};

/// Whether a packet looks like one of an Ouster, of whatever metadata: for a message that says what
/// is missing.
bool looks_like_ouster(Bytes packet);

}  // namespace traverse::packets
