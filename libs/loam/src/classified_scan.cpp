#include "classified_scan.hpp"

#include <utility>
#include <vector>

#include "traverse/lidar/scan_lines.hpp"

namespace traverse::loam {

lidar::CorrectedScan corrected_and_classified(const sensors::LidarScan& scan,
                                              const sensors::LidarProfile& profile,
                                              const geometry::Twist& velocity,
                                              const FeatureOptions& options) {
  lidar::ScanLines lines = lidar::organise(scan, profile);
  std::vector<lidar::FeatureClass> classes = extract_features(lines, options).classes;
  lidar::CorrectedScan result = lidar::corrected(std::move(lines), scan, profile, velocity);
  result.classes = std::move(classes);
  return result;
}

}  // namespace traverse::loam
