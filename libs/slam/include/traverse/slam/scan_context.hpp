#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "traverse/config/binder.hpp"

namespace traverse::slam {

struct ScanContextOptions {
  int rings = 20;       ///< of the ground plane around the sensor
  int sectors = 60;     ///< of each ring
  double reach_m = 80;  ///< of the outermost ring
  double floor_m = 2;   ///< added to heights, so that the ground below the sensor is near zero
};
void bind(config::Binder& binder, ScanContextOptions& options);

/// What a place looks like from above: the greatest height in each bin of a polar grid around the
/// sensor. Turning the sensor shifts its columns, and standing beside the old track changes it
/// little, which is why it and not, say, a histogram of the whole scan is used: the shift also
/// tells the heading. Source: Kim and Kim, "Scan Context: Egocentric spatial descriptor for place
/// recognition within 3D point cloud map", IROS 2018, sections III-A to III-C.
class ScanContext {
 public:
  ScanContext() = default;
  /// \param x, y, z metres, deskewed, in a frame whose z is about upright
  ScanContext(std::span<const float> x, std::span<const float> y, std::span<const float> z,
              const ScanContextOptions& options);

  /// The share of sectors in each ring that hold a point: the same for any heading (eq. 8).
  const std::vector<float>& ring_key() const { return ring_key_; }

  struct Match {
    double distance = 1;  ///< 0 the same .. 1 nothing in common
    double turn_rad = 0;  ///< about z: to the frame of the first from that of the second
  };
  /// The least distance over all shifts: one minus the mean cosine of columns that both have
  /// (eqs. 6 and 7). Both contexts must come from equal options.
  static Match compare(const ScanContext& first, const ScanContext& second);

 private:
  std::size_t rings_ = 0;
  std::size_t sectors_ = 0;
  std::vector<float> heights_;  ///< [sector * rings + ring]; columns of unit length, or zero
  std::vector<float> ring_key_;
};

}  // namespace traverse::slam
