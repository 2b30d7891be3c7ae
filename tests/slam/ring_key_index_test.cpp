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

/// A vehicle that comes back to a place again and again without noise, and the drive around it.
TEST(RingKeyIndex, ManyEqualKeysHideNoOther) {
  const auto keys = walk(500, 6);
  const std::vector<float> often(20, 0.5F);
  for (const bool equal_ones_first : {true, false}) {
    RingKeyIndex index(20);
    if (!equal_ones_first) {
      for (const auto& key : keys) index.add(key);
    }
    for (int k = 0; k < 600; ++k) index.add(often);
    if (equal_ones_first) {
      for (const auto& key : keys) index.add(key);
    }
    const RingKeyIndex copy = index;
    const std::size_t first = equal_ones_first ? 600 : 0;
    const std::size_t first_equal = equal_ones_first ? 0 : keys.size();
    std::size_t findable = 0;
    for (std::size_t k = 0; k < keys.size(); ++k) {
      findable += copy.nearest(keys[k], 1).front() == first + k ? 1 : 0;
    }
    EXPECT_EQ(findable, keys.size());
    EXPECT_EQ(index.size(), 1100U);
    const auto equal = index.nearest(often, 20);
    ASSERT_EQ(equal.size(), 20U);
    for (std::size_t k = 0; k < 20; ++k) EXPECT_EQ(equal[k], first_equal + k);
    EXPECT_EQ(index.nearest(often, 601).size(), 601U);
  }
}

/// The same with the noise of a few sectors.
TEST(RingKeyIndex, ManyKeysThatAreNearlyEqualHideNoOther) {
  const auto keys = walk(500, 7);
  std::mt19937 generator(8);
  std::uniform_int_distribution<std::size_t> ring(0, 19);
  RingKeyIndex index(20);
  for (int k = 0; k < 600; ++k) {
    std::vector<float> near(20, 0.5F);
    for (int change = 0; change < k % 4; ++change) near[ring(generator)] += 1.0F / 60;
    index.add(near);
  }
  for (const auto& key : keys) index.add(key);
  std::size_t findable = 0;
  for (std::size_t k = 0; k < keys.size(); ++k) {
    findable += index.nearest(keys[k], 1).front() == 600 + k ? 1 : 0;
  }
  EXPECT_EQ(findable, keys.size());
}

TEST(RingKeyIndex, EmptyAndWrongNumberOfRings) {
  RingKeyIndex index(20);
  EXPECT_TRUE(index.nearest(std::vector<float>(20), 5).empty());
  EXPECT_THROW(index.add(std::vector<float>(19)), std::invalid_argument);
  EXPECT_THROW(index.nearest(std::vector<float>(3), 1), std::invalid_argument);
}

}  // namespace
}  // namespace traverse::slam
