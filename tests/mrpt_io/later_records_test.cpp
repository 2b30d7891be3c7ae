#include <cstdint>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/math/CMatrixFixed.h>
#include <mrpt/math/matrix_serialization.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationGPS.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>
#include <mrpt/serialization/CArchive.h>

#include "traverse/files/atomic_file.hpp"
#include "traverse/mrpt_io/lidar_observations.hpp"
#include "traverse/mrpt_io/rawlog_reader.hpp"
#include "traverse/mrpt_io/simple_map_file.hpp"

#include "mrpt_io/archive_object.hpp"
#include "temporary_folder.hpp"

/// Records as MRPT 2.11.4 to 3.1.2 write them, made here number by number.
namespace traverse::mrpt_io {
namespace {

using mrpt::serialization::CArchive;
using ::testing::ElementsAre;
using testing::Fill;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::TemporaryFolder;
using testing::write_object;

std::string bytes_of(const Fill& fill) {
  mrpt::io::CMemoryStream memory;
  auto archive = mrpt::serialization::archiveFrom(memory);
  fill(archive);
  return {static_cast<const char*>(memory.getRawBufferData()), memory.getTotalBytesCount()};
}

std::string object(const std::string& name, std::uint8_t version, const Fill& fill) {
  return bytes_of([&](CArchive& archive) { write_object(archive, name, version, fill); });
}

template <typename Number>
void write_numbers(CArchive& archive, const std::vector<Number>& numbers) {
  for (const Number number : numbers) archive << number;
}

template <typename Number>
void write_counted(CArchive& archive, const std::vector<Number>& numbers) {
  archive << static_cast<std::uint32_t>(numbers.size());
  write_numbers(archive, numbers);
}

mrpt::Clock::time_point stamp() { return mrpt::Clock::fromDouble(1.7e9); }

/// TInsertionOptions and TLikelihoodOptions; version 1 of the first since 2.15.3.
void write_options(CArchive& archive, std::int8_t version) {
  archive << version << 0.02F << true << false;
  if (version == 0) archive << true;
  archive << true << false << 0.01F << 2.0F << true;
  archive << std::int8_t{0} << 0.5 << 1.0 << std::uint32_t{10};
}

void write_points(CArchive& archive) {
  archive << std::uint32_t{3};
  write_numbers<float>(archive, {1, 2, 3});
  write_numbers<float>(archive, {4, 5, 6});
  write_numbers<float>(archive, {7, 8, 9});
}

/// CObservationPointCloud 0 around a cloud.
std::string cloud_record(const std::string& name, std::uint8_t version, const Fill& fill) {
  return object("mrpt::obs::CObservationPointCloud", 0, [&](CArchive& archive) {
    archive << std::string("lidar") << stamp() << mrpt::poses::CPose3D() << std::uint8_t{0};
    write_object(archive, name, version, fill);
  });
}

/// Reads a rawlog of these records, behind which an IMU record stands that any MRPT writes.
class Rawlog {
 public:
  explicit Rawlog(const std::string& records) {
    const std::string tail =
        bytes_of([](CArchive& archive) { archive << mrpt::obs::CObservationIMU(); });
    files::write_text(folder_ / "drive.rawlog", records + tail);
    RawlogReader reader(folder_ / "drive.rawlog");
    while (auto record = reader.next()) records_.push_back(*record);
    if (reader.fault()) fault_ = reader.fault()->reason + " at " + reader.fault()->place;
    is_whole_ = records_.size() >= 2 && records_.back().class_name == "CObservationIMU";
  }
  template <typename Class>
  std::shared_ptr<Class> first() const {
    return records_.empty() ? nullptr : std::dynamic_pointer_cast<Class>(records_.front().object);
  }
  bool is_whole() const { return is_whole_ && fault_.empty(); }
  std::size_t size() const { return records_.size(); }
  const std::string& fault() const { return fault_; }

 private:
  TemporaryFolder folder_;
  std::vector<RawlogRecord> records_;
  std::string fault_;
  bool is_whole_ = false;
};

mrpt::obs::gnss::Message_NMEA_GGA gga() {
  mrpt::obs::gnss::Message_NMEA_GGA message;
  message.fields.latitude_degrees = 48.5;
  message.fields.longitude_degrees = 11.25;
  message.fields.fix_quality = 4;
  return message;
}

void fill_gps(CArchive& archive, int version, bool has_covariance) {
  archive << stamp() << stamp() << std::string("gps") << mrpt::poses::CPose3D(1, 2, 3) << true;
  if (version >= 12) {
    archive << std::string("std::optional") << std::string("CMatrixDouble33") << has_covariance;
    if (has_covariance) archive << mrpt::math::CMatrixDouble33::Identity();
  }
  if (version >= 13) archive << std::uint8_t{4} << std::uint16_t{3};
  archive << std::uint32_t{1};
  gga().writeToStream(archive);
}

TEST(LaterRecords, GpsOfEveryVersion) {
  for (const int version : {11, 12, 13}) {  // 11 is read by MRPT itself: they agree
    for (const bool has_covariance : {false, true}) {
      const Rawlog log(
          object("mrpt::obs::CObservationGPS", static_cast<std::uint8_t>(version),
                 [&](CArchive& archive) { fill_gps(archive, version, has_covariance); }));
      ASSERT_TRUE(log.is_whole()) << version << log.fault();
      const auto gps = log.first<mrpt::obs::CObservationGPS>();
      ASSERT_TRUE(gps);
      EXPECT_EQ(gps->sensorLabel, "gps");
      EXPECT_EQ(gps->sensorPose.z(), 3);
      EXPECT_EQ(gps->timestamp, stamp());
      EXPECT_EQ(gps->getMsgByClass<mrpt::obs::gnss::Message_NMEA_GGA>().fields.latitude_degrees,
                48.5);
    }
  }
}

TEST(LaterRecords, GpsWithinASensoryFrame) {
  const Rawlog log(object("mrpt::obs::CSensoryFrame", 2, [](CArchive& archive) {
    archive << std::uint32_t{1};
    write_object(archive, "mrpt::obs::CObservationGPS", 13,
                 [](CArchive& inner) { fill_gps(inner, 13, true); });
  }));
  ASSERT_TRUE(log.is_whole()) << log.fault();
  EXPECT_TRUE(
      log.first<mrpt::obs::CSensoryFrame>()->getObservationByClass<mrpt::obs::CObservationGPS>());
}

TEST(LaterRecords, RangeScansWithTheDurationOfTheSweep) {
  for (const int version : {7, 8}) {
    const Rawlog log(object("mrpt::obs::CObservation2DRangeScan",
                            static_cast<std::uint8_t>(version), [&](CArchive& archive) {
                              archive << 3.0F << true << 30.0F << mrpt::poses::CPose3D(0, 0, 1);
                              archive << std::uint32_t{2};
                              write_numbers<float>(archive, {5, 6});
                              write_numbers<std::uint8_t>(archive, {1, 0});
                              archive << 0.01F << stamp() << 0.005F << std::string("laser") << 0.0
                                      << true;
                              write_numbers<std::int32_t>(archive, {100, 200});
                              if (version == 8) archive << 0.025F;
                            }));
    ASSERT_TRUE(log.is_whole()) << version << log.fault();
    const auto scan = log.first<mrpt::obs::CObservation2DRangeScan>();
    ASSERT_TRUE(scan);
    EXPECT_EQ(scan->sensorLabel, "laser");
    EXPECT_EQ(scan->getScanRange(1), 6);
    EXPECT_FALSE(scan->getScanRangeValidity(1));
    EXPECT_EQ(scan->getScanIntensity(1), 200);
  }
}

TEST(LaterRecords, CommentsWithALabel) {
  for (const int version : {0, 1}) {
    const Rawlog log(object("mrpt::obs::CObservationComment", static_cast<std::uint8_t>(version),
                            [&](CArchive& archive) {
                              archive << std::string("hello") << stamp();
                              if (version == 1) archive << std::string("notes");
                            }));
    ASSERT_TRUE(log.is_whole()) << version << log.fault();
    EXPECT_EQ(log.first<mrpt::obs::CObservationComment>()->text, "hello");
  }
}

sensors::LidarScan scan_in(const Rawlog& log) {
  const auto cloud = log.first<mrpt::obs::CObservationPointCloud>();
  EXPECT_TRUE(cloud);
  return cloud ? take_scan(*cloud, "") : sensors::LidarScan();
}

TEST(LaterRecords, CloudsWhoseOptionsAreLater) {
  for (const std::int8_t options : {std::int8_t{0}, std::int8_t{1}}) {
    const Rawlog simple(cloud_record("mrpt::maps::CSimplePointsMap", 10, [&](CArchive& archive) {
      write_points(archive);
      archive << mrpt::maps::TMapGenericParams();
      write_options(archive, options);
      mrpt::maps::CSimplePointsMap().renderOptions.writeToStream(archive);
    }));
    ASSERT_TRUE(simple.is_whole()) << int{options} << simple.fault();
    EXPECT_THAT(scan_in(simple).y, ElementsAre(4, 5, 6));
    const Rawlog xyzi(cloud_record("mrpt::maps::CPointsMapXYZI", 0, [&](CArchive& archive) {
      write_points(archive);
      write_numbers<float>(archive, {0.1F, 0.2F, 0.3F});
      write_options(archive, options);
    }));
    ASSERT_TRUE(xyzi.is_whole()) << int{options} << xyzi.fault();
    EXPECT_THAT(scan_in(xyzi).intensity, ElementsAre(0.1F, 0.2F, 0.3F));
    EXPECT_THAT(scan_in(xyzi).ring, IsEmpty());
  }
}

TEST(LaterRecords, CloudsWithRingsAndTimes) {
  for (const std::int8_t options : {std::int8_t{0}, std::int8_t{1}}) {
    const Rawlog log(cloud_record("mrpt::maps::CPointsMapXYZIRT", 0, [&](CArchive& archive) {
      write_points(archive);
      write_counted<float>(archive, {0.1F, 0.2F, 0.3F});
      write_counted<std::uint16_t>(archive, {5, 6, 300});
      write_counted<float>(archive, {0, 0.05F, 0.1F});
      write_options(archive, options);
    }));
    ASSERT_TRUE(log.is_whole()) << log.fault();
    const auto scan = scan_in(log);
    EXPECT_THAT(scan.z, ElementsAre(7, 8, 9));
    EXPECT_THAT(scan.intensity, ElementsAre(0.1F, 0.2F, 0.3F));
    EXPECT_THAT(scan.ring, ElementsAre(5, 6, 300));
    EXPECT_THAT(scan.time, ElementsAre(0, 0.05F, 0.1F));
    EXPECT_EQ(profile_of(*log.first<mrpt::obs::CObservationPointCloud>(), scan).time_source,
              sensors::TimeSource::kData);
  }
}

TEST(LaterRecords, CloudsWithSomeOfTheirFields) {
  const Rawlog log(cloud_record("mrpt::maps::CPointsMapXYZIRT", 0, [](CArchive& archive) {
    write_points(archive);
    write_counted<float>(archive, {});
    write_counted<std::uint16_t>(archive, {5, 6, 7});
    write_counted<float>(archive, {});
    write_options(archive, 0);
  }));
  ASSERT_TRUE(log.is_whole()) << log.fault();
  EXPECT_THAT(scan_in(log).intensity, IsEmpty());
  EXPECT_THAT(scan_in(log).ring, ElementsAre(5, 6, 7));
  EXPECT_THAT(scan_in(log).time, IsEmpty());
}

/// The fields of a generic cloud in that version: before 3 behind the names of container and type.
template <typename Number>
void write_fields(CArchive& archive, int version, const char* type, const std::string& name,
                  const std::vector<Number>& numbers) {
  archive << static_cast<std::uint32_t>(name.empty() ? 0 : 1);
  if (name.empty()) return;
  archive << name;
  if (version < 3) archive << std::string("std::vector") << std::string(type);
  write_counted(archive, numbers);
}

TEST(LaterRecords, GenericCloudsOfEveryVersion) {
  for (const int version : {0, 1, 2, 3, 4}) {
    const Rawlog log(cloud_record(
        "mrpt::maps::CGenericPointsMap", static_cast<std::uint8_t>(version),
        [&](CArchive& archive) {
          write_points(archive);
          write_fields<float>(archive, version, "float", "t", {0, 0.05F, 0.1F});
          if (version >= 1) write_fields<double>(archive, version, "double", "range", {1, 2, 3});
          write_fields<std::uint16_t>(archive, version, "uint16_t", "ring", {5, 6, 7});
          if (version >= 2) {
            write_fields<std::uint8_t>(archive, version, "uint8_t", "intensity", {10, 20, 30});
          }
          if (version >= 4) write_fields<std::uint32_t>(archive, version, "uint32_t", "", {});
          write_options(archive, version < 3 ? 0 : 1);
        }));
    ASSERT_TRUE(log.is_whole()) << version << log.fault();
    const auto scan = scan_in(log);
    EXPECT_THAT(scan.x, ElementsAre(1, 2, 3));
    EXPECT_THAT(scan.ring, ElementsAre(5, 6, 7));
    EXPECT_THAT(scan.time, ElementsAre(0, 0.05F, 0.1F));
    EXPECT_EQ(scan.intensity.size(), version >= 2 ? 3U : 0U);
  }
}

TEST(LaterRecords, WhatIsLaterStillKeepsAllBefore) {
  const std::string known = object("mrpt::obs::CObservationComment", 1, [](CArchive& archive) {
    archive << std::string("hello") << stamp() << std::string("notes");
  });
  const Rawlog unknown_class(known + object("mrpt::obs::CObservationOfTomorrow", 0,
                                            [](CArchive& archive) { archive << 1.0; }));
  EXPECT_EQ(unknown_class.size(), 1U);
  EXPECT_THAT(unknown_class.fault(), HasSubstr("CObservationOfTomorrow"));
  EXPECT_THAT(unknown_class.fault(), HasSubstr("record 1, byte " + std::to_string(known.size())));
  const Rawlog unknown_version(known +
                               object("mrpt::obs::CObservationGPS", 14,
                                      [](CArchive& archive) { fill_gps(archive, 13, true); }));
  EXPECT_EQ(unknown_version.size(), 1U);
  EXPECT_THAT(unknown_version.fault(),
              HasSubstr("CObservationGPS is damaged or of a later version"));
}

TEST(LaterRecords, SimpleMapsWithVelocities) {
  for (const bool has_velocity : {false, true}) {
    const TemporaryFolder folder;
    files::write_text(folder / "map.simplemap",
                      object("mrpt::maps::CSimpleMap", 2, [&](CArchive& archive) {
                        archive << std::uint32_t{2};
                        for (int i = 0; i < 2; ++i) {
                          mrpt::poses::CPose3DPDFGaussian pose;
                          pose.mean = mrpt::poses::CPose3D(i, 0, 0);
                          archive << pose << mrpt::obs::CSensoryFrame();
                          archive << std::string("std::optional")
                                  << std::string("mrpt::math::TTwist3D") << has_velocity;
                          for (int k = 0; has_velocity && k < 6; ++k) archive << 1.0 * k;
                        }
                      }));
    std::vector<double> x;
    EXPECT_EQ(for_each_keyframe(folder / "map.simplemap",
                                [&](std::size_t, const auto& pose, const auto&) {
                                  x.push_back(pose.getMeanVal().x());
                                }),
              2U);
    EXPECT_THAT(x, ElementsAre(0, 1));
  }
}

}  // namespace
}  // namespace traverse::mrpt_io
