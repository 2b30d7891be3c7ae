#include "traverse/lidar/held_back.hpp"

#include <gtest/gtest.h>

namespace traverse::lidar {
namespace {

using Scans = std::vector<int>;

TEST(HeldBack, WaitsForTheFirstScansThenLetsEachPass) {
  HeldBack<int> held(3);
  EXPECT_EQ(held.add(1), Scans{});
  EXPECT_EQ(held.add(2), Scans{});
  EXPECT_EQ(held.add(3), (Scans{1, 2, 3}));
  EXPECT_EQ(held.add(4), (Scans{4}));
  EXPECT_EQ(held.release(), Scans{});
}

TEST(HeldBack, GivesOutWhatWaitsWhenTheRecordingEnds) {
  HeldBack<int> held(3);
  EXPECT_EQ(held.release(), Scans{});
  EXPECT_EQ(held.add(1), Scans{}) << "nothing had come: it still waits";
  EXPECT_EQ(held.release(), (Scans{1}));
  EXPECT_EQ(held.add(2), (Scans{2}));
}

TEST(HeldBack, BelowTwoNoneIsHeldBack) {
  for (const int scans : {1, 0}) {
    HeldBack<int> held(scans);
    EXPECT_EQ(held.add(1), (Scans{1}));
  }
}

}  // namespace
}  // namespace traverse::lidar
