#include "traverse/slam/ring_key_index.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

namespace traverse::slam {
namespace {

/// A walk through keys that resemble those of scans: shares of sectors that fall with the range.
std::vector<std::vector<float>> walk(std::size_t count, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<float> step(0, 0.03F);
  std::vector<float> key(20, 0.5F);
  std::vector<std::vector<float>> keys;
  for (std::size_t k = 0; k < count; ++k) {
    for (float& share : key) share = std::clamp(share + step(generator), 0.0F, 1.0F);
    keys.push_back(key);
  }
  return keys;
}

std::vector<std::size_t> by_looking_at_all(const std::vector<std::vector<float>>& keys,
                                           std::size_t count, const std::vector<float>& asked,
                                           std::size_t most) {
  std::vector<std::pair<double, std::size_t>> all;
  for (std::size_t k = 0; k < count; ++k) {
    double squared = 0;
    for (std::size_t r = 0; r < 20; ++r) squared += std::pow(keys[k][r] - asked[r], 2);
    all.emplace_back(squared, k);
  }
  std::sort(all.begin(), all.end());
  std::vector<std::size_t> nearest;
  for (std::size_t k = 0; k < std::min(most, count); ++k) nearest.push_back(all[k].second);
  return nearest;
}

TEST(RingKeyIndex, FindsNearlyAllOfTheNearestWhileItGrows) {
  const auto keys = walk(3000, 1);
  const auto asked = walk(300, 2);
  RingKeyIndex index(20);
  std::size_t expected = 0;
  std::size_t right = 0;
  for (std::size_t count = 1; count <= keys.size(); ++count) {
    index.add(keys[count - 1]);
    if (count > 20 && count % 10 != 0) continue;
    const auto all = by_looking_at_all(keys, count, asked[count % asked.size()], 10);
    const auto found = index.nearest(asked[count % asked.size()], 10);
    ASSERT_EQ(found.size(), all.size());
    for (const std::size_t number : found)
      right += std::count(all.begin(), all.end(), number) > 0 ? 1 : 0;
    expected += all.size();
    if (count <= 20) {
      EXPECT_EQ(found, all) << "of " << count;
    }
  }
  EXPECT_GE(static_cast<double>(right), 0.98 * static_cast<double>(expected));
}

TEST(RingKeyIndex, FindsEveryKeyItHas) {
  const auto keys = walk(2500, 3);
  RingKeyIndex index(20);
  for (const auto& key : keys) index.add(key);
  for (std::size_t k = 0; k < keys.size(); ++k) EXPECT_EQ(index.nearest(keys[k], 1).front(), k);
}

TEST(RingKeyIndex, ACopyGivesTheSameAnswersAndGrowsOnItsOwn) {
  const auto keys = walk(1200, 4);
  RingKeyIndex index(20);
  for (std::size_t k = 0; k < 1100; ++k) index.add(keys[k]);
  RingKeyIndex copy = index;
  for (std::size_t k = 1100; k < 1200; ++k) copy.add(keys[k]);
  EXPECT_EQ(index.size(), 1100U);
  for (std::size_t k = 1100; k < 1200; ++k) {
    EXPECT_EQ(copy.nearest(keys[k], 1).front(), k);
    EXPECT_LT(index.nearest(keys[k], 1).front(), 1100U);
  }
  for (std::size_t k = 1100; k < 1200; ++k) index.add(keys[k]);
  for (const auto& asked : walk(100, 5))
    EXPECT_EQ(index.nearest(asked, 10), copy.nearest(asked, 10));
}

TEST(RingKeyIndex, EmptyAndWrongNumberOfRings) {
  RingKeyIndex index(20);
  EXPECT_TRUE(index.nearest(std::vector<float>(20), 5).empty());
  EXPECT_THROW(index.add(std::vector<float>(19)), std::invalid_argument);
  EXPECT_THROW(index.nearest(std::vector<float>(3), 1), std::invalid_argument);
}

}  // namespace
}  // namespace traverse::slam
