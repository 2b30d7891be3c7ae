#include "traverse/dataset/recording_survey.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/dataset/point_cloud_file.hpp"
#include "traverse/files/atomic_file.hpp"

#include "dataset/made_recordings.hpp"
#include "temporary_folder.hpp"

namespace traverse::dataset {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using namespace traverse::testing;  // made recordings

RecordingSurvey survey_of(Source& source) {
  return survey(source, [](const auto&) {});
}

TEST(RecordingSurvey, CountsRatesAndGaps) {
  const TemporaryFolder folder;
  make_kitti_folder(folder.path(), 6);
  files::write_text(folder / "times.txt", "0\n0.1\n0.2\n0.6\n0.7\n0.8\n");
  std::size_t calls = 0;
  const auto source = open(folder.path());
  const RecordingSurvey result = survey(*source, [&](const auto&) { ++calls; });
  EXPECT_EQ(calls, 6U);
  EXPECT_EQ(result.measurements(), 6U);
  EXPECT_NEAR(result.duration_s(), 0.8, 1e-12);
  ASSERT_THAT(result.streams, SizeIs(1));
  const StreamSurvey& stream = result.streams[0];
  EXPECT_EQ(stream.sensor, "velodyne");
  EXPECT_EQ(stream.count, 6U);
  EXPECT_NEAR(stream.median_interval_s, 0.1, 1e-9);
  EXPECT_NEAR(stream.rate_hz(), 5 / 0.8, 1e-9);
  ASSERT_THAT(stream.gaps, SizeIs(1));
  EXPECT_NEAR(stream.gaps[0].seconds, 0.4, 1e-9);
  EXPECT_EQ(stream.gaps[0].begin.nanoseconds, 200'000'000);
}

TEST(RecordingSurvey, FindsTheTroubleInScans) {
  const TemporaryFolder folder;
  make_kitti_folder(folder.path(), 5);
  sensors::LidarScan scan = made_scan(4, 50);
  scan.y[3] = std::nanf("");
  scan.x[4] = scan.y[4] = scan.z[4] = 0;
  write_bin(folder / bin_name(1), scan);
  write_bin(folder / bin_name(2), made_scan(1, 40));
  write_bin(folder / bin_name(3), made_scan(6, 50));
  const auto source = open(folder.path(), {"lidar.rings=4"});
  const RecordingSurvey result = survey_of(*source);
  const LidarSurvey& lidar = *result.streams.at(0).lidar;
  EXPECT_EQ(lidar.points.least, 40U);
  EXPECT_EQ(lidar.points.median, 200U);
  EXPECT_EQ(lidar.points.most, 300U);
  EXPECT_EQ(lidar.rings->least, 1U);
  EXPECT_EQ(lidar.rings->most, 6U);
  EXPECT_EQ(lidar.rings_expected, 4);
  EXPECT_TRUE(lidar.has_intensity);
  EXPECT_FALSE(lidar.has_stored_times);
  ASSERT_THAT(lidar.troubled, SizeIs(3));
  EXPECT_EQ(lidar.troubled[0].frame, 1U);
  EXPECT_EQ(lidar.troubled[0].points.not_finite, 1U);
  EXPECT_EQ(lidar.troubled[0].points.at_origin, 1U);
  EXPECT_EQ(lidar.troubled[1].frame, 2U);
  EXPECT_TRUE(lidar.troubled[1].has_one_ring);
  EXPECT_EQ(lidar.troubled[2].frame, 3U);
  EXPECT_EQ(lidar.troubled[2].points_beyond_rings, 100U);
}

TEST(RecordingSurvey, SaysWhyThereAreNoRingsAndWhatTimesAreStored) {
  const TemporaryFolder folder;
  PointCloud cloud;
  for (const char* name : {"x", "y", "z"}) cloud.add(name, std::vector<float>{1, 2});
  cloud.add("time", std::vector<float>{-0.02F, 0.03F});
  write_pcd(folder / "0.pcd", cloud);
  const auto source = open(folder.path());
  const LidarSurvey lidar = *survey_of(*source).streams.at(0).lidar;
  EXPECT_FALSE(lidar.rings);
  EXPECT_THAT(lidar.why_no_rings, HasSubstr("no ring number"));
  EXPECT_TRUE(lidar.has_stored_times);
  EXPECT_EQ(lidar.earliest_point_time_s, -0.02F);
  EXPECT_EQ(lidar.latest_point_time_s, 0.03F);
  EXPECT_THAT(lidar.troubled, IsEmpty());
}

TEST(RecordingSurvey, TheReferencesOverlapIsCounted) {
  const TemporaryFolder folder;
  make_kitti_folder(folder.path(), 4);
  files::write_text(folder / "gt.tum", "0.05 0 0 0 0 0 0 1\n0.25 3 4 0 0 0 0 1\n");
  const auto source = open(folder.path(), {"reference.file=gt.tum"});
  const auto reference = survey_of(*source).reference;
  ASSERT_TRUE(reference);
  EXPECT_EQ(reference->poses, 2U);
  EXPECT_EQ(reference->length_m, 5);
  EXPECT_EQ(reference->share_covered, 0.5);
}

TEST(RecordingSurvey, OfNothingIsNothing) {
  const TemporaryFolder folder;
  make_kitti_folder(folder.path(), 1);
  write_bin(folder / bin_name(0), {});
  const auto source = open(folder.path());
  const RecordingSurvey result = survey_of(*source);
  EXPECT_THAT(result.streams, IsEmpty());
  EXPECT_EQ(result.duration_s(), 0);
}

}  // namespace
}  // namespace traverse::dataset
