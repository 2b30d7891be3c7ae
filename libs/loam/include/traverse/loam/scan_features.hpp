#pragma once

#include <array>
#include <cstddef>
#include <memory>

#include "traverse/lidar/scan_lines.hpp"
#include "traverse/lidar/timed_points.hpp"
#include "traverse/loam/features.hpp"
#include "traverse/sensors/lidar_profile.hpp"
#include "traverse/sensors/lidar_scan.hpp"

namespace traverse::loam {

/// What odometry keeps of one scan: its edge and planar points with their times, not yet deskewed.
struct ScanFeatures {
  geometry::Stamp stamp;
  std::size_t points = 0;  ///< of the scan, usable or not
  lidar::DroppedPoints dropped;
  std::array<std::size_t, lidar::kFeatureClasses> class_counts{};  ///< by FeatureClass
  bool timed = false;  ///< false: the point times are not known and all zero

  lidar::TimedPoints edges;       ///< sharp and less sharp
  lidar::TimedPoints planar;      ///< flat and less flat
  lidar::TimedPoints thin_edges;  ///< the same, one a voxel: the registration set
  lidar::TimedPoints thin_planar;
};

struct ThinningOptions {
  double edge_voxel_m = 0.4;  ///< one edge point a cube of this edge takes part in registration
  double planar_voxel_m = 0.8;
};
void bind(config::Binder& binder, ThinningOptions& options);

/// Edge and planar points of a scan whose lines and classes are known.
///
/// Lines are visited in bit-reversed order (0, 32, 16, 48, ... of 64): thinning keeps the first
/// point of each voxel, and in storage order that would always be one of the top rings.
ScanFeatures collect_features(const sensors::LidarScan& scan, const sensors::LidarProfile& profile,
                              const lidar::ScanLines& lines, const Features& features,
                              const ThinningOptions& thinning);

/// The first point of each cube of edge `voxel_m`, in order.
lidar::TimedPoints thinned(const lidar::TimedPoints& points, double voxel_m);

}  // namespace traverse::loam
