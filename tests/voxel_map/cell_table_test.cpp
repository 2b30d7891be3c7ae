#include "traverse/voxel_map/cell_table.hpp"

#include <gtest/gtest.h>

namespace traverse::voxel_map {
namespace {

TEST(CellTable, FindsWhatWasAddedHoweverItGrows) {
  CellTable table;
  constexpr std::uint32_t kCells = 5000;
  const auto key = [](std::uint32_t k) {
    return cell_key(static_cast<std::int32_t>(k % 71) - 35, static_cast<std::int32_t>(k / 71), -1);
  };
  for (std::uint32_t k = 0; k < kCells; ++k) EXPECT_EQ(table.find_or_add(key(k), k), k);
  for (std::uint32_t k = 0; k < kCells; ++k) {
    EXPECT_EQ(table.find(key(k)), k);
    EXPECT_EQ(table.find_or_add(key(k), kCells), k) << "is there already";
  }
  EXPECT_EQ(table.find(cell_key(0, 0, 5)), CellTable::kNone);
  EXPECT_LT(table.bytes(), 5 * kCells * sizeof(std::uint64_t)) << "at least a quarter full or so";
}

TEST(CellTable, ForgetsEverythingWhenCleared) {
  CellTable table;
  table.find_or_add(7, 1);
  table.clear(1000);
  EXPECT_EQ(table.find(7), CellTable::kNone);
  EXPECT_EQ(table.find_or_add(7, 2), 2U);
}

}  // namespace
}  // namespace traverse::voxel_map
