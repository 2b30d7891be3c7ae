#pragma once

#include <memory>

#include "traverse/dataset/source.hpp"
#include "traverse/pipeline/estimator.hpp"
#include "traverse/plausibility/stream_checks.hpp"
#include "traverse/sensors/measurement.hpp"

#include "probed_path.hpp"

namespace traverse::app {

/// Estimates the first scans of a recording, so that what its other sensors say of the motion, and
/// the scans themselves, can be held against a path. It goes on while the vehicle has hardly moved
/// or turned, which tells nothing of them.
class OdometryProbe {
 public:
  /// `source` and `checks` must outlive this. Without a lidar nothing is estimated.
  OdometryProbe(const dataset::Source& source, plausibility::StreamChecks& checks);

  /// The next measurement of the recording, before `checks` is asked.
  void take(const sensors::Measurement& measurement);

 private:
  plausibility::StreamChecks& checks_;
  std::unique_ptr<pipeline::Estimator> estimator_;  ///< null once it is done or has failed
  bool has_others_ = false;                         ///< streams to be held against the path
  ProbedPath path_;
};

}  // namespace traverse::app
