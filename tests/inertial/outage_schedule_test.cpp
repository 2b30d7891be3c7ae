#include "navigation/outage_schedule.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "inertial/moment.hpp"

namespace traverse::inertial {
namespace {

using testing::moment;

/// Two outages of 5 s and 3 s, the first 10 s after the start, 4 s from the end of one to the next.
OutageSchedule two_outages() {
  OutageOptions options;
  options.spells_s = {5, 3};
  options.first_s = 10;
  options.between_s = 4;
  return OutageSchedule(options);
}

TEST(OutageSchedule, WithholdsFixesInItsOutagesAndNoOthers) {
  OutageSchedule outages = two_outages();
  EXPECT_FALSE(outages.is_out(moment(12))) << "it has not begun";
  outages.start(moment(0));
  std::vector<int> withheld;
  std::vector<int> after;
  for (int second = 0; second < 40; ++second) {
    if (outages.is_out(moment(second))) withheld.push_back(second);
    EXPECT_EQ(outages.is_now_out(), !withheld.empty() && withheld.back() == second);
    if (!outages.has_just_ended()) continue;
    after.push_back(second);
    outages.take_result(0, 0);
    EXPECT_FALSE(outages.has_just_ended()) << "told once";
  }
  EXPECT_EQ(withheld, (std::vector{10, 11, 12, 13, 14, 19, 20, 21}));
  EXPECT_EQ(after, (std::vector{15, 22}));
}

TEST(OutageSchedule, ItsResultIsOfTheDistanceInIt) {
  OutageSchedule outages = two_outages();
  outages.start(moment(0));
  for (int second = 0; second < 23; ++second) {
    outages.is_out(moment(second));
    if (outages.has_just_ended()) {
      const OutageResult result = outages.take_result(1.5, 0.5);
      const bool is_first = second == 15;
      EXPECT_EQ(result.seconds, is_first ? 5 : 3);
      EXPECT_EQ(result.distance_m, is_first ? 50 : 30) << "10 m after each withheld fix";
      EXPECT_EQ(result.error_m, 1.5);
      EXPECT_EQ(result.sigma_m, 0.5);
    }
    outages.add_distance(10);
  }
}

TEST(OutageSchedule, AHoleInTheRecordingWhereAnOutageWasIsNoOutage) {
  OutageSchedule outages = two_outages();
  outages.start(moment(0));
  EXPECT_FALSE(outages.is_out(moment(9)));
  EXPECT_FALSE(outages.is_out(moment(17))) << "no fix came from 9 s to 17 s";
  EXPECT_FALSE(outages.has_just_ended());
  EXPECT_FALSE(outages.is_out(moment(20)));
  EXPECT_TRUE(outages.is_out(moment(21))) << "the next one, 4 s later";
  EXPECT_FALSE(outages.is_out(moment(24)));
  EXPECT_TRUE(outages.has_just_ended());
  EXPECT_EQ(outages.take_result(0, 0).seconds, 3);
}

TEST(OutageSchedule, WithoutOutagesNothingIsWithheld) {
  OutageSchedule outages{OutageOptions{}};
  outages.start(moment(0));
  for (int second = 0; second < 100; ++second) EXPECT_FALSE(outages.is_out(moment(second)));
}

}  // namespace
}  // namespace traverse::inertial
