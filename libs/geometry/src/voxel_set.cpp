#include "traverse/geometry/voxel_set.hpp"

#include <cstdint>
#include <tsl/robin_set.h>

#include "traverse/geometry/voxel.hpp"

namespace traverse::geometry {

struct VoxelSet::Keys {
  tsl::robin_set<std::uint64_t, VoxelHash> taken;
};

VoxelSet::VoxelSet(double edge_m, std::size_t points)
    : edge_m_(edge_m), keys_(std::make_unique<Keys>()) {
  keys_->taken.reserve(points);
}
VoxelSet::VoxelSet(VoxelSet&&) noexcept = default;
VoxelSet& VoxelSet::operator=(VoxelSet&&) noexcept = default;
VoxelSet::~VoxelSet() = default;

bool VoxelSet::insert(const Eigen::Vector3d& p) {
  return keys_->taken.insert(voxel_key(p, edge_m_)).second;
}

std::size_t VoxelSet::size() const { return keys_->taken.size(); }

}  // namespace traverse::geometry
