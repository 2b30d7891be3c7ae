#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "traverse/lidar/scan_lines.hpp"
#include "traverse/lidar/timed_points.hpp"
#include "traverse/loam/features.hpp"
#include "traverse/sensors/lidar_profile.hpp"
#include "traverse/sensors/lidar_scan.hpp"

namespace traverse::loam {

/// Points of a scan that know their scan line.
struct LinedPoints {
  lidar::TimedPoints points;
  std::vector<std::uint16_t> line;  ///< of ScanLines, one a point, ascending

  std::size_t size() const { return points.size(); }
};

/// What scan-to-scan odometry keeps of one sweep, not yet deskewed: the few best points ask, and
/// the many good ones of the next scan's predecessor answer. Source: LOAM (2014), section V-B.
struct SweepFeatures {
  lidar::TimedPoints sharp;  ///< the sharpest edge points
  lidar::TimedPoints flat;   ///< the flattest planar points
  LinedPoints edges;         ///< sharp and less sharp
  LinedPoints planar;        ///< flat and less flat, the first of each scan line in a cube
};

/// \param planar_voxel_m edge of the cubes that thin `planar`, line by line
SweepFeatures collect_sweep(const sensors::LidarScan& scan, const sensors::LidarProfile& profile,
                            const lidar::ScanLines& lines, const Features& features,
                            double planar_voxel_m);

}  // namespace traverse::loam
