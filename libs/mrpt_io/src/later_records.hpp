#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <mrpt/maps/CPointsMapXYZI.h>

#include "traverse/mrpt_io/lidar_observations.hpp"

namespace traverse::mrpt_io {

/// Makes MRPT's archives read what later versions of MRPT write, under MRPT's names of the classes
/// and wherever in a record it stands. What MRPT 2.5.8 reads it goes on reading itself. Read from
/// the sources of MRPT 2.11.4, 2.11.12, 2.15.0, 2.15.3, 2.15.6, 2.15.11, 2.15.19 and 3.1.2:
///
/// CObservationGPS 12 (since 2.11.12: covariance) and 13 (2.15.11: kind of fix, services);
/// CObservation2DRangeScan 8 (2.15.6: duration of the sweep); CObservationComment 1 (2.15.0:
/// label); CPointsMapXYZIRT 0 (2.11.4); CGenericPointsMap 0 to 4 (2.15.0 to 3.0.0); and since
/// 2.15.3 the options that stand in CSimplePointsMap 10 and CPointsMapXYZI 0 have a version 1.
void read_later_records();

/// The points of MRPT's later clouds. To MRPT it is the CPointsMapXYZI that it is derived from, so
/// whatever takes one of those takes its points and intensities.
class LaterPoints : public mrpt::maps::CPointsMapXYZI {
 public:
  std::vector<NamedField> fields;  ///< each with one number a point
  bool has_intensity = false;

 protected:
  void serializeFrom(mrpt::serialization::CArchive& archive, std::uint8_t version) override = 0;

  /// Points, intensities and options are read by these, as MRPT stores them.
  void read_coordinates(mrpt::serialization::CArchive& archive);
  /// Keeps what has one number a point, and of intensities a copy where MRPT has them.
  template <typename Number>
  void keep(const std::string& name, std::vector<Number> values);
  void read_options(mrpt::serialization::CArchive& archive);
};

template <typename Number>
void LaterPoints::keep(const std::string& name, std::vector<Number> values) {
  if (values.empty() || values.size() != m_x.size()) return;
  if (name == "intensity") {
    std::transform(values.begin(), values.end(), m_intensity.begin(),
                   [](Number value) { return static_cast<float>(value); });
    has_intensity = true;
  }
  fields.push_back({name, std::move(values)});
}

}  // namespace traverse::mrpt_io
