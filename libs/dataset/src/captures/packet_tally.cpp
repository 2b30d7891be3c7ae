#include "captures/packet_tally.hpp"

#include <fmt/format.h>

#include "recording/note_once.hpp"

namespace traverse::dataset {

void tell_skipped(const char* reason, std::size_t count, std::size_t& told,
                  const std::string& place, SkippedRecords& skipped) {
  for (; told < count; ++told) skipped.add(reason, place);
}

void PacketTally::tell(const packets::PacketLidars& lidars, const std::string& place,
                       SkippedRecords& skipped) {
  const auto add = [&](const char* reason, std::size_t count, std::size_t& told) {
    tell_skipped(reason, count, told, place, skipped);
  };
  const packets::PacketStatistics& found = lidars.statistics();
  add("packet of no sensor that is known", found.unknown, unknown_);
  add("packet of an Ouster without its metadata", found.of_other_ouster, ouster_);
  add("NMEA sentence with a wrong checksum", found.bad_sentences, sentences_);
  add("less than half a turn of a lidar", found.part_sweeps, parts_);
  const std::size_t count = lidars.lidars().size();
  for (auto* counts : {&other_, &damaged_, &late_}) counts->resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const packets::PacketCounts& counts = lidars.counts(i);
    add("packet that is no data of its lidar", counts.other, other_[i]);
    add("damaged packet", counts.damaged, damaged_[i]);
    add("packet that came after its sweep", counts.late, late_[i]);
  }
}

Fact clock_fact(bool is_absolute, const std::string& prefix) {
  return {prefix + "clock", is_absolute ? "the lidar's" : "the lidar's, moved to arrivals",
          is_absolute ? "it agrees with when its packets arrived"
                      : "it is more than a second from when its packets arrived"};
}

void note_packets(const packets::PacketLidars& lidars, std::vector<Fact>& facts) {
  for (std::size_t i = 0; i < lidars.lidars().size(); ++i) {
    const packets::PacketCounts& counts = lidars.counts(i);
    const std::string& label = lidars.lidars()[i].label;
    note_once({(label.starts_with('/') ? "packets of " : "packets of the ") + label,
               fmt::format("{} of returns; {} returns, {} of them a second time at the same "
                           "distance, {} points",
                           counts.data, counts.returns.returns, counts.returns.repeated,
                           counts.returns.points),
               "counted"},
              facts);
  }
  const packets::PacketStatistics& found = lidars.statistics();
  if (found.part_sweeps > 0) {
    note_once({"points of parts of a turn", fmt::format("{}", found.part_sweep_points),
               "less than half a turn at the beginning, the end or a pause: not used"},
              facts);
  }
}

}  // namespace traverse::dataset
