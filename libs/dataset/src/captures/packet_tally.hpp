#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "traverse/dataset/source.hpp"
#include "traverse/packets/packet_lidars.hpp"

namespace traverse::dataset {

/// Tells packets that could not be used as records that were skipped, each once.
class PacketTally {
 public:
  /// Adds what `lidars` counted since the last call. \param place of what was read since
  void tell(const packets::PacketLidars& lidars, const std::string& place, SkippedRecords& skipped);

 private:
  std::size_t unknown_ = 0, ouster_ = 0, sentences_ = 0, parts_ = 0;
  std::vector<std::size_t> other_, damaged_, late_;  ///< of each lidar
};

/// Tells `count` records of which `told` have been told already.
void tell_skipped(const char* reason, std::size_t count, std::size_t& told,
                  const std::string& place, SkippedRecords& skipped);

/// Why nothing that is stated of fields of points holds of packets.
inline constexpr const char* kPacketsTellAll = "packets tell ring and time of each firing";

/// Whose clock the stamps of a lidar's scans are of. \param prefix as in add_profile_facts()
Fact clock_fact(bool is_absolute, const std::string& prefix);

/// When all was read: packets and returns in, points out.
void note_packets(const packets::PacketLidars& lidars, std::vector<Fact>& facts);

}  // namespace traverse::dataset
