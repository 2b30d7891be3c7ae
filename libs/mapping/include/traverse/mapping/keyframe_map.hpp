#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include <Eigen/Core>

#include "traverse/geometry/pose3.hpp"
#include "traverse/geometry/stamp.hpp"

namespace traverse::mapping {

struct KeyframeMapOptions {
  double spacing_m = 2;      ///< a new keyframe after so much motion
  double spacing_rad = 0.3;  ///< or so much rotation
  double voxel_m = 0.3;      ///< of a keyframe's points one a cube of this edge is kept
};

/// Scans along the way with their poses, as an MRPT simple map (mrpt::maps::CSimpleMap) from which
/// MRPT's programs build metric maps of any kind.
class KeyframeMap {
 public:
  explicit KeyframeMap(const KeyframeMapOptions& options);
  KeyframeMap(KeyframeMap&&) noexcept;
  KeyframeMap& operator=(KeyframeMap&&) noexcept;
  ~KeyframeMap();

  /// Whether a scan at this pose would become a keyframe.
  bool wants(const geometry::Pose3& T_map_body) const;

  /// Adds a keyframe. Points in the body frame, metres; intensity 0..1, one a point or empty.
  /// \param p_body_sensor where the rays to the points start, body frame
  void add(geometry::Stamp stamp, const std::string& sensor, std::span<const float> x,
           std::span<const float> y, std::span<const float> z, std::span<const float> intensity,
           const geometry::Pose3& T_map_body,
           const Eigen::Vector3d& p_body_sensor = Eigen::Vector3d::Zero());

  std::size_t size() const;

  /// Writes a .simplemap that MRPT's programs open. \throws files::OutputError
  void write(const std::filesystem::path& file) const;

 private:
  struct Content;

  KeyframeMapOptions options_;
  geometry::Pose3 T_map_last_;
  std::unique_ptr<Content> content_;
};

}  // namespace traverse::mapping
