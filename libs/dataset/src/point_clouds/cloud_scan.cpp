#include "point_clouds/cloud_scan.hpp"

#include <utility>

namespace traverse::dataset {

PointCloud cloud_from_scan(const sensors::LidarScan& scan, DerivedPointData derived) {
  PointCloud cloud;
  cloud.add("x", scan.x);
  cloud.add("y", scan.y);
  cloud.add("z", scan.z);
  if (!scan.intensity.empty()) cloud.add("intensity", scan.intensity);
  if (!derived.ring.empty()) cloud.add("ring", std::move(derived.ring));
  if (!derived.time.empty()) cloud.add("time", std::move(derived.time));
  return cloud;
}

}  // namespace traverse::dataset
