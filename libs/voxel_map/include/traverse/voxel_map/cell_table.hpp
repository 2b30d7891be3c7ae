#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "traverse/voxel_map/cell_key.hpp"

namespace traverse::voxel_map {

/// From keys of cells to indices: open addressing with linear probing, at most half full.
class CellTable {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffU;

  CellTable() { clear(0); }

  /// \returns the index of the cell, or kNone.
  std::uint32_t find(std::uint32_t key) const {
    for (std::size_t i = home(key);; i = (i + 1) & (slots_.size() - 1)) {
      if (slots_[i] == kFree) return kNone;
      if (key_of(slots_[i]) == key) return index_of(slots_[i]);
    }
  }

  /// \returns the index of the cell, which is `next` from now on if it had none.
  std::uint32_t find_or_add(std::uint32_t key, std::uint32_t next);

  /// Empty, with room for `cells`.
  void clear(std::size_t cells);

  /// Starts to fetch where find() will look first.
  void prefetch(std::uint32_t key) const { __builtin_prefetch(&slots_[home(key)]); }

  std::size_t bytes() const { return slots_.capacity() * sizeof(std::uint64_t); }

 private:
  static constexpr std::uint64_t kFree = ~std::uint64_t{0};

  static std::uint32_t key_of(std::uint64_t slot) {
    return static_cast<std::uint32_t>(slot >> 32U);
  }
  static std::uint32_t index_of(std::uint64_t slot) { return static_cast<std::uint32_t>(slot); }
  std::size_t home(std::uint32_t key) const { return spread(key) >> (32U - bits_); }
  void grow();

  unsigned bits_ = 8;
  std::size_t cells_ = 0;
  std::vector<std::uint64_t> slots_;  // key << 32 | index
};

}  // namespace traverse::voxel_map
