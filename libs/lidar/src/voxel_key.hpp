#pragma once

#include <cmath>
#include <cstdint>

#include <Eigen/Core>

namespace traverse::lidar {

/// The cell of a grid of edge `1 / inverse_edge` that holds `p`, packed in 64 bits (21 an axis):
/// cells repeat after two million edges, far beyond any local map.
inline std::uint64_t voxel_key(const Eigen::Vector3d& p, double inverse_edge) {
  const auto axis = [&](double value) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(value * inverse_edge))) &
           0x1fffffU;
  };
  return axis(p.x()) << 42U | axis(p.y()) << 21U | axis(p.z());
}

/// Spreads the bits of a key for a hash table (the finaliser of MurmurHash3).
struct VoxelHash {
  std::size_t operator()(std::uint64_t key) const {
    key ^= key >> 33U;
    key *= 0xff51afd7ed558ccdULL;
    key ^= key >> 33U;
    return key;
  }
};

}  // namespace traverse::lidar
