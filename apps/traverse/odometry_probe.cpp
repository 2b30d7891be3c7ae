#include "odometry_probe.hpp"

#include <exception>

#include "traverse/pipeline/preset.hpp"
#include "traverse/pipeline/registry.hpp"
#include "traverse/sensors/rig.hpp"

#include "installed_files.hpp"

namespace traverse::app {

OdometryProbe::OdometryProbe(const dataset::Source& source, plausibility::StreamChecks& checks)
    : checks_(checks) {
  if (source.info().rig.first(sensors::SensorKind::kLidar) == nullptr) return;
  has_others_ = source.info().rig.sensors.size() > 1 || source.reference().has_value();
  pipeline::PresetRequest request;
  request.assignments = {"slam.use=false"};
  const pipeline::Preset preset = pipeline::load_preset(request, find_installed_files().share);
  estimator_ = pipeline::make_pipeline(preset, source.info(), 1).estimator;
}

void OdometryProbe::take(const sensors::Measurement& measurement) {
  if (!estimator_) return;
  try {
    for (const pipeline::PoseFrame& frame : estimator_->process(measurement)) {
      checks_.take_pose(frame.stamp, frame.T_map_body);
      path_.add(frame.T_map_body);
    }
    if (path_.is_enough(has_others_)) estimator_.reset();
  } catch (const std::exception&) {
    estimator_.reset();  // a run says why; what is in the recording is told all the same
  }
}

}  // namespace traverse::app
