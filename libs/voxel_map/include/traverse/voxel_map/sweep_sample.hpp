#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "traverse/geometry/stamp.hpp"
#include "traverse/lidar/feature_class.hpp"
#include "traverse/parallel/workers.hpp"
#include "traverse/sensors/lidar_profile.hpp"
#include "traverse/sensors/lidar_scan.hpp"
#include "traverse/voxel_map/row_walk.hpp"
#include "traverse/voxel_map/sweep_points.hpp"

namespace traverse::voxel_map {

/// What the odometry keeps of one scan.
struct SweepSample {
  geometry::Stamp stamp;
  std::size_t points = 0;  ///< of the scan, usable or not
  lidar::DroppedPoints dropped;
  bool from_range_image = false;  ///< the scan has no rings
  bool timed = false;             ///< false: point times are not known and all zero
  double middle_s = 0;            ///< what point times count from, seconds after the stamp

  SweepPoints surface;  ///< for the map: planar points and rough ones
  std::vector<std::uint8_t> surface_is_planar;
  SweepPoints planar;  ///< for the registration: each lidar's first planar point of each cube
  SweepPoints edges;   ///< for both

  double organise_ms = 0;  ///< rows and ranges
  double features_ms = 0;  ///< walk, correction, times, thinning

  /// Edge points are kSharp, registered planar points kFlat, other planar points kLessFlat; points
  /// that only the map takes count as kNone.
  std::array<std::size_t, lidar::kFeatureClasses> class_counts() const;
};

/// Samples a scan. Rows are visited in bit-reversed order (0, 32, 16, 48, ... of 64): thinning
/// keeps the first point of each cube, and in storage order that would always be one of the top
/// rings. The result does not depend on the number of `workers`.
SweepSample sample_sweep(const sensors::LidarScan& scan, const sensors::LidarProfile& profile,
                         const SamplingOptions& options, parallel::Workers& workers);

/// The times of the first and the last of the sample's points; zeros where there are none.
std::pair<double, double> time_span(const SweepSample& sample);

/// Lets the times of the sample's points count from `middle_s` after the stamp.
void count_times_from(double middle_s, SweepSample& sample);

/// Indices of the first point of each cube of edge `cube_m`, in order, of those with mark[i] != 0.
std::vector<std::uint32_t> first_of_each_cube(const SweepPoints& points,
                                              const std::vector<std::uint8_t>& mark, double cube_m);

/// Azimuth of (x, y) by a polynomial, within 1e-5 rad of std::atan2: a loop over it vectorises.
/// An error of 1e-5 rad is 0.2 microseconds of a sweep.
inline float fast_azimuth(float x, float y) {
  const float ax = x < 0 ? -x : x;
  const float ay = y < 0 ? -y : y;
  const float low = ax < ay ? ax : ay;
  const float high = ax < ay ? ay : ax;
  const float t = low / (high + 1e-20F);
  const float s = t * t;
  // atan on [0, 1]: Abramowitz and Stegun, 4.4.49.
  float a =
      t * (0.9998660F + s * (-0.3302995F + s * (0.1801410F + s * (-0.0851330F + s * 0.0208351F))));
  a = ay > ax ? 1.57079633F - a : a;
  a = x < 0 ? 3.14159265F - a : a;
  return y < 0 ? -a : a;
}

}  // namespace traverse::voxel_map
