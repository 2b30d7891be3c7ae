#include "recording/stamp_sequence.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace traverse::dataset {
namespace {

using geometry::Stamp;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

StampSequence sequence_of(const std::vector<double>& seconds) {
  std::vector<std::optional<Stamp>> stamps;
  for (const double s : seconds) {
    stamps.push_back(std::isnan(s) ? std::nullopt : std::optional(Stamp::from_seconds(s)));
  }
  return StampSequence::of(stamps);
}

/// The numbers of the records that are not kept.
std::vector<std::size_t> dropped(const StampSequence& sequence) {
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < sequence.records.size(); ++i) {
    if (!sequence.records[i].stamp) numbers.push_back(i);
  }
  return numbers;
}

/// A sensor of 10 Hz.
std::vector<double> regular(std::size_t records, double first = 0) {
  std::vector<double> seconds;
  for (std::size_t i = 0; i < records; ++i) seconds.push_back(first + 0.1 * static_cast<double>(i));
  return seconds;
}

TEST(StampSequence, KeepsWhatGrows) {
  EXPECT_THAT(dropped(sequence_of({})), IsEmpty());
  EXPECT_THAT(dropped(sequence_of({5})), IsEmpty());
  EXPECT_THAT(dropped(sequence_of({0, 1e5})), IsEmpty());            // nobody can tell
  EXPECT_THAT(dropped(sequence_of({0, 100, 200, 300})), IsEmpty());  // a slow sensor
  EXPECT_THAT(dropped(sequence_of({0, 0.1, 30, 30.1})), IsEmpty());  // a pause
  const StampSequence all = sequence_of(regular(1000));
  EXPECT_THAT(dropped(all), IsEmpty());
  EXPECT_THAT(all.steps, IsEmpty());
  EXPECT_NEAR(all.usual_interval_s, 0.1, 1e-12);
}

TEST(StampSequence, OneWrongStampCostsOneRecordWhereverItStands) {
  for (const double off : {1e5, 3600.0, 61.0, 0.35, 0.15, -0.15, -0.35, -61.0, -3600.0, -1e5}) {
    for (const std::size_t at : {0U, 1U, 2U, 11U, 12U, 21U, 22U, 23U}) {
      auto seconds = regular(24, 1e6);
      seconds[at] += off;
      // At an end a stamp that is not far off is in order.
      const bool in_order =
          (at == 0 && off > -60 && off < 0.1) || (at == 23 && off > 0 && off < 60);
      const auto expected = in_order ? std::vector<std::size_t>{} : std::vector<std::size_t>{at};
      const StampSequence found = sequence_of(seconds);
      EXPECT_EQ(dropped(found).size(), expected.size()) << off << " at " << at;
      if (std::abs(off) > 1) {  // else two neighbours may be swapped, and either is wrong
        EXPECT_EQ(dropped(found), expected) << off << " at " << at;
      }
      EXPECT_THAT(found.steps, IsEmpty()) << off << " at " << at;
    }
  }
}

TEST(StampSequence, SeveralWrongStampsCostAsManyRecords) {
  auto seconds = regular(40);
  seconds[5] = 1e9;
  seconds[6] = 1e9 + 0.1;  // two in a row
  seconds[17] = 0;
  seconds[18] = -1;
  seconds[30] = std::nan("");
  const StampSequence found = sequence_of(seconds);
  EXPECT_THAT(dropped(found), ElementsAre(5, 6, 17, 18, 30));
  EXPECT_STREQ(found.records[5].fault, StampSequence::kAhead);
  EXPECT_STREQ(found.records[17].fault, StampSequence::kNotLater);
  EXPECT_STREQ(found.records[30].fault, StampSequence::kNone);
}

TEST(StampSequence, OfEqualAndSwappedStampsTheFirstIsKept) {
  EXPECT_THAT(dropped(sequence_of({0, 0.1, 0.1, 0.2})), ElementsAre(2));
  EXPECT_THAT(dropped(sequence_of({0, 0.2, 0.1, 0.3})), ElementsAre(2));
  EXPECT_THAT(dropped(sequence_of({1, 1, 1, 1})), ElementsAre(1, 2, 3));
}

TEST(StampSequence, AClockThatIsSetBackGoesOnWhereItWas) {
  for (const double back : {0.5, 1.0, 100.0, 1e8}) {
    auto seconds = regular(24, 1e9);
    for (std::size_t i = 12; i < 24; ++i) seconds[i] -= back;
    StampSequence found = sequence_of(seconds);
    EXPECT_THAT(dropped(found), IsEmpty()) << back;
    ASSERT_EQ(found.steps.size(), 1U) << back;
    EXPECT_EQ(found.steps[0].record, 12U);
    EXPECT_TRUE(found.steps[0].is_back());
    EXPECT_NEAR(found.steps[0].moved_s, back, 1e-6);
    found.apply_steps();
    for (std::size_t i = 0; i < 24; ++i) {
      EXPECT_NEAR(found.records[i].stamp->seconds(), 1e9 + 0.1 * static_cast<double>(i), 1e-6);
    }
  }
}

TEST(StampSequence, AfterAStepForwardTheStampsStay) {
  auto seconds = regular(24);
  for (std::size_t i = 12; i < 24; ++i) seconds[i] += 1e9;
  StampSequence found = sequence_of(seconds);
  EXPECT_THAT(dropped(found), IsEmpty());
  ASSERT_EQ(found.steps.size(), 1U);
  EXPECT_FALSE(found.steps[0].is_back());
  found.apply_steps();
  EXPECT_NEAR(found.records[12].stamp->seconds(), 1e9 + 1.2, 1e-6);
}

TEST(StampSequence, StepsThereAndBackAndWrongStampsBetweenThem) {
  auto seconds = regular(60);
  for (std::size_t i = 20; i < 40; ++i) seconds[i] -= 50;
  seconds[30] = 1e7;
  StampSequence found = sequence_of(seconds);
  EXPECT_THAT(dropped(found), ElementsAre(30));
  found.apply_steps();
  std::optional<Stamp> last;
  for (const RecordStamp& record : found.records) {
    if (!record.stamp) continue;
    if (last) {
      EXPECT_GT(*record.stamp, *last);
    }
    last = record.stamp;
  }
}

// Sensors of one clock show a step by different intervals: the fastest tells it best.
TEST(StampSequence, SensorsOfOneClockMoveByTheSame) {
  const auto stamps_of = [](double interval, double first) {
    std::vector<double> seconds;
    for (double t = first; t < 40; t += interval) seconds.push_back(t < 20 ? t : t - 100);
    return sequence_of(seconds);
  };
  const auto no_place = [](std::size_t) { return std::string("there"); };
  std::vector<SensorStamps> sensors{{"gnss", stamps_of(1, 0.4), no_place},
                                    {"imu", stamps_of(0.01, 0.003), no_place},
                                    {"lidar", stamps_of(0.1, 0.05), no_place}};
  std::vector<Fact> facts;
  settle_steps(sensors, facts);
  EXPECT_EQ(facts.size(), 3U);
  for (const SensorStamps& sensor : sensors) {
    ASSERT_EQ(sensor.sequence.steps.size(), 1U) << sensor.sensor;
    EXPECT_NEAR(sensor.sequence.steps[0].moved_s, 100, 1e-6) << sensor.sensor;
  }
  EXPECT_THAT(facts[1].value, ::testing::HasSubstr("imu: by 99.990 s, from there on, stamped "
                                                   "-79.997000000 after 19.993000000"));
}

TEST(StampSequence, IsQuickHoweverStampsAreDisordered) {
  std::mt19937 random(1);
  std::vector<double> seconds;
  for (int i = 0; i < 200'000; ++i) seconds.push_back(static_cast<double>(random() % 1'000'000));
  const StampSequence found = sequence_of(seconds);
  EXPECT_EQ(found.records.size(), seconds.size());
}

}  // namespace
}  // namespace traverse::dataset
