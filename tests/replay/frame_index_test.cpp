#include "traverse/replay/frame_index.hpp"

#include <fstream>

#include <gtest/gtest.h>

#include "traverse/replay/recording.hpp"

#include "replay/simulated_rawlog.hpp"
#include "temporary_folder.hpp"

namespace traverse::replay {
namespace {

namespace fs = std::filesystem;

FrameIndex index_of(const fs::path& file) {
  const auto recording = Recording::open(file, testing::open_options());
  IndexObserver observer;
  observer.frame = [](geometry::Stamp) {};
  observer.progress = [](double) {};
  return build_index(*recording.source(), recording.frame_sensor(), observer).value();
}

class FrameIndexTest : public ::testing::Test {
 protected:
  FrameIndexTest() { testing::write_simulated_rawlog(file_, 8, 0); }

  testing::TemporaryFolder folder_;
  fs::path file_ = folder_ / "street.rawlog";
};

TEST_F(FrameIndexTest, KnowsEveryFrame) {
  const FrameIndex index = index_of(file_);
  ASSERT_EQ(index.frames.size(), 8U);
  EXPECT_EQ(index.frames[3], geometry::Stamp::from_seconds(0.3));
  EXPECT_TRUE(index.skipped.empty());
}

TEST_F(FrameIndexTest, OfACutOffFileIsWhatIsThere) {
  const FrameIndex whole = index_of(file_);
  fs::resize_file(file_, fs::file_size(file_) * 5 / 8);
  const FrameIndex index = index_of(file_);
  ASSERT_GE(index.frames.size(), 3U);
  ASSERT_LE(index.frames.size(), 5U);
  EXPECT_TRUE(std::equal(index.frames.begin(), index.frames.end(), whole.frames.begin()));
  ASSERT_EQ(index.skipped.size(), 1U);
  EXPECT_EQ(index.skipped[0].reason, "the file is cut short: the rest of the file is not read");
}

TEST_F(FrameIndexTest, IsKeptAndBelongsToOneStateOfTheFile) {
  const FrameIndex index = index_of(file_);
  const fs::path kept = folder_ / "cache/index.json";
  const std::string digest = quick_digest(file_);
  save_index(kept, digest, "lidar", index);
  EXPECT_EQ(load_index(kept, digest, "lidar"), index);
  EXPECT_EQ(load_index(kept, digest, "another"), std::nullopt);
  fs::resize_file(file_, fs::file_size(file_) - 1);
  EXPECT_NE(quick_digest(file_), digest);
  EXPECT_EQ(load_index(kept, quick_digest(file_), "lidar"), std::nullopt);

  std::ofstream(kept) << "{\"version\": 1, \"digest\"";
  EXPECT_EQ(load_index(kept, digest, "lidar"), std::nullopt);
  EXPECT_EQ(load_index(folder_ / "none.json", digest, "lidar"), std::nullopt);
}

TEST_F(FrameIndexTest, StopsWhenTold) {
  const auto recording = Recording::open(file_, testing::open_options());
  const std::atomic<bool> stop{true};
  IndexObserver observer;
  observer.stop = &stop;
  EXPECT_EQ(build_index(*recording.source(), recording.frame_sensor(), observer), std::nullopt);
}

}  // namespace
}  // namespace traverse::replay
