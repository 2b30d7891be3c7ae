#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "traverse/dataset/source.hpp"
#include "traverse/mrpt_io/lidar_observations.hpp"
#include "traverse/mrpt_io/rawlog_reader.hpp"
#include "traverse/sensors/lidar_scan.hpp"

#include "point_clouds/point_fields.hpp"
#include "recording/statements.hpp"

namespace traverse::dataset {

/// The fields of points in clouds of MRPT's later versions, which have names: which of them holds
/// intensity, ring and time, and in what unit, is found out for each lidar from its first clouds,
/// as for those of files and bags.
class NamedPoints {
 public:
  /// Adds to `info`, which must outlive this, as must `statements`.
  NamedPoints(std::filesystem::path rawlog, std::string external_folder,
              const Statements& statements, RecordingInfo& info);

  /// The points of a cloud with named fields, of which `scan` are the coordinates.
  /// \param lidar label of the observation \param record in which the cloud stands
  /// \throws mrpt_io::UnusableObservation; files::InputError for a field that is stated and is none
  sensors::LidarScan interpret(const std::vector<mrpt_io::NamedField>& fields,
                               sensors::LidarScan scan, geometry::Stamp stamp,
                               const std::string& lidar, const mrpt_io::RawlogRecord& record);

 private:
  const PointFields& fields_of(const std::string& lidar, const mrpt_io::RawlogRecord& record);

  std::filesystem::path rawlog_;
  std::string external_folder_;
  const Statements& statements_;
  RecordingInfo& info_;
  std::map<std::string, PointFields> known_;  ///< by lidar
};

}  // namespace traverse::dataset
