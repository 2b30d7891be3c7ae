#include "map_points.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/dataset/point_cloud_file.hpp"
#include "traverse/slam/keyframe_file.hpp"

#include "temporary_folder.hpp"

namespace traverse::mapping {
namespace {

using ::testing::ElementsAre;

MapKeyframe keyframe_at(double seconds, float x) {
  MapKeyframe keyframe;
  keyframe.stamp = geometry::Stamp::from_seconds(seconds);
  keyframe.x = {x, x + 1};
  for (auto* values : {&keyframe.y, &keyframe.z, &keyframe.intensity}) values->assign(2, 0);
  return keyframe;
}

TEST(MapPoints, KnowWhenAndByWhichRingTheyWereSeen) {
  MapKeyframe first = keyframe_at(1.3e9, 0);
  first.time = {0, -0.25F};
  first.ring = {3, 63};
  const MapKeyframe second = keyframe_at(1.3e9 + 1, 10);  // of a map that does not know
  const std::vector<MapKeyframe> keyframes{first, second};
  const MapPoints points = map_points(keyframes, 0.1);
  const auto at = geometry::Stamp::from_seconds;
  EXPECT_THAT(points.stamp, ElementsAre(at(1.3e9), at(1.3e9 - 0.25), at(1.3e9 + 1), at(1.3e9 + 1)));
  EXPECT_THAT(points.ring, ElementsAre(3, 63, MapPoints::kNoRing, MapPoints::kNoRing));
  EXPECT_THAT(points.keyframe, ElementsAre(0, 0, 1, 1));
}

TEST(MapPoints, AttributesAreWrittenWhenAskedFor) {
  const testing::TemporaryFolder folder;
  std::vector<MapKeyframe> keyframes{keyframe_at(1.3e9, 0)};
  const auto fields = [&](bool with_attributes) {
    write_ply(folder / "map.ply", map_points(keyframes, 0.1), with_attributes);
    std::vector<std::string> names;
    const dataset::PointCloud cloud = dataset::read_point_cloud(folder / "map.ply");
    for (const auto& field : cloud.fields()) {
      names.push_back(field.name);
    }
    return names;
  };
  EXPECT_THAT(fields(false), ElementsAre("x", "y", "z", "intensity"));
  EXPECT_THAT(fields(true), ElementsAre("x", "y", "z", "intensity", "time", "keyframe"));
  keyframes.front().ring = {1, 2};
  EXPECT_THAT(fields(true), ElementsAre("x", "y", "z", "intensity", "time", "ring", "keyframe"));
}

TEST(MapPoints, KeyframesOfARunWithLoopsKeepTheirAttributes) {
  const testing::TemporaryFolder folder;
  slam::KeyframeStore store(1'000'000);
  slam::Keyframe made;
  made.stamp = geometry::Stamp::from_seconds(1.3e9);
  made.points.x = {1, 2, 3};
  made.points.y = made.points.z = made.points.intensity = made.points.x;
  made.points.time = {0.05F, 0, -0.05F};
  made.points.ring = {0, 31, 15};
  store.add(made);
  slam::write_keyframes(folder / "keyframes.simplemap", store,
                        [](std::size_t) { return geometry::Pose3::identity(); });
  const auto read = read_simple_map(folder / "keyframes.simplemap");
  ASSERT_EQ(read.size(), 1U);
  EXPECT_EQ(read[0].sensor, "map points");
  EXPECT_EQ(read[0].x, made.points.x);
  EXPECT_EQ(read[0].time, made.points.time);
  EXPECT_EQ(read[0].ring, made.points.ring);
}

}  // namespace
}  // namespace traverse::mapping
