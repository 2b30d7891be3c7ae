#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "traverse/sensors/measurement.hpp"

namespace traverse::dataset {

/// Puts measurements that arrive a little late in their place: a scan is stored when it is over but
/// stamped before. A measurement comes out when one arrives that is later by kSpan, or when too
/// many wait; equal stamps keep their order. One stamp that is far off disturbs only itself.
class ReorderWindow {
 public:
  static constexpr double kSpan = 0.25;  ///< seconds, more than two sweeps of a lidar
  static constexpr std::size_t kMost = 1000;
  static constexpr std::size_t kMostScans = 16;  ///< of lidars: these are megabytes each

  struct Entry {
    sensors::Measurement measurement;
    std::string place;
    std::uint64_t arrival = 0;  ///< its number among all that arrived
  };

  void push(Entry entry) {
    newest_ = sensors::stamp_of(entry.measurement);
    scans_ += is_scan(entry) ? 1 : 0;
    const std::pair at(newest_, entry.arrival);
    waiting_.emplace(at, std::move(entry));
  }

  /// The earliest, if it may come out; with `flush` also if it may not.
  std::optional<Entry> pop(bool flush) {
    if (waiting_.empty()) return std::nullopt;
    const auto first = waiting_.begin();
    const bool is_due = geometry::seconds_between(first->first.first, newest_) >= kSpan ||
                        waiting_.size() > kMost || scans_ > kMostScans;
    if (!is_due && !flush) return std::nullopt;
    Entry entry = std::move(first->second);
    waiting_.erase(first);
    scans_ -= is_scan(entry) ? 1 : 0;
    return entry;
  }

 private:
  static bool is_scan(const Entry& entry) {
    return std::holds_alternative<std::shared_ptr<const sensors::LidarScan>>(entry.measurement);
  }

  std::multimap<std::pair<geometry::Stamp, std::uint64_t>, Entry> waiting_;
  std::size_t scans_ = 0;   ///< of lidars that wait
  geometry::Stamp newest_;  ///< of what arrived last
};

}  // namespace traverse::dataset
