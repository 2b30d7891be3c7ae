#include "map_points.hpp"

#include <cstring>
#include <filesystem>
#include <limits>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/dataset/point_cloud_file.hpp"
#include "traverse/files/binary_file.hpp"
#include "traverse/mapping/las_export.hpp"
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

/// Of a LAS file's point, as the specification counts its bytes.
template <typename T>
T las_value(const std::filesystem::path& las, std::size_t point, std::size_t offset) {
  const std::vector<std::byte> bytes = files::read_bytes(las);
  std::uint32_t points_at = 0;
  std::memcpy(&points_at, bytes.data() + 96, sizeof points_at);
  T value{};
  std::memcpy(&value, bytes.data() + points_at + 30 * point + offset, sizeof value);
  return value;
}

TEST(LasExport, TakesIntensityTimeAndRingAlong) {
  const testing::TemporaryFolder folder;
  dataset::PointCloud cloud;
  cloud.add("x", std::vector<double>{1, std::numeric_limits<double>::quiet_NaN(), 3});
  cloud.add("y", std::vector<float>{0, 0, 0.25F});
  cloud.add("z", std::vector<float>{0, 0, -1});
  cloud.add("intensity", std::vector<std::uint8_t>{255, 1, 51});
  cloud.add("time", std::vector<double>{1.7e9, 1.7e9, 1.7e9 + 0.5});
  cloud.add("ring", std::vector<std::uint16_t>{7, 8, 1000});
  dataset::write_ply(folder / "cloud.ply", cloud);
  const auto result = export_las(folder / "cloud.ply", {}, LasFrame::kGrid, folder / "cloud.las");
  EXPECT_EQ(result.points, 2U);
  EXPECT_EQ(result.left_out, 1U);
  EXPECT_TRUE(result.has_gps_time);
  EXPECT_THAT(result.frame, ::testing::HasSubstr("tied to no place"));
  const auto las = folder / "cloud.las";
  EXPECT_EQ(las_value<std::int32_t>(las, 1, 0), 3000);
  EXPECT_EQ(las_value<std::int32_t>(las, 1, 4), 250);
  EXPECT_EQ(las_value<std::int32_t>(las, 1, 8), -1000);
  EXPECT_EQ(las_value<std::uint16_t>(las, 0, 12), 65535);
  EXPECT_EQ(las_value<std::uint16_t>(las, 1, 12), 13107);
  EXPECT_EQ(las_value<std::uint8_t>(las, 0, 17), 7);
  EXPECT_EQ(las_value<std::uint8_t>(las, 1, 17), 255);  // more than a byte holds: not known
  EXPECT_NEAR(las_value<double>(las, 1, 22), 384'035'218.5, 1e-6);
}

}  // namespace
}  // namespace traverse::mapping
