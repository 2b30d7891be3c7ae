#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>

#include "traverse/geometry/pose3.hpp"
#include "traverse/mapping/map_keyframe.hpp"

namespace traverse::mapping {

struct KeyframeMapOptions {
  double spacing_m = 2;      ///< a new keyframe after so much motion
  double spacing_rad = 0.3;  ///< or so much rotation
  double voxel_m = 0.3;      ///< of a keyframe's points one a cube of this edge is kept
};

/// Scans along the way with their poses, as an MRPT simple map (mrpt::maps::CSimpleMap) from which
/// MRPT's programs build metric maps of any kind. Keyframes wait on disk for the file to be
/// written.
class KeyframeMap {
 public:
  /// \param scratch a folder with room for them; nothing is left there
  KeyframeMap(const KeyframeMapOptions& options, const std::filesystem::path& scratch);
  KeyframeMap(KeyframeMap&&) noexcept;
  KeyframeMap& operator=(KeyframeMap&&) noexcept;
  ~KeyframeMap();

  /// Whether a scan at this pose would become a keyframe.
  bool wants(const geometry::Pose3& T_map_body) const;

  /// Adds a keyframe. \throws files::OutputError if it cannot be put on disk
  void add(const MapKeyframe& keyframe);

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
