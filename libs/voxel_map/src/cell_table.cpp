#include "traverse/voxel_map/cell_table.hpp"

#include <utility>

namespace traverse::voxel_map {

std::uint32_t CellTable::find_or_add(std::uint32_t key, std::uint32_t next) {
  std::size_t i = home(key);
  for (; slots_[i] != kFree; i = (i + 1) & (slots_.size() - 1)) {
    if (key_of(slots_[i]) == key) return index_of(slots_[i]);
  }
  slots_[i] = std::uint64_t{key} << 32U | next;
  if (2 * ++cells_ > slots_.size()) grow();
  return next;
}

void CellTable::clear(std::size_t cells) {
  while (2 * cells > std::size_t{1} << bits_) ++bits_;
  slots_.assign(std::size_t{1} << bits_, kFree);
  cells_ = 0;
}

void CellTable::grow() {
  const std::vector<std::uint64_t> old = std::move(slots_);
  ++bits_;
  clear(0);
  for (const std::uint64_t slot : old) {
    if (slot != kFree) find_or_add(key_of(slot), index_of(slot));
  }
}

}  // namespace traverse::voxel_map
