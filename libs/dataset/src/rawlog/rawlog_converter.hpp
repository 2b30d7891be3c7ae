#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "traverse/geometry/pose3.hpp"
#include "traverse/mrpt_io/rawlog_reader.hpp"
#include "traverse/sensors/measurement.hpp"

#include "rawlog/named_points.hpp"
#include "rawlog/rawlog_sensors.hpp"
#include "recording/measurement_statements.hpp"

namespace mrpt::obs {
class CActionCollection;
class CActionRobotMovement2D;
class CObservation;
}  // namespace mrpt::obs

namespace traverse::dataset {

/// What one record of a rawlog gives.
struct ConvertedRecord {
  struct Skipped {
    std::string reason;
    std::string place;
  };
  std::vector<sensors::Measurement> measurements;
  std::vector<Skipped> skipped;
};

/// Turns MRPT's objects into measurements; both forms of rawlogs, observations one by one and pairs
/// of actions and sensory frames. Odometry increments of actions are added up.
class RawlogConverter {
 public:
  /// `sensors` and `named_points` must outlive this; point clouds stored outside the rawlog are in
  /// `external_folder`.
  RawlogConverter(RawlogSensors& sensors, NamedPoints& named_points, std::string external_folder);

  ConvertedRecord convert(const mrpt_io::RawlogRecord& record);

  /// What earlier records leave for later ones: the odometry summed up so far.
  struct State {
    sensors::WheelOdometry odometry;
    bool odometry_waits = false;  ///< for the stamp of the sensory frame that follows
  };
  const State& state() const { return state_; }
  void set_state(const State& state) { state_ = state; }

 private:
  void add_observation(mrpt::obs::CObservation& observation, const mrpt_io::RawlogRecord& record,
                       ConvertedRecord& result);
  sensors::Measurement measurement_from(mrpt::obs::CObservation& observation, geometry::Stamp stamp,
                                        const mrpt_io::RawlogRecord& record);
  void add_actions(const mrpt::obs::CActionCollection& actions, const mrpt_io::RawlogRecord& record,
                   ConvertedRecord& result);
  void add_up(const mrpt::obs::CActionRobotMovement2D& action);
  void flush_odometry(geometry::Stamp stamp, ConvertedRecord& result);

  RawlogSensors& sensors_;
  NamedPoints& named_points_;
  std::string external_folder_;
  StatedMeasurements stated_;
  State state_;
};

}  // namespace traverse::dataset
