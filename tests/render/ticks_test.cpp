#include "plot/ticks.hpp"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace traverse::render {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Le;
using ::testing::SizeIs;

TEST(NiceStep, IsOneTwoOrFiveTimesAPowerOfTen) {
  EXPECT_DOUBLE_EQ(nice_step_at_least(0.11), 0.2);
  EXPECT_DOUBLE_EQ(nice_step_at_least(0.2), 0.2);
  EXPECT_DOUBLE_EQ(nice_step_at_least(3), 5);
  EXPECT_DOUBLE_EQ(nice_step_at_least(51), 100);
  EXPECT_DOUBLE_EQ(nice_step_at_most(19), 10);
  EXPECT_DOUBLE_EQ(nice_step_at_most(0.5), 0.5);
  EXPECT_DOUBLE_EQ(nice_step_at_most(4.9), 2);
}

TEST(Ticks, StandOnRoundNumbersInsideTheRange) {
  EXPECT_THAT(nice_ticks({-3, 11}, 6).values, ElementsAre(0, 5, 10));
  EXPECT_THAT(nice_ticks({0, 1}, 6).values, ElementsAre(0, 0.2, 0.4, 3 * 0.2, 0.8, 1));
}

TEST(Ticks, AreNeverMoreThanAskedFor) {
  for (int at_most = 1; at_most <= 12; ++at_most) {
    for (const double low : {-0.3, 0.0, 0.99, 17.3, 455'032.0}) {
      for (const double span : {1e-3, 0.7, 1.0, 13.0, 999.0}) {
        const Ticks ticks = nice_ticks({low, low + span}, at_most);
        EXPECT_THAT(ticks.values, SizeIs(Le(at_most))) << low << " " << span;
        const Range range = Range{low, low + span}.padded(1e-6);
        for (const double value : ticks.values) EXPECT_TRUE(range.contains(value)) << value;
      }
    }
  }
}

TEST(Ticks, GiveUpWhereThereIsNothingToDivide) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  EXPECT_THAT(nice_ticks({1, 1}, 5).values, IsEmpty());
  EXPECT_THAT(nice_ticks({0, std::nan("")}, 5).values, IsEmpty());
  EXPECT_THAT(nice_ticks({-kInfinity, kInfinity}, 5).values, IsEmpty());
  EXPECT_THAT(nice_ticks({1e17, 1e17 + 32}, 5).values, IsEmpty());
  EXPECT_THAT(nice_ticks({0, std::numeric_limits<double>::denorm_min()}, 5).values, IsEmpty());
}

TEST(TickLabels, HaveTheDecimalsOfTheirStepAndATrueMinus) {
  EXPECT_THAT(tick_labels(nice_ticks({-0.5, 0.5}, 3)), ElementsAre("−0.5", "0.0", "0.5"));
  EXPECT_THAT(tick_labels(nice_ticks({0, 20'000}, 3)),
              ElementsAre("0", "10\u2009000", "20\u2009000"));
}

TEST(Notation, SubtractsAnOffsetFromMapCoordinates) {
  const Range range{455'032, 455'178};
  const Notation notation = Notation::for_range(range);
  EXPECT_EQ(notation.offset, 455'000);
  EXPECT_EQ(notation.axis_label("x", "m"), "x − 455\u2009000 [m]");
  EXPECT_THAT(tick_labels(nice_ticks(range, 3), notation), ElementsAre("50", "100", "150"));
  const Notation below_zero = Notation::for_range({-455'178, -455'032});
  EXPECT_EQ(below_zero.axis_label("x", "m"), "x + 456\u2009000 [m]");
}

TEST(Notation, TakesOutAPowerOfAThousand) {
  const Range range{0, 4e-5};
  const Notation notation = Notation::for_range(range);
  EXPECT_EQ(notation.axis_label("rotation", "deg/m"), "rotation [10⁻⁶ deg/m]");
  EXPECT_THAT(tick_labels(nice_ticks(range, 3), notation), ElementsAre("0", "20", "40"));
  EXPECT_EQ(Notation::for_range({0, 3e9}).exponent, 9);
}

TEST(Notation, LeavesUsualNumbersAlone) {
  EXPECT_EQ(Notation::for_range({0, 1500}).axis_label("time", "s"), "time [s]");
  EXPECT_EQ(Notation::for_range({0, 0}).axis_label("matches", ""), "matches");
}

}  // namespace
}  // namespace traverse::render
