#include "traverse/replay/checkpoints.hpp"

#include <gtest/gtest.h>

#include "path_estimator.hpp"

namespace traverse::replay {
namespace {

constexpr std::size_t kMegabyte = 1 << 20;

/// Says that it is large.
class LargeEstimator final : public pipeline::Estimator {
 public:
  explicit LargeEstimator(std::size_t bytes) : bytes_(bytes) {}

  const std::vector<std::string>& columns() const override { return small_.columns(); }
  std::vector<pipeline::PoseFrame> process(const sensors::Measurement&) override { return {}; }
  std::vector<pipeline::PoseFrame> finish() override { return {}; }
  pipeline::UsedScan used_scan(const sensors::LidarScan&, const pipeline::PoseFrame&,
                               bool) const override {
    return {};
  }
  std::string points_are() const override { return ""; }
  std::vector<pipeline::Decision> decisions() const override { return {}; }
  std::unique_ptr<pipeline::Estimator> clone() const override {
    return std::make_unique<LargeEstimator>(*this);
  }
  std::size_t bytes() const override { return bytes_; }

 private:
  PathEstimator small_{"wheels"};
  std::size_t bytes_;
};

Checkpoint at(std::size_t frame, std::size_t bytes = 0) {
  Checkpoint checkpoint;
  checkpoint.state.next_frame = frame;
  checkpoint.state.estimator = std::make_unique<LargeEstimator>(bytes);
  return checkpoint;
}

TEST(Checkpoints, StayBoundedAndDenseNearThePresent) {
  Checkpoints checkpoints;
  for (std::size_t frame = 0; frame <= 10000; frame += 10) checkpoints.add(at(frame));
  const std::vector<std::size_t> frames = checkpoints.frames();
  EXPECT_EQ(frames.size(), Checkpoints::kMost);
  EXPECT_EQ(frames.front(), 0U);
  EXPECT_EQ(frames.back(), 10000U);
  EXPECT_LE(10000U - frames[frames.size() - 2], 30U);
  // The way to any frame stays short against the way back to it from the present.
  for (std::size_t i = 1; i < frames.size(); ++i) {
    EXPECT_LE(frames[i] - frames[i - 1], 20 + (10000 - frames[i - 1])) << frames[i];
  }
  EXPECT_LE(frames[frames.size() - 2] - frames[frames.size() - 8], 2000U);
}

TEST(Checkpoints, StayBoundedInBytes) {
  Checkpoints checkpoints(100 * kMegabyte);
  for (std::size_t frame = 0; frame <= 300; frame += 10) {
    checkpoints.add(at(frame, 9 * kMegabyte));
    EXPECT_LE(checkpoints.bytes(), 100 * kMegabyte);
    EXPECT_EQ(checkpoints.bytes(), 9 * kMegabyte * checkpoints.size());
  }
  EXPECT_EQ(checkpoints.size(), 11U);
  EXPECT_EQ(checkpoints.frames().front(), 0U);
  EXPECT_EQ(checkpoints.frames().back(), 300U);

  checkpoints.add(at(300, 20 * kMegabyte));  // in place of the one there was
  EXPECT_EQ(checkpoints.bytes(), 20 * kMegabyte + 9 * kMegabyte * (checkpoints.size() - 1));
  EXPECT_LE(checkpoints.bytes(), 100 * kMegabyte);
  checkpoints.clear();
  EXPECT_EQ(checkpoints.bytes(), 0U);
}

TEST(Checkpoints, TheFirstAndTheNewestStayHoweverLarge) {
  Checkpoints checkpoints(kMegabyte);
  for (std::size_t frame = 0; frame <= 40; frame += 10) checkpoints.add(at(frame, kMegabyte));
  EXPECT_EQ(checkpoints.frames(), (std::vector<std::size_t>{0, 40}));
  checkpoints.add(at(20, kMegabyte));  // on the way back the last one makes room
  EXPECT_EQ(checkpoints.frames(), (std::vector<std::size_t>{0, 20}));
}

TEST(Checkpoints, ScansThatWaitCount) {
  sensors::LidarScan scan;
  scan.x.resize(1000);
  Checkpoint checkpoint = at(0);
  checkpoint.state.waiting.emplace_back(std::make_shared<const sensors::LidarScan>(scan));
  Checkpoints checkpoints;
  checkpoints.add(std::move(checkpoint));
  EXPECT_GE(checkpoints.bytes(), 20'000U);
}

TEST(Checkpoints, TheOneBeforeAFrameIsTheNearest) {
  Checkpoints checkpoints;
  EXPECT_EQ(checkpoints.before(5), nullptr);
  for (std::size_t frame : {0U, 10U, 20U}) checkpoints.add(at(frame));
  EXPECT_EQ(checkpoints.before(9)->state.next_frame, 0U);
  EXPECT_EQ(checkpoints.before(10)->state.next_frame, 10U);
  EXPECT_EQ(checkpoints.before(500)->state.next_frame, 20U);
}

}  // namespace
}  // namespace traverse::replay
