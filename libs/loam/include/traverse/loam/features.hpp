#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "traverse/config/binder.hpp"
#include "traverse/lidar/feature_class.hpp"
#include "traverse/lidar/scan_lines.hpp"

namespace traverse::loam {

struct FeatureOptions {
  int sectors = 6;  ///< a line is cut into, so that features surround the sensor
  int sharp_per_sector = 2;
  int less_sharp_per_sector = 20;  ///< sharp ones included
  int flat_per_sector = 4;
  double edge_curvature = 0.004;    ///< an edge point has at least this, LOAM eq. 1
  double planar_curvature = 0.002;  ///< a planar point has at most this
  double noise_m = 0.06;  ///< curvature times range below this is range noise: always planar. Near
                          ///< the sensor noise alone reaches any threshold that does not know it.
  double break_m = 0.15;  ///< neighbours farther apart than break_m + break_per_m * range
  double break_per_m = 0.02;          ///< are on different surfaces
  double grazing_step_per_m = 0.014;  ///< steps on both sides above this share of the range mean
                                      ///< that the beam grazes the surface
};
void bind(config::Binder& binder, FeatureOptions& options);

/// The class of each point of a scan.
struct Features {
  std::vector<lidar::FeatureClass> classes;                  ///< one a point of the ScanLines
  std::array<std::size_t, lidar::kFeatureClasses> counts{};  ///< by FeatureClass

  std::size_t count(lidar::FeatureClass feature_class) const {
    return counts[static_cast<std::size_t>(feature_class)];
  }
};

/// Picks features as LOAM does: in each sector of each line by curvature, largest first for edges
/// and smallest first for planes, no two within five points of each other; points on the far side
/// of a depth jump (they may be hidden by what stands before them) and points whose surface is
/// nearly parallel to the beam are not picked. Source: LOAM (2014), section V-A, figure 4.
Features extract_features(const lidar::ScanLines& lines, const FeatureOptions& options);

}  // namespace traverse::loam
