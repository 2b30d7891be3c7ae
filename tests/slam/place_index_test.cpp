#include "traverse/slam/place_index.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

namespace traverse::slam {
namespace {

std::vector<std::vector<float>> random_places(std::size_t count, std::size_t dimensions) {
  std::mt19937 generator(5);
  std::uniform_real_distribution<float> unit(0, 1);
  std::vector<std::vector<float>> places(count, std::vector<float>(dimensions));
  for (auto& place : places)
    std::generate(place.begin(), place.end(), [&] { return unit(generator); });
  return places;
}

double distance(const std::vector<float>& a, const std::vector<float>& b) {
  double squared = 0;
  for (std::size_t k = 0; k < a.size(); ++k) squared += std::pow(double{a[k]} - double{b[k]}, 2);
  return std::sqrt(squared);
}

TEST(PlaceIndex, FindsWhatLookingAtAllWouldFindWhileItGrows) {
  const auto places = random_places(300, 20);
  const auto queries = random_places(20, 20);
  PlaceIndex index(20);
  for (std::size_t count = 1; count <= places.size(); ++count) {
    index.add(places[count - 1]);
    const auto& query = queries[count % queries.size()];
    std::vector<std::pair<double, std::size_t>> all;
    for (std::size_t i = 0; i < count; ++i) all.emplace_back(distance(query, places[i]), i);
    std::sort(all.begin(), all.end());
    const auto found = index.nearest(query, 4);
    ASSERT_EQ(found.size(), std::min<std::size_t>(4, count));
    for (std::size_t k = 0; k < found.size(); ++k) {
      EXPECT_EQ(found[k].number, all[k].second) << "of " << count;
      EXPECT_NEAR(found[k].distance, all[k].first, 1e-5);
    }
  }
}

TEST(PlaceIndex, AllWithinARadius) {
  const auto places = random_places(300, 3);
  PlaceIndex index(3);
  for (const auto& place : places) index.add(place);
  for (const auto& query : random_places(20, 3)) {
    std::vector<std::pair<double, std::size_t>> near;
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (distance(query, places[i]) < 0.2) near.emplace_back(distance(query, places[i]), i);
    }
    std::sort(near.begin(), near.end());
    const auto found = index.within(query, 0.2);
    ASSERT_EQ(found.size(), near.size());
    for (std::size_t k = 0; k < found.size(); ++k) EXPECT_EQ(found[k].number, near[k].second);
  }
}

TEST(PlaceIndex, ManyAtOnceAreThoseOneByOne) {
  const auto places = random_places(100, 3);
  PlaceIndex one_by_one(3);
  PlaceIndex at_once(3);
  std::vector<float> values;
  for (const auto& place : places) {
    one_by_one.add(place);
    values.insert(values.end(), place.begin(), place.end());
  }
  at_once.add(values);
  ASSERT_EQ(at_once.size(), 100U);
  for (const auto& query : random_places(20, 3)) {
    const auto expected = one_by_one.nearest(query, 5);
    const auto found = at_once.nearest(query, 5);
    for (std::size_t k = 0; k < 5; ++k) EXPECT_EQ(found[k].number, expected[k].number);
  }
}

TEST(PlaceIndex, ACopyGrowsOnItsOwn) {
  const auto places = random_places(12, 3);
  PlaceIndex index(3);
  for (std::size_t i = 0; i < 10; ++i) index.add(places[i]);
  PlaceIndex copy = index;
  copy.add(places[10]);
  index.add(places[11]);
  EXPECT_EQ(copy.nearest(places[10], 1).front().number, 10U);
  EXPECT_NEAR(copy.nearest(places[10], 1).front().distance, 0, 1e-6);
  EXPECT_NEAR(index.nearest(places[11], 1).front().distance, 0, 1e-6);
  EXPECT_GT(index.nearest(places[10], 1).front().distance, 0.01);
}

TEST(PlaceIndex, EmptyAndWrongDimensions) {
  PlaceIndex index(3);
  EXPECT_TRUE(index.nearest(std::vector<float>(3), 5).empty());
  EXPECT_THROW(index.add(std::vector<float>(4)), std::invalid_argument);
}

}  // namespace
}  // namespace traverse::slam
