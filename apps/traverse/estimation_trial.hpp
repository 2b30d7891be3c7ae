#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "traverse/geometry/trajectory.hpp"
#include "traverse/pipeline/estimator.hpp"
#include "traverse/pipeline/frame_table.hpp"
#include "traverse/pipeline/run_health.hpp"
#include "traverse/sensors/measurement.hpp"

namespace traverse::app {

/// An estimator at work on a recording, or on its beginning, of which nothing is kept but what the
/// assessment of a run goes by.
class EstimationTrial {
 public:
  explicit EstimationTrial(std::unique_ptr<pipeline::Estimator> estimator);

  /// \returns the frames that are now known. Nothing more comes once the estimator gave up.
  std::vector<pipeline::PoseFrame> take(const sensors::Measurement& measurement);
  std::vector<pipeline::PoseFrame> finish();

  /// From the first measurement to the last that was taken.
  double seconds() const;
  std::size_t frames() const { return T_map_body_.size(); }
  /// As of a run, without a reference; nothing if the estimator gave up.
  std::optional<pipeline::RunHealth> health() const;

 private:
  template <typename Work>
  std::vector<pipeline::PoseFrame> attempt(const Work& work);

  std::unique_ptr<pipeline::Estimator> estimator_;
  bool has_failed_ = false;
  pipeline::FrameTable table_;
  geometry::Trajectory T_map_body_;
  std::map<std::string, std::size_t> readings_;  ///< by sensor
  std::optional<geometry::Stamp> first_, last_;
};

}  // namespace traverse::app
