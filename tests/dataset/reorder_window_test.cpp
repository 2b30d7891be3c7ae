#include "recording/reorder_window.hpp"

#include <gtest/gtest.h>

namespace traverse::dataset {
namespace {

ReorderWindow::Entry entry_at(std::int64_t nanoseconds, bool is_scan) {
  if (!is_scan) {
    sensors::ImuSample sample;
    sample.stamp.nanoseconds = nanoseconds;
    return {sample, ""};
  }
  auto scan = std::make_shared<sensors::LidarScan>();
  scan->stamp.nanoseconds = nanoseconds;
  return {std::shared_ptr<const sensors::LidarScan>(std::move(scan)), ""};
}

/// How many of `count` wait whose stamps hardly differ.
std::size_t waiting_of(std::size_t count, bool is_scan) {
  ReorderWindow window;
  std::size_t waiting = 0;
  for (std::size_t i = 0; i < count; ++i) {
    window.push(entry_at(static_cast<std::int64_t>(i), is_scan));
    ++waiting;
    while (window.pop(false)) --waiting;
  }
  return waiting;
}

// Megabytes each: where a recording's clock stands still, a thousand of them are gigabytes.
TEST(ReorderWindow, FewScansWaitHoweverTheyAreStamped) {
  EXPECT_EQ(waiting_of(2000, true), ReorderWindow::kMostScans);
  EXPECT_EQ(waiting_of(2000, false), ReorderWindow::kMost);
}

}  // namespace
}  // namespace traverse::dataset
