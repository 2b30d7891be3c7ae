#include "traverse/mapping/keyframe_map.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/Dense>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>

#include "traverse/files/scratch_file.hpp"
#include "traverse/geometry/so3.hpp"
#include "traverse/geometry/voxel_set.hpp"
#include "traverse/mrpt_io/mrpt_values.hpp"
#include "traverse/mrpt_io/point_attributes.hpp"
#include "traverse/mrpt_io/simple_map_file.hpp"

namespace traverse::mapping {

namespace {

/// What an archive writes, in memory.
struct Bytes {
  std::vector<std::byte> bytes;

  std::size_t Write(const void* from, std::size_t count) {
    const auto* first = static_cast<const std::byte*>(from);
    bytes.insert(bytes.end(), first, first + count);
    return count;
  }
  static std::size_t Read(void*, std::size_t) { throw std::logic_error("only written"); }
  static std::string getStreamDescription() { return "bytes"; }
};

/// Of each cube the first of the keyframe's points.
std::vector<std::size_t> thinned(const MapKeyframe& keyframe, double voxel_m) {
  std::vector<std::size_t> kept;
  geometry::VoxelSet voxels(voxel_m);
  for (std::size_t i = 0; i < keyframe.size(); ++i) {
    if (voxels.insert(keyframe.p_body(i))) kept.push_back(i);
  }
  return kept;
}

mrpt_io::PointAttributes attributes_of(const MapKeyframe& keyframe,
                                       const std::vector<std::size_t>& kept) {
  mrpt_io::PointAttributes attributes;
  for (const std::size_t i : kept) {
    if (!keyframe.time.empty()) attributes.time.push_back(keyframe.time[i]);
    if (!keyframe.ring.empty()) attributes.ring.push_back(keyframe.ring[i]);
    if (!keyframe.intensity.empty()) attributes.intensity.push_back(keyframe.intensity[i]);
  }
  return attributes;
}

mrpt::obs::CObservationPointCloud::Ptr cloud_of(const MapKeyframe& keyframe,
                                                const std::vector<std::size_t>& kept) {
  auto points = mrpt::maps::CSimplePointsMap::Create();
  points->reserve(kept.size());
  for (const std::size_t i : kept) {
    const Eigen::Vector3f p = (keyframe.p_body(i) - keyframe.p_body_sensor).cast<float>();
    points->insertPointFast(p.x(), p.y(), p.z());
  }
  points->mark_as_modified();
  auto observation = mrpt::obs::CObservationPointCloud::Create();
  observation->timestamp = mrpt_io::to_mrpt(keyframe.stamp);
  observation->sensorLabel = keyframe.sensor;
  observation->sensorPose =
      mrpt_io::to_mrpt(geometry::Pose3{Eigen::Matrix3d::Identity(), keyframe.p_body_sensor});
  observation->pointcloud = points;
  return observation;
}

}  // namespace

struct KeyframeMap::Content {
  struct Place {
    std::uint64_t offset = 0;
    std::size_t bytes = 0;
  };

  explicit Content(const std::filesystem::path& folder) : scratch(folder) {}

  files::ScratchFile scratch;
  std::vector<Place> places;  ///< of the keyframes, as an archive writes them
};

KeyframeMap::KeyframeMap(const KeyframeMapOptions& options, const std::filesystem::path& scratch)
    : options_(options), content_(std::make_unique<Content>(scratch)) {}
KeyframeMap::KeyframeMap(KeyframeMap&&) noexcept = default;
KeyframeMap& KeyframeMap::operator=(KeyframeMap&&) noexcept = default;
KeyframeMap::~KeyframeMap() = default;

std::size_t KeyframeMap::size() const { return content_->places.size(); }

bool KeyframeMap::wants(const geometry::Pose3& T_map_body) const {
  if (size() == 0) return true;
  const geometry::Pose3 motion = T_map_last_.inverse() * T_map_body;
  return motion.translation.norm() >= options_.spacing_m ||
         geometry::angle_of(motion.rotation) >= options_.spacing_rad;
}

void KeyframeMap::add(const MapKeyframe& keyframe) {
  const std::vector<std::size_t> kept = thinned(keyframe, options_.voxel_m);
  auto frame = mrpt::obs::CSensoryFrame::Create();
  const mrpt_io::PointAttributes attributes = attributes_of(keyframe, kept);
  if (!attributes.empty()) frame->insert(mrpt_io::to_observation(attributes, keyframe.stamp));
  frame->insert(cloud_of(keyframe, kept));

  Bytes written;
  auto archive = mrpt::serialization::archiveFrom(written);
  archive << mrpt::poses::CPose3DPDFGaussian(mrpt_io::to_mrpt(keyframe.T_map_body)) << *frame;
  content_->places.push_back({content_->scratch.append(written.bytes), written.bytes.size()});
  T_map_last_ = keyframe.T_map_body;
}

void KeyframeMap::write(const std::filesystem::path& file) const {
  std::vector<std::byte> bytes;
  mrpt_io::write_simple_map(file, size(), [&](auto& archive, std::size_t i) {
    bytes.resize(content_->places[i].bytes);
    content_->scratch.read(content_->places[i].offset, bytes);
    archive.WriteBuffer(bytes.data(), bytes.size());
  });
}

}  // namespace traverse::mapping
