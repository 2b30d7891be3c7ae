#include "recording/arrival_queue.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace traverse::dataset {
namespace {

using ::testing::ElementsAre;

constexpr std::int64_t kQueueStart = 1'700'000'000'000'000'000;
constexpr std::int64_t kQueueMilli = 1'000'000;

/// Records of sensors, told by milliseconds after the start; after them the recording is over.
std::vector<std::int64_t> read_queue(
    ArrivalQueue& queue, const std::vector<std::pair<std::string, std::int64_t>>& records) {
  std::vector<std::int64_t> stamps;
  std::size_t at = 0;
  const auto read_on = [&] {
    if (at == records.size()) {
      queue.finish();
      return;
    }
    sensors::ImuSample sample;
    sample.sensor = records[at].first;
    sample.stamp = geometry::Stamp{kQueueStart + records[at].second * kQueueMilli};
    queue.push(sample, "record " + std::to_string(++at));
  };
  while (const auto measurement = queue.next(read_on)) {
    stamps.push_back((sensors::stamp_of(*measurement).nanoseconds - kQueueStart) / kQueueMilli);
  }
  return stamps;
}

std::vector<std::string> told_of(const ArrivalQueue& queue) {
  std::vector<std::string> told;
  for (const auto& [reason, count] : queue.skipped().by_reason()) {
    told.push_back(std::to_string(count.count) + " x " + reason + " (" +
                   count.first_places.front() + ")");
  }
  return told;
}

TEST(ArrivalQueue, GivesWhatComesALittleLateInTheOrderOfStamps) {
  for (const auto clock : {ArrivalQueue::Clock::kWatched, ArrivalQueue::Clock::kSteady}) {
    ArrivalQueue queue(clock);
    EXPECT_THAT(
        read_queue(queue, {{"a", 0}, {"b", 100}, {"a", 10}, {"a", 20}, {"b", 200}, {"a", 30}}),
        ElementsAre(0, 10, 20, 30, 100, 200));
    EXPECT_TRUE(queue.is_finished());
    EXPECT_THAT(told_of(queue), ElementsAre());
  }
}

TEST(ArrivalQueue, CountsAStampThatIsThereAlready) {
  ArrivalQueue queue(ArrivalQueue::Clock::kSteady);
  EXPECT_THAT(read_queue(queue, {{"a", 0}, {"a", 10}, {"a", 10}, {"a", 20}}),
              ElementsAre(0, 10, 20));
  EXPECT_THAT(told_of(queue), ElementsAre("1 x stamp not later than the one before (record 3)"));
}

TEST(ArrivalQueue, TellsAStepOfTheClockOnceHoweverOftenItIsRead) {
  std::vector<std::pair<std::string, std::int64_t>> records;
  for (std::int64_t i = 0; i < 20; ++i) records.emplace_back("a", 10 * i);
  for (std::int64_t i = 0; i < 20; ++i) records.emplace_back("a", 10 * i - 60'000);
  std::vector<Fact> facts;
  for (int time = 0; time < 2; ++time) {
    ArrivalQueue queue;
    const auto stamps = read_queue(queue, records);
    EXPECT_EQ(stamps.size(), 40U);
    EXPECT_TRUE(std::is_sorted(stamps.begin(), stamps.end()));
    queue.note_steps(facts);
  }
  EXPECT_EQ(facts.size(), 1U);
}

}  // namespace
}  // namespace traverse::dataset
