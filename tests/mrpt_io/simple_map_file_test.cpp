#include "traverse/mrpt_io/simple_map_file.hpp"

#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>

#include "traverse/files/input_error.hpp"
#include "traverse/mrpt_io/gz_stream.hpp"
#include "traverse/mrpt_io/point_attributes.hpp"

#include "file_size_limit.hpp"
#include "temporary_folder.hpp"

namespace traverse::mrpt_io {
namespace {

mrpt::poses::CPose3DPDF::Ptr made_pose(std::size_t i) {
  return mrpt::poses::CPose3DPDFGaussian::Create(
      mrpt::poses::CPose3D(static_cast<double>(i), -2, 0.5, 0.1, 0, 0.2));
}

mrpt::obs::CSensoryFrame::Ptr made_frame(std::size_t i) {
  auto points = mrpt::maps::CPointsMapXYZI::Create();
  for (std::size_t k = 0; k <= i; ++k) points->insertPoint(static_cast<float>(k), 1, 2);
  auto cloud = mrpt::obs::CObservationPointCloud::Create();
  cloud->sensorLabel = "lidar";
  cloud->timestamp = mrpt::Clock::fromDouble(1.3e9);
  cloud->pointcloud = points;
  auto comment = mrpt::obs::CObservationComment::Create();
  comment->text = std::string(100, 'x');
  comment->timestamp = cloud->timestamp;
  auto frame = mrpt::obs::CSensoryFrame::Create();
  frame->insert(cloud);
  frame->insert(comment);
  return frame;
}

void write(const std::filesystem::path& file, std::size_t keyframes) {
  write_simple_map(file, keyframes, [](auto& archive, std::size_t i) {
    archive << *made_pose(i) << *made_frame(i);
  });
}

std::string bytes_of(const std::filesystem::path& file) {
  GzInput stream(file);
  std::string bytes;
  for (;;) {
    const std::string next(stream.peek(1000));
    if (next.empty()) return bytes;
    bytes += next;
    std::string taken(next.size(), ' ');
    stream.Read(taken.data(), taken.size());
  }
}

TEST(SimpleMapFile, IsWhatMrptWrites) {
  const testing::TemporaryFolder folder;
  mrpt::maps::CSimpleMap map;
  for (std::size_t i = 0; i < 3; ++i) map.insert(made_pose(i), made_frame(i));
  ASSERT_TRUE(map.saveToFile((folder / "by_mrpt.simplemap").string()));
  write(folder / "one_by_one.simplemap", 3);
  const std::string expected = bytes_of(folder / "by_mrpt.simplemap");
  EXPECT_GT(expected.size(), 500U);
  EXPECT_TRUE(bytes_of(folder / "one_by_one.simplemap") == expected);

  mrpt::maps::CSimpleMap read;
  ASSERT_TRUE(read.loadFromFile((folder / "one_by_one.simplemap").string()));
  ASSERT_EQ(read.size(), 3U);
  EXPECT_EQ(read.getAsPair(2).pose->getMeanVal().x(), 2);
  EXPECT_EQ(read.getAsPair(2).sf->size(), 2U);
}

TEST(SimpleMapFile, IsReadOneKeyframeAfterTheOther) {
  const testing::TemporaryFolder folder;
  write(folder / "map.simplemap", 4);
  std::vector<double> x;
  const std::size_t count = for_each_keyframe(
      folder / "map.simplemap", [&](std::size_t i, const auto& pose, const auto& frame) {
        EXPECT_EQ(i, x.size());
        EXPECT_EQ(frame.size(), 2U);
        x.push_back(pose.getMeanVal().x());
      });
  EXPECT_EQ(count, 4U);
  EXPECT_EQ(x, (std::vector<double>{0, 1, 2, 3}));
}

TEST(SimpleMapFile, WhatStopsTheReaderIsTold) {
  const testing::TemporaryFolder folder;
  write(folder / "map.simplemap", 4);
  const auto nothing = [](std::size_t, const auto&, const auto&) {};
  const auto refuse = [](std::size_t, const auto&, const auto&) { throw std::out_of_range("no"); };
  EXPECT_THROW(for_each_keyframe(folder / "map.simplemap", refuse), std::out_of_range);
  EXPECT_THROW(for_each_keyframe(folder / "none.simplemap", nothing), files::InputError);
  std::ofstream(folder / "text.simplemap") << "no map";
  EXPECT_THROW(for_each_keyframe(folder / "text.simplemap", nothing), files::InputError);
  std::ifstream whole(folder / "map.simplemap", std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(whole)), {});
  std::ofstream(folder / "cut.simplemap", std::ios::binary) << bytes.substr(0, bytes.size() / 2);
  EXPECT_THROW(for_each_keyframe(folder / "cut.simplemap", nothing), files::InputError);
}

TEST(SimpleMapFile, AFullDiskIsAnErrorAndLeavesNothing) {
  const testing::TemporaryFolder folder;
  {
    const testing::FileSizeLimit limit(256);
    EXPECT_THROW(write(folder / "map.simplemap", 50), files::OutputError);
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(PointAttributes, StandBesideTheCloudAndAreNotPoints) {
  const testing::TemporaryFolder folder;
  PointAttributes made;
  made.time = {0, 0.05F, -0.1F};
  made.ring = {0, 5, 63};
  write_simple_map(folder / "map.simplemap", 1, [&](auto& archive, std::size_t) {
    const auto frame = made_frame(2);
    frame->insert(to_observation(made, geometry::Stamp::from_seconds(1.3e9)));
    archive << *made_pose(0) << *frame;
  });
  mrpt::maps::CSimpleMap read;  // by MRPT alone
  ASSERT_TRUE(read.loadFromFile((folder / "map.simplemap").string()));
  const mrpt::obs::CSensoryFrame& frame = *read.getAsPair(0).sf;
  const PointAttributes attributes = attributes_of(frame, 3);
  EXPECT_EQ(attributes.time, made.time);
  EXPECT_EQ(attributes.ring, made.ring);
  EXPECT_TRUE(attributes_of(frame, 4).empty());
  EXPECT_TRUE(attributes_of(*made_frame(2), 3).empty());  // of an older file
  mrpt::maps::CPointsMapXYZI points;
  points.insertionOptions.minDistBetweenLaserPoints = 0;
  frame.insertObservationsInto(points);
  EXPECT_EQ(points.size(), 3U);
}

}  // namespace
}  // namespace traverse::mrpt_io
