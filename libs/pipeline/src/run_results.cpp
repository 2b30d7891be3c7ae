#include "run_results.hpp"

#include <cstdint>
#include <utility>
#include <vector>

#include "traverse/mapping/map_keyframe.hpp"
#include "traverse/pipeline/imported_poses.hpp"
#include "traverse/sensors/rings.hpp"
#include "traverse/sensors/sweep_timing.hpp"

namespace traverse::pipeline {

namespace {

/// The consistency score holds the points of the scans it is given; of a long recording it takes
/// every so manieth scan, to stay below this many.
constexpr std::size_t kMostScoredScans = 500;

std::vector<std::string> table_columns(const Estimator& estimator) {
  std::vector<std::string> columns{"frame", "stamp_s"};
  columns.insert(columns.end(), estimator.columns().begin(), estimator.columns().end());
  const auto foreign = estimator.foreign();
  if (!foreign || !foreign->frame_ms.empty()) columns.emplace_back("total_ms");
  return columns;
}

/// Time and ring of each point, as far as the recording tells.
void add_attributes(const sensors::LidarScan& scan, const sensors::LidarProfile& profile,
                    const UsedScan& used, mapping::MapKeyframe& keyframe) {
  const sensors::PointClock clock(scan, profile);
  const std::vector<std::uint16_t> rings = sensors::rings_if_known(scan, profile);
  for (const std::uint32_t source : used.source) {
    if (clock.knows()) keyframe.time.push_back(clock(source));
    if (!rings.empty()) keyframe.ring.push_back(rings[source]);
  }
}

}  // namespace

RunResults::RunResults(const Estimator& estimator, const dataset::RecordingInfo& recording,
                       const RunOptions& options, const RunFolder& folder)
    : estimator_(estimator),
      recording_(recording),
      first_frame_(options.first),
      score_every_(recording.expected_scans / kMostScoredScans + 1),
      frames_(table_columns(estimator)),
      scorer_(estimator.points_are()),
      map_(options.map_voxel_m, options.max_map_points),
      keyframes_(mapping::KeyframeMapOptions{}, folder.path),
      closes_loops_(estimator.slam_map().has_value()),
      recorder_(folder.path, estimator),
      waiting_(folder.path) {}

void RunResults::add(const PoseFrame& frame, const ScanPtr& scan, bool latest) {
  add_row(frame);
  trajectory_.push_back(frame.stamp, frame.T_map_body);
  if (scan == nullptr) return;
  const bool sample = is_sample();
  const std::size_t pose = trajectory_.size() - 1;
  const bool scored = pose % score_every_ == 0;
  const bool recorded = latest && recorder_.wants(pose, frame);
  sensor_ = scan->sensor;
  if (closes_loops_ && !sample && !scored && !recorded) return;
  const UsedScan used = estimator_.used_scan(*scan, frame, sample);
  if (!closes_loops_) add_to_maps(frame, *scan, used);
  if (scored && closes_loops_) waiting_.add(pose, used);
  if (scored && !closes_loops_) scorer_.add(used.x, used.y, used.z, frame.T_map_body);
  if (recorded) recorder_.add(pose, frame, used);
  if (sample) {
    sample_ = used;
    sample_frame_ = first_frame_ + frames_.rows().size() - 1;
  }
}

void RunResults::correct() {
  const std::optional<SlamMap> slam_map = estimator_.slam_map();
  if (!slam_map) return;
  odometry_ = std::exchange(trajectory_, slam_map->corrected(trajectory_));
  rebuild_maps(*slam_map, sensor_, map_, keyframes_);
}

std::optional<evaluation::Consistency> RunResults::consistency() {
  return closes_loops_ ? waiting_.score(trajectory_, estimator_.points_are()) : scorer_.score();
}

std::optional<evaluation::Consistency> RunResults::odometry_consistency() const {
  return waiting_.score(*odometry_, estimator_.points_are());
}

dataset::PointCloud RunResults::worst_frames(const evaluation::WorstSegments& worst) {
  return recorder_.worst_frames(worst, trajectory_, first_frame_);
}

void RunResults::add_to_maps(const PoseFrame& frame, const sensors::LidarScan& scan,
                             const UsedScan& used) {
  map_.insert(used.x, used.y, used.z, used.intensity, frame.T_map_body);
  if (!keyframes_.wants(frame.T_map_body)) return;
  mapping::MapKeyframe keyframe;
  keyframe.stamp = frame.stamp;
  keyframe.sensor = sensor_;
  keyframe.T_map_body = frame.T_map_body;
  keyframe.x = used.x;
  keyframe.y = used.y;
  keyframe.z = used.z;
  keyframe.intensity = used.intensity;
  const sensors::MountedSensor* lidar = recording_.rig.find(sensor_);
  if (lidar != nullptr) keyframe.p_body_sensor = lidar->T_body_sensor.translation;
  if (lidar != nullptr && lidar->lidar) add_attributes(scan, *lidar->lidar, used, keyframe);
  keyframes_.add(keyframe);
}

void RunResults::add_row(const PoseFrame& frame) {
  std::vector<double> row{static_cast<double>(first_frame_ + frames_.rows().size()),
                          frame.stamp.seconds()};
  row.insert(row.end(), frame.record.begin(), frame.record.end());
  if (frames_.columns().back() == "total_ms") row.push_back(frame.milliseconds);
  frames_.add_row(std::move(row));
}

bool RunResults::is_sample() const {
  const std::size_t number = frames_.rows().size() - 1;
  return (number & (number - 1)) == 0;
}

}  // namespace traverse::pipeline
