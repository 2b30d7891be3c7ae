#include "traverse/mapping/keyframe_map.hpp"

#include <cmath>
#include <cstdint>
#include <tsl/robin_set.h>

#include <Eigen/Dense>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/geometry/so3.hpp"
#include "traverse/geometry/voxel.hpp"

#include "mrpt_values.hpp"

namespace traverse::mapping {

struct KeyframeMap::Content {
  mrpt::maps::CSimpleMap map;
};

KeyframeMap::KeyframeMap(const KeyframeMapOptions& options)
    : options_(options), content_(std::make_unique<Content>()) {}
KeyframeMap::KeyframeMap(KeyframeMap&&) noexcept = default;
KeyframeMap& KeyframeMap::operator=(KeyframeMap&&) noexcept = default;
KeyframeMap::~KeyframeMap() = default;

std::size_t KeyframeMap::size() const { return content_->map.size(); }

bool KeyframeMap::wants(const geometry::Pose3& T_map_body) const {
  if (size() == 0) return true;
  const geometry::Pose3 motion = T_map_last_.inverse() * T_map_body;
  return motion.translation.norm() >= options_.spacing_m ||
         geometry::angle_of(motion.rotation) >= options_.spacing_rad;
}

void KeyframeMap::add(geometry::Stamp stamp, const std::string& sensor, std::span<const float> x,
                      std::span<const float> y, std::span<const float> z,
                      std::span<const float> intensity, const geometry::Pose3& T_map_body,
                      const Eigen::Vector3d& p_body_sensor) {
  auto points = mrpt::maps::CPointsMapXYZI::Create();
  tsl::robin_set<std::uint64_t, geometry::VoxelHash> occupied;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!occupied.insert(geometry::voxel_key({x[i], y[i], z[i]}, options_.voxel_m)).second)
      continue;
    const Eigen::Vector3d p = Eigen::Vector3d(x[i], y[i], z[i]) - p_body_sensor;
    points->insertPointFast(static_cast<float>(p.x()), static_cast<float>(p.y()),
                            static_cast<float>(p.z()));
    if (!intensity.empty()) points->setPointIntensity(points->size() - 1, intensity[i]);
  }
  points->mark_as_modified();

  auto observation = mrpt::obs::CObservationPointCloud::Create();
  observation->timestamp = dataset::to_mrpt(stamp);
  observation->sensorLabel = sensor;
  observation->sensorPose =
      dataset::to_mrpt(geometry::Pose3{Eigen::Matrix3d::Identity(), p_body_sensor});
  observation->pointcloud = points;
  auto frame = mrpt::obs::CSensoryFrame::Create();
  frame->insert(observation);
  const mrpt::poses::CPose3DPDF::Ptr pose =
      mrpt::poses::CPose3DPDFGaussian::Create(dataset::to_mrpt(T_map_body));
  content_->map.insert(pose, frame);
  T_map_last_ = T_map_body;
}

void KeyframeMap::write(const std::filesystem::path& file) const {
  files::AtomicFile target(file);
  target.stream().flush();
  // MRPT opens the file itself; its stream does not tell a full disk, so the size is checked by
  // reading the map back.
  if (!content_->map.saveToFile(target.temporary_path().string())) {
    throw files::OutputError(file, "MRPT could not write the simple map");
  }
  mrpt::maps::CSimpleMap written;
  if (!written.loadFromFile(target.temporary_path().string()) || written.size() != size()) {
    throw files::OutputError(file, "not every keyframe was written (is the disk full?)");
  }
  target.commit();
}

}  // namespace traverse::mapping
