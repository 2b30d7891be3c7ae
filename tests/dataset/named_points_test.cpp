#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/poses/CPose3D.h>
#include <mrpt/serialization/CArchive.h>

#include "traverse/sensors/lidar_profile.hpp"

#include "dataset/made_recordings.hpp"
#include "dataset/rawlog_maker.hpp"
#include "mrpt_io/archive_object.hpp"
#include "temporary_folder.hpp"

/// Clouds of MRPT 2.15 and later in rawlogs, whose points have fields of any name.
namespace traverse::dataset {
namespace {

namespace fs = std::filesystem;
using mrpt::serialization::CArchive;
using ::testing::ElementsAre;
using ::testing::FloatEq;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using namespace traverse::testing;  // made recordings and rawlogs

constexpr std::uint32_t kPoints = 5;

template <typename Number>
struct MadeField {
  std::string name;
  std::function<double(double after_s, double stamp_s)> value;  ///< of a point's time
};

/// Fields of three of the types; those of the others are none.
struct MadeFields {
  std::vector<MadeField<float>> floats;
  std::vector<MadeField<double>> doubles;
  std::vector<MadeField<std::uint32_t>> integers;
  std::string ring = "ring";
};

template <typename Number>
void write_fields(CArchive& archive, const std::vector<MadeField<Number>>& fields, double stamp_s) {
  archive << static_cast<std::uint32_t>(fields.size());
  for (const auto& field : fields) {
    archive << field.name << kPoints;
    for (std::uint32_t i = 0; i < kPoints; ++i) {
      archive << static_cast<Number>(field.value(0.02 * i, stamp_s));
    }
  }
}

/// Four clouds a tenth of a second apart, whose points are measured in 0.08 s.
void write_clouds(const fs::path& file, const MadeFields& fields) {
  RawlogMaker maker(file);
  for (int k = 0; k < 4; ++k) {
    mrpt::io::CMemoryStream memory;
    auto archive = mrpt::serialization::archiveFrom(memory);
    write_object(archive, "mrpt::obs::CObservationPointCloud", 0, [&](CArchive& cloud) {
      cloud << std::string("top") << mrpt_time(0.1 * k) << mrpt::poses::CPose3D()
            << std::uint8_t{0};
      write_object(cloud, "mrpt::maps::CGenericPointsMap", 4, [&](CArchive& map) {
        map << kPoints;
        for (int axis = 0; axis < 3; ++axis) {
          for (std::uint32_t i = 0; i < kPoints; ++i) {
            map << static_cast<float>(axis == 0 ? 5 + i : 1U);
          }
        }
        const double stamp_s = 1e-9 * static_cast<double>(kMadeEpochNanoseconds) + 0.1 * k;
        write_fields(map, fields.floats, stamp_s);
        write_fields(map, fields.doubles, stamp_s);
        write_fields<std::uint16_t>(
            map, {{fields.ring, [](double after_s, double) { return after_s > 0.03 ? 1 : 0; }}},
            stamp_s);
        map << std::uint32_t{0};  // none of bytes
        write_fields(map, fields.integers, stamp_s);
        map << std::int8_t{0} << 0.02F << true << false << true << true << false << 0.01F << 2.0F
            << true;
        map << std::int8_t{0} << 0.5 << 1.0 << std::uint32_t{10};
      });
    });
    maker.add_bytes({static_cast<const char*>(memory.getRawBufferData()),
                     static_cast<std::size_t>(memory.getTotalBytesCount())});
  }
}

double nanoseconds(double after_s, double) { return 1e9 * after_s; }
double microseconds(double after_s, double) { return 1e6 * after_s; }

void expect_times(const Source& source, const std::vector<ScanPtr>& scans) {
  ASSERT_THAT(scans, SizeIs(4));
  for (const ScanPtr& scan : scans) {
    ASSERT_THAT(scan->time, SizeIs(kPoints));
    for (std::uint32_t i = 0; i < kPoints; ++i) {
      EXPECT_NEAR(scan->time[i], 0.02 * i, 1e-6);
    }
    EXPECT_THAT(scan->ring, ElementsAre(0, 0, 1, 1, 1));
    EXPECT_THAT(scan->x, ElementsAre(5, 6, 7, 8, 9));
  }
  EXPECT_EQ(source.info().rig.find("top")->lidar->time_source, sensors::TimeSource::kData);
  EXPECT_EQ(source.info().rig.find("top")->lidar->rings, 2);
}

TEST(NamedPoints, FieldsAndUnitsAreFoundAsInFilesAndBags) {
  const TemporaryFolder folder;
  const double scale = 255;
  for (MadeFields fields :
       {MadeFields{{{"t", [](double after_s, double) { return after_s; }}}, {}, {}},
        MadeFields{{}, {}, {{"offset_time", nanoseconds}}, "laser_id"},
        MadeFields{{}, {}, {{"time", microseconds}}, "channel"},
        MadeFields{{},
                   {{"timestamp", [](double after_s, double at_s) { return at_s + after_s; }}},
                   {},
                   "line"}}) {
    fields.floats.push_back({"reflectivity", [&](double, double) { return scale; }});
    write_clouds(folder / "a.rawlog", fields);
    const auto source = open(folder / "a.rawlog");
    const auto scans = read_scans(*source);
    EXPECT_THAT(skipped_in(*source), IsEmpty());
    expect_times(*source, scans);
    EXPECT_THAT(scans[0]->intensity, ElementsAre(255, 255, 255, 255, 255));
    source->rewind();
    expect_times(*source, read_scans(*source));
  }
}

TEST(NamedPoints, FieldAndUnitCanBeStated) {
  const TemporaryFolder folder;
  write_clouds(folder / "a.rawlog", {{}, {}, {{"dt", microseconds}}, "row"});
  const auto plain = open(folder / "a.rawlog");
  EXPECT_EQ(plain->info().rig.find("top")->lidar->time_source, sensors::TimeSource::kNone);
  EXPECT_THAT(read_scans(*plain).at(0)->time, IsEmpty());
  EXPECT_THAT(fact_value(*plain, "point fields not used"), HasSubstr("dt"));

  const auto stated = open(folder / "a.rawlog",
                           {"lidar.time_field=dt", "lidar.time_unit=us", "lidar.ring_field=row"});
  expect_times(*stated, read_scans(*stated));

  EXPECT_THAT(opening_error(folder / "a.rawlog", {"lidar.time_field=dtt"}),
              HasSubstr("lidar.time_field"));
  EXPECT_THAT(opening_error(folder / "a.rawlog", {"lidar.ring_field=rows"}),
              HasSubstr("lidar.ring_field"));
  EXPECT_THAT(opening_error(folder / "a.rawlog", {"lidar.time_field=dt", "lidar.time_unit=ms"}),
              HasSubstr("lidar.time_unit"));
}

TEST(NamedPoints, TimesThatAreNoneMakeNoDeskew) {
  const TemporaryFolder folder;
  write_clouds(folder / "a.rawlog", {{{"t", [](double, double) { return 0; }}}, {}, {}});
  const auto source = open(folder / "a.rawlog");
  EXPECT_EQ(source->info().rig.find("top")->lidar->time_source, sensors::TimeSource::kNone);
  EXPECT_THAT(read_scans(*source), SizeIs(4));
}

TEST(NamedPoints, WhatIsStatedOfPointsWithoutFieldsIsTold) {
  const TemporaryFolder folder;
  {
    RawlogMaker maker(folder / "a.rawlog");
    maker.add(made_velodyne(0.5));
  }
  const auto source = open(folder / "a.rawlog", {"lidar.time_field=dt", "lidar.time_unit=us"});
  EXPECT_EQ(fact_value(*source, "lidar.time_field"), "not used");
  EXPECT_EQ(fact_value(*source, "lidar.time_unit"), "not used");
  EXPECT_EQ(fact_value(*source, "lidar.ring_field"), "");
  make_kitti_folder(folder / "kitti", 2);
  EXPECT_EQ(fact_value(*open(folder / "kitti", {"point_time_unit_s=1e-6"}), "point_time_unit_s"),
            "not used");
}

}  // namespace
}  // namespace traverse::dataset
