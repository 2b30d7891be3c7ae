#pragma once

#include <map>
#include <string>
#include <utility>

#include "traverse/dataset/source.hpp"

#include "recording/profile_choice.hpp"
#include "recording/statements.hpp"

namespace traverse::dataset {

/// The sensors that a rawlog names as it goes: each joins the rig with its first observation.
class RawlogSensors {
 public:
  /// Adds to `info`, which must outlive this, as must `statements`.
  RawlogSensors(const Statements& statements, std::filesystem::path share_folder,
                RecordingInfo& info);

  /// The label of the sensor of that kind that the rawlog calls `name`, which may be empty or the
  /// name of another kind too.
  std::string label_of(sensors::SensorKind kind, const std::string& name,
                       const geometry::Pose3& T_body_sensor);

  const Statements& statements() const { return statements_; }

  /// The same for a lidar; `from_data` is what its first observation tells of it.
  /// \param has_named_fields so that what is stated of fields holds of its points
  const sensors::MountedSensor& lidar(const std::string& name, const geometry::Pose3& T_body_sensor,
                                      const sensors::LidarProfile& from_data,
                                      bool has_named_fields = false);

  /// Says in the facts what a fix is taken to err by whose GGA quality alone tells it.
  void note_gga_quality(const Eigen::Matrix3d& covariance_enu);

 private:
  std::string unique_label(sensors::SensorKind kind, const std::string& name) const;

  const Statements& statements_;
  std::filesystem::path share_folder_;
  RecordingInfo& info_;
  std::map<std::pair<sensors::SensorKind, std::string>, std::string> labels_;
};

}  // namespace traverse::dataset
