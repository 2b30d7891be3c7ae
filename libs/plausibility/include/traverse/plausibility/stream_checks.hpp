#pragma once

#include <memory>
#include <string>
#include <vector>

#include "traverse/dataset/source.hpp"
#include "traverse/geometry/pose3.hpp"
#include "traverse/geometry/stamp.hpp"
#include "traverse/plausibility/finding.hpp"
#include "traverse/sensors/measurement.hpp"

/// Whether the streams of a recording contradict each other or what is known of their sensors.
namespace traverse::plausibility {

/// Holds every stream against the others and against itself while a recording goes by. What it
/// keeps does not grow with the recording: summaries at ten a second of the first hour. The same
/// measurements give the same findings.
class StreamChecks {
 public:
  /// \param recording of the source that the measurements are of; referred to, since a rig may grow
  explicit StreamChecks(const dataset::RecordingInfo& recording);
  ~StreamChecks();
  StreamChecks(const StreamChecks&) = delete;
  StreamChecks& operator=(const StreamChecks&) = delete;

  /// The next measurement, in the order in which the source tells them.
  void take(const sensors::Measurement& measurement);

  /// A pose of the body that an odometry on lidar alone has found: what other sensors say of the
  /// motion is held against it.
  void take_pose(geometry::Stamp stamp, const geometry::Pose3& T_map_body);

  /// Takes the poses back: of an odometry that was lost nothing can be held against anything.
  void forget_poses();

  /// What contradicts what, so far; what is told with `accept` in the recording's statements is
  /// marked.
  std::vector<Finding> findings() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// How much of a recording is looked at before a run.
struct SurveyLimits {
  std::size_t max_scans = 20;
  std::size_t max_records = 200'000;
  double max_seconds = 600;
};

/// The findings on the beginning of `source`, which is rewound before and after.
std::vector<Finding> survey(dataset::Source& source, const SurveyLimits& limits);

/// A check as the documentation lists it.
struct CheckDescription {
  std::string code;
  std::string holds;  ///< what is held against what, and from where it is taken to be wrong
};
std::vector<CheckDescription> list_checks();

}  // namespace traverse::plausibility
