// A minute on a motorway with the sensors of a phone, against its reference.

#include <gtest/gtest.h>

#include "comma2k19_figures.hpp"

namespace traverse::pipeline {
namespace {

TEST(Comma2k19, IsBetterThanItsFixesThroughOutagesWithAndWithoutWheels) {
#ifdef TRAVERSE_SANITIZED
  GTEST_SKIP() << "accuracy is the same in every build, and this takes a minute here";
#endif
  if (!std::filesystem::exists(testing::comma2k19())) GTEST_SKIP() << "comma2k19 is not there";
  const auto recorded = testing::open_comma2k19({"csv.gnss.period_s=0"});
  const auto raw = testing::path_error(testing::fixes_of(*recorded), *recorded);
  const auto source = testing::open_comma2k19();
  const auto on_clock = testing::path_error(testing::fixes_of(*source), *source);
  EXPECT_LT(on_clock.horizontal_rmse_m, raw.horizontal_rmse_m);
  EXPECT_LT(on_clock.roughness_m, 0.1 * raw.roughness_m);
  for (const auto& variant : testing::comma_variants()) {
    // Without outages it is easier; tests/bench/comma2k19_bench has all.
    if (variant.name.find("outages") == std::string::npos) continue;
    const auto run = testing::navigate(*source, variant.settings);
    const auto found = testing::path_error(run.path, *source);
    EXPECT_GT(found.poses, 500U) << variant.name;
    EXPECT_LT(found.horizontal_rmse_m, 1.02 * variant.published_m) << variant.name;
    EXPECT_LT(found.rmse_m, on_clock.rmse_m) << variant.name;
    EXPECT_LT(found.roughness_m, on_clock.roughness_m) << variant.name;
  }
}

}  // namespace
}  // namespace traverse::pipeline
