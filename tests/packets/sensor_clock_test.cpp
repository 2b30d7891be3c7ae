#include "traverse/packets/sensor_clock.hpp"

#include <cstdint>
#include <cstdlib>

#include <gtest/gtest.h>

namespace traverse::packets {
namespace {

constexpr std::int64_t kNow = 1'700'000'000'000'000'000;
constexpr std::int64_t kHour = 3'600'000'000'000;

/// Under the sanitizers no sum may leave 64 bits, whatever a damaged packet or capture tells.
TEST(SensorClock, WhateverAPacketTellsStaysNearItsArrival) {
  for (const std::int64_t period : {std::int64_t{0}, kHour}) {
    SensorClock clock(period);
    for (const std::int64_t sensor :
         {std::int64_t{1'000'000'000}, std::int64_t{8'319'642'749'055'453'696}, INT64_MAX,
          std::int64_t{0}, kNow, INT64_MAX / 2, std::int64_t{-1}}) {
      const SensorClock::Reading reading = clock.at(sensor, geometry::Stamp{kNow});
      EXPECT_LE(std::llabs(reading.stamp.nanoseconds - kNow), kHour) << period << ' ' << sensor;
    }
    for (const std::int64_t arrival : {INT64_MIN, INT64_MAX, std::int64_t{0}, -kNow, kNow}) {
      for (const std::int64_t sensor : {std::int64_t{0}, INT64_MAX, INT64_MIN, kNow}) {
        static_cast<void>(clock.at(sensor, geometry::Stamp{arrival}));
      }
    }
    EXPECT_GT(clock.steps(), 0U);
  }
}

}  // namespace
}  // namespace traverse::packets
