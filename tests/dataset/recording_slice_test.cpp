#include "traverse/dataset/recording_slice.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dataset/made_recordings.hpp"
#include "dataset/rawlog_maker.hpp"
#include "temporary_folder.hpp"

namespace traverse::dataset {
namespace {

using ::testing::ElementsAre;
using namespace traverse::testing;  // made recordings and rawlogs

/// "L" for a frame, "i" for an IMU sample, of the slice.
std::string letters(Source& source, const Slice& slice, SliceCount* count = nullptr) {
  std::string text;
  const SliceCount counted = for_each_in_slice(source, slice, [&](const auto& measurement) {
    text += std::holds_alternative<ScanPtr>(measurement) ? "L" : "i";
  });
  if (count != nullptr) *count = counted;
  return text;
}

TEST(RecordingSlice, TakesFramesFirstToLastAndWhatIsAroundThem) {
  const TemporaryFolder folder;
  {
    RawlogMaker maker(folder / "a.rawlog");
    for (int frame = 0; frame < 4; ++frame) {
      for (int i = 0; i <= frame; ++i) maker.add(made_imu(frame + 0.1 * i));
      maker.add(made_velodyne(frame + 0.9));
    }
  }
  const auto source = open(folder / "a.rawlog");
  EXPECT_EQ(letters(*source, {}), "iLiiLiiiLiiiiL");
  source->rewind();
  SliceCount count;
  EXPECT_EQ(letters(*source, {"", 1, 2}, &count), "iiLiiiLiiii");
  EXPECT_EQ(count.frames, 2U);
  EXPECT_EQ(count.others, 9U);
  source->rewind();
  EXPECT_EQ(letters(*source, {"top", 0, 0}), "iLii");
  source->rewind();
  EXPECT_EQ(letters(*source, {"", 7, 9}), "");
}

TEST(RecordingSlice, CountsTheLidarThatIsNamed) {
  const TemporaryFolder folder;
  {
    RawlogMaker maker(folder / "a.rawlog");
    for (int i = 0; i < 4; ++i) {
      maker.add(made_velodyne(i, 6, "left"));
      maker.add(made_velodyne(i + 0.5, 6, "right"));
    }
  }
  const auto source = open(folder / "a.rawlog");
  std::vector<std::string> taken;
  for_each_in_slice(*source, {"right", 1, 1},
                    [&](const auto& measurement) { taken.push_back(sensor_of(measurement)); });
  EXPECT_THAT(taken, ElementsAre("left", "right", "left"));
}

}  // namespace
}  // namespace traverse::dataset
