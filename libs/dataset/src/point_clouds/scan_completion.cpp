#include "point_clouds/scan_completion.hpp"

#include "traverse/sensors/rings.hpp"
#include "traverse/sensors/sweep_timing.hpp"

namespace traverse::dataset {

DerivedPointData derive_point_data(const sensors::LidarScan& scan,
                                   const sensors::LidarProfile& profile) {
  DerivedPointData data;
  data.time = point_times(scan, profile);
  try {
    data.ring = assign_rings(scan, profile).ring;
  } catch (const sensors::NoRings&) {
    // Then the copy has none either, and its profile goes on saying why.
  }
  return data;
}

}  // namespace traverse::dataset
