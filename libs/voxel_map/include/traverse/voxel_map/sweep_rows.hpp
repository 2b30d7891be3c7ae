#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "traverse/lidar/scan_lines.hpp"
#include "traverse/sensors/lidar_profile.hpp"
#include "traverse/sensors/lidar_scan.hpp"

namespace traverse::voxel_map {

/// Neighbouring points of one sweep in the order of their azimuth: what one beam saw, or, for a
/// cloud without rings, one row of its range image.
struct Row {
  const float *x, *y, *z, *range;  ///< metres, as recorded, from where its lidar looks
  const float* time;               ///< seconds after the stamp; null when the scan stores none
  const std::uint32_t* source;     ///< index in the scan; null: the row is the scan from `begin` on
  std::size_t begin;
  std::size_t size;
  std::size_t lidar = 0;         ///< of the profile's lidars_in_scan
  float ox = 0, oy = 0, oz = 0;  ///< what to add to x, y, z for the scan's frame

  std::uint32_t source_of(std::size_t i) const {
    return source != nullptr ? source[i] : static_cast<std::uint32_t>(begin + i);
  }
};

/// The rows of a scan. A scan stored ring after ring without missing returns is only looked at, not
/// copied; any other is sorted. Points too near or too far stay in their row, so that they still
/// part what stands on either side of them, and are counted; missing returns (not finite, or at the
/// origin) and points whose ring is beyond the profile's count are left out and counted.
///
/// Rings come from where the profile says. When it says nothing that works (no ring numbers stored,
/// no elevation table), rows are cut from a range image: kRangeImageRows bands of elevation, or as
/// many as the profile has rings, each sorted by azimuth.
///
/// Where several lidars' returns make the scan, each looks from its own place: what stands before
/// what, how far a beam spreads and where a pole's axis lies are told from there.
class SweepRows {
 public:
  static constexpr std::size_t kRangeImageRows = 64;

  /// Refers to `scan`, which must outlive it.
  SweepRows(const sensors::LidarScan& scan, const sensors::LidarProfile& profile);

  std::size_t count() const { return row_begin_.size() - 1; }
  Row row(std::size_t k) const;
  const lidar::DroppedPoints& dropped() const { return dropped_; }
  bool from_range_image() const { return from_range_image_; }

 private:
  std::vector<std::uint16_t> range_image_rows(const sensors::LidarProfile& profile) const;
  void sort_rows(const std::vector<std::uint16_t>& ring, std::size_t rings);
  void sort_by_azimuth();
  std::size_t lidar_of(std::size_t ring) const;
  void look_from_own_lidars();

  const sensors::LidarScan& scan_;
  std::vector<sensors::LidarInScan> lidars_;
  lidar::DroppedPoints dropped_;
  bool borrowed_ = false;
  bool from_range_image_ = false;
  std::vector<std::uint32_t> row_begin_{0};
  std::vector<float> range_;             // of every point of the scan when borrowed
  std::vector<float> x_, y_, z_, time_;  // sorted; of several lidars: from their own places
  std::vector<std::uint32_t> source_;    // sorted
};

}  // namespace traverse::voxel_map
