#include "traverse/mapping/map_keyframe.hpp"

#include <utility>

#include <Eigen/Dense>
#include <fmt/core.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3DPDF.h>

#include "traverse/files/input_error.hpp"
#include "traverse/mrpt_io/mrpt_values.hpp"
#include "traverse/mrpt_io/point_attributes.hpp"
#include "traverse/mrpt_io/simple_map_file.hpp"

namespace traverse::mapping {

namespace {

void append(const mrpt::maps::CPointsMap& points, const geometry::Pose3& T_body_points,
            MapKeyframe& keyframe) {
  const auto* with_intensity = dynamic_cast<const mrpt::maps::CPointsMapXYZI*>(&points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    Eigen::Vector3d p;
    points.getPoint(i, p.x(), p.y(), p.z());
    p = T_body_points * p;
    keyframe.x.push_back(static_cast<float>(p.x()));
    keyframe.y.push_back(static_cast<float>(p.y()));
    keyframe.z.push_back(static_cast<float>(p.z()));
    keyframe.intensity.push_back(with_intensity == nullptr ? 0
                                                           : with_intensity->getPointIntensity(i));
  }
}

void append(const mrpt::obs::CObservation& observation, MapKeyframe& keyframe) {
  keyframe.sensor = observation.sensorLabel;
  if (const auto stamp = mrpt_io::to_stamp(observation.timestamp)) keyframe.stamp = *stamp;
  mrpt::poses::CPose3D T_body_sensor;
  observation.getSensorPose(T_body_sensor);
  keyframe.p_body_sensor = mrpt_io::to_pose(T_body_sensor).translation;
  if (const auto* cloud = dynamic_cast<const mrpt::obs::CObservationPointCloud*>(&observation)) {
    if (cloud->pointcloud != nullptr) {
      append(*cloud->pointcloud, mrpt_io::to_pose(T_body_sensor), keyframe);
    }
    return;
  }
  mrpt::maps::CPointsMapXYZI points;  // of any other kind: as MRPT itself makes points of it
  points.insertionOptions.minDistBetweenLaserPoints = 0;
  if (observation.insertObservationInto(points)) append(points, {}, keyframe);
}

/// Keyframes of slam hold their points for maps beside those that scans are registered by.
bool is_part_of_map(const mrpt::obs::CSensoryFrame& frame,
                    const mrpt::obs::CObservation& observation) {
  static const std::string kMapPoints = "map points";
  if (mrpt_io::holds_attributes(observation)) return false;
  return observation.sensorLabel == kMapPoints ||
         frame.getObservationBySensorLabel(kMapPoints) == nullptr;
}

}  // namespace

void MapKeyframe::keep_only(const std::vector<char>& keep) {
  const auto reduce = [&](auto& values) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (keep[i] != 0) values[kept++] = values[i];
    }
    values.resize(kept);
  };
  for (auto* values : {&x, &y, &z, &intensity, &time}) reduce(*values);
  reduce(ring);
}

std::vector<MapKeyframe> read_simple_map(const std::filesystem::path& file) {
  std::vector<MapKeyframe> keyframes;
  std::size_t points = 0;
  mrpt_io::for_each_keyframe(file, [&](std::size_t i, const auto& pose, const auto& frame) {
    MapKeyframe& keyframe = keyframes.emplace_back();
    keyframe.T_map_body = mrpt_io::to_pose(pose.getMeanVal()).orthonormalised();
    for (const auto& observation : frame) {
      if (is_part_of_map(frame, *observation)) append(*observation, keyframe);
    }
    mrpt_io::require_points_in_sight(file, i, keyframe.x, keyframe.y, keyframe.z);
    mrpt_io::PointAttributes attributes = mrpt_io::attributes_of(frame, keyframe.size());
    keyframe.time = std::move(attributes.time);
    keyframe.ring = std::move(attributes.ring);
    if (!attributes.intensity.empty()) keyframe.intensity = std::move(attributes.intensity);
    points += keyframe.size();
  });
  if (points == 0) {
    throw files::InputError(file, files::Place::whole_file(), "a simple map of MRPT with points",
                            fmt::format("{} keyframes without a point", keyframes.size()));
  }
  return keyframes;
}

}  // namespace traverse::mapping
