#include "surface_cubes.hpp"

#include <Eigen/Dense>

namespace traverse::mapping {

namespace {

/// Moments of the points in a large cube, about its first point.
struct Patch {
  Eigen::Vector3d origin;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  int points = 0;

  Eigen::Vector3d normal() const {
    constexpr int kLeastPoints = 6;
    constexpr double kFlat = 0.1;  // thickness to width, squared
    if (points < kLeastPoints) return Eigen::Vector3d::Zero();
    const Eigen::Vector3d mean = sum / points;
    const Eigen::Matrix3d scatter = squares / points - mean * mean.transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(scatter);
    const bool is_flat = axes.eigenvalues()[0] < kFlat * axes.eigenvalues()[1];
    return is_flat ? Eigen::Vector3d(axes.eigenvectors().col(0)) : Eigen::Vector3d::Zero();
  }
};

}  // namespace

SurfaceCubes surface_cubes(std::span<const MapKeyframe> keyframes, double voxel_m) {
  constexpr double kPatchVoxels = 4;
  SurfaceCubes result;
  tsl::robin_map<std::uint64_t, Patch, geometry::VoxelHash> patches;
  for (const MapKeyframe& keyframe : keyframes) {
    for (std::size_t i = 0; i < keyframe.size(); ++i) {
      const Eigen::Vector3d p = keyframe.T_map_body * keyframe.p_body(i);
      const auto [place, is_new] =
          result.at.try_emplace(geometry::voxel_key(p, voxel_m), result.cubes.size());
      if (is_new) result.cubes.emplace_back();
      SurfaceCube& cube = result.cubes[place->second];
      cube.mean += (p - cube.mean) / ++cube.points;

      Patch& patch = patches.try_emplace(geometry::voxel_key(p, kPatchVoxels * voxel_m), Patch{p})
                         .first.value();
      const Eigen::Vector3d d = p - patch.origin;
      patch.sum += d;
      patch.squares += d * d.transpose();
      ++patch.points;
    }
  }
  tsl::robin_map<std::uint64_t, Eigen::Vector3d, geometry::VoxelHash> normals;
  for (const auto& [key, patch] : patches) normals.emplace(key, patch.normal());
  for (SurfaceCube& cube : result.cubes) {
    const auto found = normals.find(geometry::voxel_key(cube.mean, kPatchVoxels * voxel_m));
    if (found != normals.end()) cube.normal = found->second;
  }
  return result;
}

}  // namespace traverse::mapping
