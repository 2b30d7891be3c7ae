#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "traverse/dataset/source.hpp"
#include "traverse/plausibility/stream_checks.hpp"
#include "traverse/sensors/measurement.hpp"

#include "estimation_trial.hpp"
#include "probed_path.hpp"

namespace traverse::app {

/// Estimates the beginning of a recording. Of one with a lidar the first scans, so that what its
/// other sensors say of the motion, and the scans themselves, can be held against a path; it goes
/// on while the vehicle has hardly moved or turned, which tells nothing of them. For a pipeline
/// without a lidar the first five minutes.
class OdometryProbe {
 public:
  /// `source` and `checks` must outlive this. \param pipeline that would run; empty: the one that
  /// `run` takes. Where it cannot be made nothing is estimated.
  OdometryProbe(const dataset::Source& source, plausibility::StreamChecks& checks,
                const std::string& pipeline = "");

  /// The next measurement of the recording, before `checks` is asked.
  void take(const sensors::Measurement& measurement);
  /// The recording is through.
  void finish();

  /// That what was estimated is lost, as a run would be.
  struct Lost {
    std::size_t frames = 0;
    bool is_whole = false;  ///< the whole recording was estimated
    std::string why;
  };
  /// After finish(); nothing if it is not lost.
  std::optional<Lost> lost() const;

 private:
  void learn(const std::vector<pipeline::PoseFrame>& frames);

  plausibility::StreamChecks& checks_;
  std::optional<EstimationTrial> trial_;
  bool uses_lidar_ = false;
  bool has_others_ = false;  ///< streams to be held against the path
  bool is_over_ = false;     ///< before the recording
  ProbedPath path_;
};

}  // namespace traverse::app
