#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

namespace traverse::geometry {

/// The cell of a grid of edge `edge_m`, anchored at the origin, that holds `p`; packed in 64 bits,
/// 21 an axis, so cells repeat after two million edges (400 km at 0.2 m). Coordinates beyond what
/// 64 bits count share a cell.
inline std::uint64_t voxel_key(const Eigen::Vector3d& p, double edge_m) {
  const auto axis = [&](double value) {
    constexpr double kFarthest = 9e18;
    const double cell = std::floor(value / edge_m);
    if (!(std::abs(cell) < kFarthest)) return std::uint64_t{0};
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(cell)) & 0x1fffffU;
  };
  return axis(p.x()) << 42U | axis(p.y()) << 21U | axis(p.z());
}

/// Spreads the bits of a key for hash tables (the finaliser of MurmurHash3).
struct VoxelHash {
  std::size_t operator()(std::uint64_t key) const {
    key ^= key >> 33U;
    key *= 0xff51afd7ed558ccdULL;
    key ^= key >> 33U;
    return key;
  }
};

}  // namespace traverse::geometry
