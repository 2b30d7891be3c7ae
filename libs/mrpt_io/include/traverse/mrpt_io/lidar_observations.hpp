#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationRotatingScan.h>
#include <mrpt/obs/CObservationVelodyneScan.h>

#include "traverse/sensors/lidar_profile.hpp"
#include "traverse/sensors/lidar_scan.hpp"
#include "traverse/sensors/planar_scan.hpp"

/// MRPT's laser observations as scans; stamp and sensor are left to the caller.
namespace traverse::mrpt_io {

/// An observation that is whole but holds nothing that can be used.
class UnusableObservation : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The points that the raw packets hold; where there are none, the stored ones, which are taken out
/// of `observation`. \throws UnusableObservation
sensors::LidarScan take_scan(mrpt::obs::CObservationVelodyneScan& observation);

/// Loads the points first where they stand in a file of their own, in `external_folder`.
/// \throws UnusableObservation
sensors::LidarScan take_scan(mrpt::obs::CObservationPointCloud& observation,
                             const std::string& external_folder);

/// One number of every point of a cloud of MRPT's later versions, beside its coordinates.
struct NamedField {
  std::string name;  ///< MRPT's own are "intensity", "ring" and "t", in seconds after the stamp
  std::variant<std::vector<float>, std::vector<double>, std::vector<std::uint8_t>,
               std::vector<std::uint16_t>, std::vector<std::uint32_t>>
      values;
};

/// Those of a cloud that names them, once take_scan() has loaded it, which takes those of MRPT's
/// own names; null for any other cloud. They are the observation's.
const std::vector<NamedField>* named_fields(const mrpt::obs::CObservationPointCloud& observation);

/// The points of a range image, column after column; row i looks up by elevations_deg[i]. MRPT
/// documents azimuths as counterclockwise and all columns as used, but its fromVelodyne() writes
/// Velodyne's clockwise azimuths and fills one column in `rows`: images of those models are read
/// so. \throws UnusableObservation if there is not one elevation a row.
sensors::LidarScan take_scan(const mrpt::obs::CObservationRotatingScan& observation,
                             const std::vector<double>& elevations_deg);

sensors::PlanarScan planar_scan(const mrpt::obs::CObservation2DRangeScan& observation);
/// Of a range image with one row, as fromScan2D() makes it.
sensors::PlanarScan planar_scan(const mrpt::obs::CObservationRotatingScan& observation);

/// What the observation tells of its sensor.
sensors::LidarProfile profile_of(const mrpt::obs::CObservationVelodyneScan& observation,
                                 const sensors::LidarScan& scan);
sensors::LidarProfile profile_of(const mrpt::obs::CObservationRotatingScan& observation);
sensors::LidarProfile profile_of(const mrpt::obs::CObservationPointCloud& observation,
                                 const sensors::LidarScan& scan);

}  // namespace traverse::mrpt_io
