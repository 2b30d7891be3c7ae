#include "traverse/slam/keyframe_file.hpp"

#include <cmath>
#include <string>

#include <Eigen/Dense>
#include <fmt/format.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>
#include <nlohmann/json.hpp>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"

#include "mrpt_values.hpp"

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
  result->timestamp = dataset::to_mrpt(stamp);
  result->sensorLabel = label;
  points->mark_as_modified();
  result->pointcloud = std::move(points);
  return result;
}

mrpt::maps::CPointsMap::Ptr with_intensity(const KeyframePoints& from) {
  auto points = mrpt::maps::CPointsMapXYZI::Create();
  points->reserve(from.size());
  for (std::size_t i = 0; i < from.size(); ++i) {
    points->insertPointFast(from.x[i], from.y[i], from.z[i]);
    if (!from.intensity.empty()) points->setPointIntensity(i, from.intensity[i]);
  }
  return points;
}

mrpt::maps::CPointsMap::Ptr plain(const lidar::voxel::SweepPoints& from) {
  auto points = mrpt::maps::CSimplePointsMap::Create();
  points->reserve(from.size());
  for (std::size_t i = 0; i < from.size(); ++i) {
    points->insertPointFast(from.x[i], from.y[i], from.z[i]);
  }
  return points;
}

lidar::voxel::SweepPoints sweep_points(const mrpt::maps::CPointsMap& from) {
  lidar::voxel::SweepPoints points;
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
  mrpt::maps::CSimpleMap map;
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    const auto keyframe = keyframes.at(i);
    auto frame = mrpt::obs::CSensoryFrame::Create();
    frame->insert(observation(kMapPoints, keyframe->stamp, with_intensity(keyframe->points)));
    frame->insert(observation(kSurfacePoints, keyframe->stamp, plain(keyframe->features.surface)));
    frame->insert(observation(kPlanarPoints, keyframe->stamp, plain(keyframe->features.planar)));
    frame->insert(observation(kEdgePoints, keyframe->stamp, plain(keyframe->features.edges)));
    auto comment = mrpt::obs::CObservationComment::Create();
    comment->timestamp = dataset::to_mrpt(keyframe->stamp);
    comment->sensorLabel = "keyframe";
    comment->text = comment_of(*keyframe);
    frame->insert(comment);
    const mrpt::poses::CPose3DPDF::Ptr pose =
        mrpt::poses::CPose3DPDFGaussian::Create(dataset::to_mrpt(T_map_lidar(i)));
    map.insert(pose, frame);
  }
  files::AtomicFile target(file);
  target.stream().flush();
  if (!map.saveToFile(target.temporary_path().string())) {
    throw files::OutputError(file, "MRPT could not write the keyframes");
  }
  map.clear();  // one copy in memory is enough
  // MRPT's stream does not tell a full disk, so the map is read back.
  mrpt::maps::CSimpleMap written;
  if (!written.loadFromFile(target.temporary_path().string()) ||
      written.size() != keyframes.size()) {
    throw files::OutputError(file, "not every keyframe was written (is the disk full?)");
  }
  target.commit();
}

std::vector<MapKeyframe> read_keyframes(const std::filesystem::path& file) {
  mrpt::maps::CSimpleMap map;
  if (!std::filesystem::exists(file) || !map.loadFromFile(file.string()) || map.empty()) {
    throw files::InputError(file, files::Place::whole_file(), "an MRPT simple map with keyframes",
                            "none that MRPT can read");
  }
  std::vector<MapKeyframe> keyframes;
  for (std::size_t i = 0; i < map.size(); ++i) {
    mrpt::poses::CPose3DPDF::Ptr pose;
    mrpt::obs::CSensoryFrame::Ptr frame;
    map.get(i, pose, frame);
    MapKeyframe keyframe;
    const mrpt::maps::CPointsMap& points = cloud(*frame, kMapPoints, file, i);
    const lidar::voxel::SweepPoints all = sweep_points(points);
    keyframe.content.id = i;
    keyframe.content.points.x = all.x;
    keyframe.content.points.y = all.y;
    keyframe.content.points.z = all.z;
    keyframe.content.features.surface = sweep_points(cloud(*frame, kSurfacePoints, file, i));
    keyframe.content.features.planar = sweep_points(cloud(*frame, kPlanarPoints, file, i));
    keyframe.content.features.edges = sweep_points(cloud(*frame, kEdgePoints, file, i));
    const auto stamp = dataset::to_stamp(frame->getObservationBySensorLabel(kMapPoints)->timestamp);
    keyframe.stamp = stamp.value_or(geometry::Stamp{});
    keyframe.content.stamp = keyframe.stamp;
    keyframe.T_map_lidar = dataset::to_pose(pose->getMeanVal());
    keyframe.content.T_odom_lidar = keyframe.T_map_lidar;
    keyframes.push_back(std::move(keyframe));
  }
  return keyframes;
}

}  // namespace traverse::slam
