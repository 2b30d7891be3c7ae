#pragma once

#include "traverse/geometry/pose3.hpp"
#include "traverse/lidar/corrected_scan.hpp"
#include "traverse/voxel_map/sweep_sample.hpp"

namespace traverse::voxel_map {

/// Every usable point of a scan, corrected and deskewed, row after row: what maps and scores take.
/// Unlike lidar::corrected it needs no rings.
lidar::CorrectedScan used_points(const sensors::LidarScan& scan,
                                 const sensors::LidarProfile& profile,
                                 const geometry::Twist& velocity);

/// The class of each point of `used`, which come from the scan that was sampled: kSharp an edge
/// point, kFlat a registered planar point, kLessFlat another planar point, else kNone.
std::vector<lidar::FeatureClass> classes_of(const lidar::CorrectedScan& used,
                                            const SweepSample& sample);

}  // namespace traverse::voxel_map
