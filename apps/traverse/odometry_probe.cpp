#include "odometry_probe.hpp"

#include <exception>
#include <memory>
#include <utility>

#include "traverse/pipeline/preset.hpp"
#include "traverse/pipeline/registry.hpp"
#include "traverse/sensors/rig.hpp"

#include "installed_files.hpp"

namespace traverse::app {

namespace {

using sensors::SensorKind;

/// Null if it cannot be made. Loops are not closed: they mend what was estimated before.
std::unique_ptr<pipeline::Estimator> make_estimator(const dataset::Source& source,
                                                    const std::string& name, bool with_loops) {
  pipeline::PresetRequest request;
  if (!name.empty()) request.name = name;
  if (!with_loops) request.assignments = {"slam.use=false"};
  try {
    const pipeline::Preset preset = pipeline::load_preset(request, find_installed_files().share);
    return pipeline::make_pipeline(preset, source.info(), 1).estimator;
  } catch (const std::runtime_error&) {
    return nullptr;
  }
}

}  // namespace

OdometryProbe::OdometryProbe(const dataset::Source& source, plausibility::StreamChecks& checks,
                             const std::string& pipeline)
    : checks_(checks) {
  const bool has_lidar = source.info().rig.first(SensorKind::kLidar) != nullptr;
  std::unique_ptr<pipeline::Estimator> estimator;
  if (has_lidar) estimator = make_estimator(source, pipeline, false);
  if (estimator == nullptr && !pipeline.empty()) {
    estimator = make_estimator(source, pipeline, true);  // one that knows no loops
  }
  if (estimator == nullptr && has_lidar) estimator = make_estimator(source, "", false);
  if (estimator == nullptr) return;
  uses_lidar_ = estimator->depends_on(SensorKind::kLidar);
  has_others_ = source.info().rig.sensors.size() > 1 || source.reference().has_value();
  trial_.emplace(std::move(estimator));
}

void OdometryProbe::learn(const std::vector<pipeline::PoseFrame>& frames) {
  if (!uses_lidar_) return;  // what is estimated from other sensors cannot be held against them
  for (const pipeline::PoseFrame& frame : frames) {
    checks_.take_pose(frame.stamp, frame.T_map_body);
    path_.add(frame.T_map_body);
  }
}

void OdometryProbe::take(const sensors::Measurement& measurement) {
  constexpr double kLongest_s = 300;
  if (!trial_ || is_over_) return;
  learn(trial_->take(measurement));
  is_over_ = uses_lidar_ ? path_.is_enough(has_others_) : trial_->seconds() > kLongest_s;
}

void OdometryProbe::finish() {
  if (trial_ && (!is_over_ || !uses_lidar_)) learn(trial_->finish());
}

std::optional<OdometryProbe::Lost> OdometryProbe::lost() const {
  if (!trial_) return std::nullopt;
  const auto health = trial_->health();
  if (!health || health->verdict != pipeline::Health::kLost) return std::nullopt;
  return Lost{trial_->frames(), !is_over_, health->summary()};
}

}  // namespace traverse::app
