#include "traverse/slam/keyframe_file.hpp"

#include <cmath>
#include <string>
#include <utility>

#include <Eigen/Dense>
#include <fmt/format.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>
#include <nlohmann/json.hpp>

#include "traverse/files/input_error.hpp"
#include "traverse/mrpt_io/mrpt_values.hpp"
#include "traverse/mrpt_io/point_attributes.hpp"
#include "traverse/mrpt_io/simple_map_file.hpp"

namespace traverse::slam {

namespace {

constexpr const char* kMapPoints = "map points";
constexpr const char* kSurfacePoints = "surface points";
constexpr const char* kPlanarPoints = "planar points";
constexpr const char* kEdgePoints = "edge points";

std::string comment_of(const Keyframe& keyframe) {
  const auto numbers = [](const auto& matrix) {
    return std::vector<double>(matrix.data(), matrix.data() + matrix.size());
  };
  const lidar::RegistrationHealth& health = keyframe.health;
  const nlohmann::ordered_json json{{"keyframe", keyframe.id},
                                    {"step_covariance", numbers(keyframe.step_covariance)},
                                    {"registered", health.registered},
                                    {"line_matches", health.line_matches},
                                    {"plane_matches", health.plane_matches},
                                    {"residual_rms_m", health.residual_rms_m},
                                    {"inlier_share", health.inlier_share},
                                    {"eigenvalues", numbers(health.observability.eigenvalues)},
                                    {"degenerate_directions", health.observability.degenerate}};
  return json.dump();
}

mrpt::obs::CObservationPointCloud::Ptr observation(const char* label, geometry::Stamp stamp,
                                                   mrpt::maps::CPointsMap::Ptr points) {
  auto result = mrpt::obs::CObservationPointCloud::Create();
  result->timestamp = mrpt_io::to_mrpt(stamp);
  result->sensorLabel = label;
  points->mark_as_modified();
  result->pointcloud = std::move(points);
  return result;
}

template <typename Points>
mrpt::maps::CPointsMap::Ptr plain(const Points& from) {
  auto points = mrpt::maps::CSimplePointsMap::Create();
  points->reserve(from.size());
  for (std::size_t i = 0; i < from.size(); ++i) {
    points->insertPointFast(from.x[i], from.y[i], from.z[i]);
  }
  return points;
}

mrpt::obs::CSensoryFrame::Ptr sensory_frame(const Keyframe& keyframe) {
  auto frame = mrpt::obs::CSensoryFrame::Create();
  frame->insert(observation(kMapPoints, keyframe.stamp, plain(keyframe.points)));
  const mrpt_io::PointAttributes attributes{keyframe.points.time, keyframe.points.ring,
                                            keyframe.points.intensity};
  if (!attributes.empty()) frame->insert(mrpt_io::to_observation(attributes, keyframe.stamp));
  frame->insert(observation(kSurfacePoints, keyframe.stamp, plain(keyframe.features.surface)));
  frame->insert(observation(kPlanarPoints, keyframe.stamp, plain(keyframe.features.planar)));
  frame->insert(observation(kEdgePoints, keyframe.stamp, plain(keyframe.features.edges)));
  auto comment = mrpt::obs::CObservationComment::Create();
  comment->timestamp = mrpt_io::to_mrpt(keyframe.stamp);
  comment->sensorLabel = "keyframe";
  comment->text = comment_of(keyframe);
  frame->insert(comment);
  return frame;
}

KeyframePoints map_points(const mrpt::maps::CPointsMap& from) {
  KeyframePoints points;
  from.getAllPoints(points.x, points.y, points.z);
  return points;
}

voxel_map::SweepPoints sweep_points(const mrpt::maps::CPointsMap& from) {
  voxel_map::SweepPoints points;
  for (std::size_t i = 0; i < from.size(); ++i) {
    float x = 0;
    float y = 0;
    float z = 0;
    from.getPoint(i, x, y, z);
    points.push_back(x, y, z, std::sqrt(x * x + y * y + z * z), static_cast<std::uint32_t>(i));
  }
  points.time.assign(points.size(), 0);
  return points;
}

const mrpt::maps::CPointsMap& cloud(const mrpt::obs::CSensoryFrame& frame, const char* label,
                                    const std::filesystem::path& file, std::size_t record) {
  const auto found = std::dynamic_pointer_cast<mrpt::obs::CObservationPointCloud>(
      frame.getObservationBySensorLabel(label));
  if (found == nullptr || found->pointcloud == nullptr) {
    throw files::InputError(file, files::Place::record(record),
                            fmt::format("a point cloud {}", files::in_quotes(label)),
                            "a keyframe without it (not written by traverse run --slam?)");
  }
  return *found->pointcloud;
}

}  // namespace

void write_keyframes(const std::filesystem::path& file, const KeyframeStore& keyframes,
                     const std::function<geometry::Pose3(std::size_t)>& T_map_lidar) {
  mrpt_io::write_simple_map(file, keyframes.size(), [&](auto& archive, std::size_t i) {
    archive << mrpt::poses::CPose3DPDFGaussian(mrpt_io::to_mrpt(T_map_lidar(i)))
            << *sensory_frame(*keyframes.at(i));
  });
}

std::vector<MapKeyframe> read_keyframes(const std::filesystem::path& file) {
  std::vector<MapKeyframe> keyframes;
  mrpt_io::for_each_keyframe(file, [&](std::size_t i, const auto& pose, const auto& frame) {
    MapKeyframe keyframe;
    keyframe.content.id = i;
    keyframe.content.points = map_points(cloud(frame, kMapPoints, file, i));
    keyframe.content.features.surface = sweep_points(cloud(frame, kSurfacePoints, file, i));
    keyframe.content.features.planar = sweep_points(cloud(frame, kPlanarPoints, file, i));
    keyframe.content.features.edges = sweep_points(cloud(frame, kEdgePoints, file, i));
    for (const auto* points :
         {&keyframe.content.features.surface, &keyframe.content.features.planar,
          &keyframe.content.features.edges}) {
      mrpt_io::require_points_in_sight(file, i, points->x, points->y, points->z);
    }
    const KeyframePoints& points = keyframe.content.points;
    mrpt_io::require_points_in_sight(file, i, points.x, points.y, points.z);
    const auto stamp = mrpt_io::to_stamp(frame.getObservationBySensorLabel(kMapPoints)->timestamp);
    keyframe.stamp = stamp.value_or(geometry::Stamp{});
    keyframe.content.stamp = keyframe.stamp;
    keyframe.T_map_lidar = mrpt_io::to_pose(pose.getMeanVal());
    keyframe.content.T_odom_lidar = keyframe.T_map_lidar;
    keyframes.push_back(std::move(keyframe));
  });
  if (keyframes.empty()) {
    throw files::InputError(file, files::Place::whole_file(), "an MRPT simple map with keyframes",
                            "none");
  }
  return keyframes;
}

}  // namespace traverse::slam
