#include "traverse/replay/timeline.hpp"

#include <gtest/gtest.h>

namespace traverse::replay {
namespace {

using geometry::Stamp;

Timeline tenth_seconds(std::size_t frames, double start = 1.3e9) {
  Timeline timeline;
  for (std::size_t i = 0; i < frames; ++i) {
    timeline.add(geometry::shifted(Stamp::from_seconds(start), 0.1 * static_cast<double>(i)));
  }
  return timeline;
}

TEST(Timeline, ParsesFramesTimesAndStamps) {
  const Timeline timeline = tenth_seconds(1000);
  EXPECT_EQ(parse_place("120", timeline), 120U);
  EXPECT_EQ(parse_place("5000", timeline), 999U);
  EXPECT_EQ(parse_place("12.55s", timeline), 125U);
  EXPECT_EQ(parse_place("1:02.5", timeline), 625U);
  EXPECT_EQ(parse_place("1300000004.2", timeline), 42U);
  EXPECT_EQ(parse_place("1300000004.25", timeline), 42U);
  EXPECT_EQ(parse_place("1", timeline), 1U);
  for (const char* wrong : {"", "abc", "-3", "1:xx", "12..5s", "nan", ":", "s"}) {
    EXPECT_EQ(parse_place(wrong, timeline), std::nullopt) << wrong;
  }
  EXPECT_EQ(parse_place("3", Timeline()), std::nullopt);
}

TEST(Timeline, APlaceIsKnownWhenMoreFramesCannotMoveIt) {
  Timeline timeline = tenth_seconds(5, 0);
  for (const char* known : {"3", "0.3s"}) EXPECT_TRUE(is_place_known(known, timeline)) << known;
  for (const char* ahead : {"4", "9", "0.4s", "1:00"}) {
    EXPECT_FALSE(is_place_known(ahead, timeline)) << ahead;
  }
  EXPECT_FALSE(is_place_known("0", Timeline()));
  timeline.set_complete();
  EXPECT_TRUE(is_place_known("9", timeline));
}

TEST(Timeline, FramesThemselvesHaveTheLastWord) {
  Timeline timeline = tenth_seconds(5, 0);
  timeline.confirm(0, Stamp::from_seconds(0));
  timeline.confirm(1, Stamp::from_seconds(0.2));  // what was listed at 0.1 s could not be read
  EXPECT_EQ(timeline.size(), 4U);
  EXPECT_EQ(timeline.stamp(1), Stamp::from_seconds(0.2));
  timeline.confirm(4, Stamp::from_seconds(0.5));  // the estimator is ahead of the index
  EXPECT_EQ(timeline.size(), 5U);
  timeline.confirm_end(3);
  EXPECT_EQ(timeline.size(), 3U);
  EXPECT_TRUE(timeline.complete());
}

TEST(Timeline, ALimitEndsIt) {
  Timeline timeline;
  timeline.limit(2);
  for (double t : {0.0, 1.0, 2.0}) timeline.add(Stamp::from_seconds(t));
  EXPECT_EQ(timeline.size(), 2U);
  EXPECT_TRUE(timeline.complete());
}

}  // namespace
}  // namespace traverse::replay
