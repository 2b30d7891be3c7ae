#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>

#include <Eigen/Core>

#include "traverse/config/binder.hpp"
#include "traverse/mapping/map_keyframe.hpp"

namespace traverse::mapping {

struct FreeSpaceOptions {
  double voxel_m = 0.2;       ///< what is judged: the mean of the points in a cube
  double max_range_m = 40;    ///< rays that end farther away from a cube's own range do not judge
  double ray_radius_m = 0.1;  ///< a ray that passes so near sees through, or hits
  double min_gap_m = 0.5;     ///< and ends so far behind
  int min_votes = 3;          ///< of keyframes that see through
  double majority = 2;        ///< they are so many times those that hit
};
void bind(config::Binder& binder, FreeSpaceOptions& options);

/// Told how much is done, of 1.
using Progress = std::function<void(double)>;

/// Where things were that had gone, or not yet come, when others looked: cubes with points that
/// rays of other keyframes pass through. Removing them removes moving objects from a map.
///
///     for each keyframe, for each cube in its range:
///       take the ray nearest to the cube's mean m; by which distance d does it pass?
///       behind m by more than gap + d / sin(incidence on the surface at m):  it saw through
///       within that of m:                                                    it hit
///       before m:                                                            it says nothing
///     free: enough saw through, and more than hit
///
/// The incidence matters: a ray that passes a road at grazing incidence just above a point of it
/// ends far behind. Sources: visibility as in Pomerleau et al., "Long-term 3D map maintenance in
/// dynamic environments", ICRA 2014, and Kim and Kim, "Remove, then revert", IROS 2020; here by
/// rays instead of image pixels, and with normals.
class FreeSpace {
 public:
  /// Any number of threads gives the same outcome.
  FreeSpace(std::span<const MapKeyframe> keyframes, const FreeSpaceOptions& options,
            const Progress& progress = {});
  FreeSpace(FreeSpace&&) noexcept;
  FreeSpace& operator=(FreeSpace&&) noexcept;
  ~FreeSpace();

  bool is_free(const Eigen::Vector3d& p_map) const;
  std::size_t free_cubes() const;
  std::size_t cubes() const;  ///< with points

 private:
  struct Content;
  std::unique_ptr<Content> content_;
};

/// Removes the points that lie in free space; returns how many.
std::size_t remove_free_points(const FreeSpace& free_space, std::span<MapKeyframe> keyframes);

}  // namespace traverse::mapping
