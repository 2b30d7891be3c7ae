#include <cmath>
#include <fstream>
#include <random>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/obs/CObservationBeaconRanges.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationGPS.h>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/files/text_file.hpp"

#include "dataset/made_recordings.hpp"
#include "dataset/rawlog_maker.hpp"
#include "temporary_folder.hpp"

namespace traverse::dataset {
namespace {

namespace fs = std::filesystem;
using namespace mrpt::obs;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;
using namespace traverse::testing;  // made recordings and rawlogs

TEST(Rawlog, LateRecordsAreBroughtIntoOrder) {
  EXPECT_THAT(made_stamps_of(measurements_of(made_imu(0.00), made_imu(0.05), made_velodyne(0.01),
                                             made_imu(0.03), made_imu(0.11))),
              ElementsAre(0, 10, 30, 50, 110));
}

TEST(Rawlog, EqualStampsOfOneSensorAreSkippedOfTwoAreNot) {
  const TemporaryFolder folder;
  {
    RawlogMaker maker(folder / "a.rawlog");
    for (const auto& imu :
         {made_imu(0), made_imu(0), made_imu(0, "second"), made_imu(2), made_imu(1)}) {
      maker.add(imu);
    }
  }
  const auto source = open(folder / "a.rawlog");
  // The one of 1 s comes when those before it are out already.
  EXPECT_THAT(made_stamps_of(read_all(*source)), ElementsAre(0, 0, 1000, 2000));
  EXPECT_THAT(skipped_in(*source), ElementsAre("1 x stamp not later than the one before"));
  EXPECT_THAT(source->skipped().by_reason().begin()->second.first_places,
              ElementsAre(HasSubstr("record 1, byte ")));
}

TEST(Rawlog, AStampFarOffDisturbsOnlyItself) {
  const TemporaryFolder folder;
  {
    RawlogMaker maker(folder / "a.rawlog");
    for (const double seconds : {0.0, 0.1, 1e6, 0.2, 0.3, 0.4, 0.9, 1.4}) {
      maker.add(made_imu(seconds));
    }
  }
  const auto source = open(folder / "a.rawlog");
  EXPECT_THAT(made_stamps_of(read_all(*source)), ElementsAre(0, 100, 200, 300, 400, 900, 1400));
  EXPECT_THAT(skipped_in(*source), ElementsAre("1 x stamp far from all others"));
}

TEST(Rawlog, WhatCannotBeUsedIsCountedByReason) {
  const TemporaryFolder folder;
  {
    RawlogMaker maker(folder / "a.rawlog");
    CObservationComment comment;
    comment.text = "hello";
    comment.timestamp = mrpt_time(0);
    maker.add(comment);
    CObservationIMU no_rates;
    no_rates.timestamp = mrpt_time(0);
    no_rates.set(IMU_X_ACC, 1);
    maker.add(no_rates);
    CObservationIMU no_stamp = made_imu(0);
    no_stamp.timestamp = INVALID_TIMESTAMP;
    maker.add(no_stamp);
    maker.add(made_velodyne(0, 0));
    CObservationGPS no_fix;
    no_fix.timestamp = mrpt_time(0);
    no_fix.setMsg(gnss::Message_NMEA_GGA());
    maker.add(no_fix);
    maker.add(made_imu(1));
  }
  const auto source = open(folder / "a.rawlog");
  EXPECT_THAT(read_all(*source), SizeIs(1));
  EXPECT_THAT(skipped_in(*source),
              ElementsAre("1 x GNSS record without a fix",
                          "1 x IMU record without three rates and three accelerations",
                          "1 x Velodyne scan without points or whole packets",
                          "1 x class not used: CObservationComment",
                          "1 x no stamp in a record of CObservationIMU"));
}

TEST(Rawlog, SensorsWithTheSameOrNoNameAreToldApart) {
  const TemporaryFolder folder;
  {
    RawlogMaker maker(folder / "a.rawlog");
    maker.add(made_imu(0, ""));
    maker.add(made_velodyne(0, 3, "box"));
    maker.add(made_imu(0, "box\x1b[31m"));
    maker.add(made_imu(0, "box"));
  }
  const auto source = open(folder / "a.rawlog");
  std::vector<std::string> labels;
  for (const auto& sensor : source->info().rig.sensors) labels.push_back(sensor.label);
  EXPECT_THAT(labels, ElementsAre("IMU", "box", "box?[31m", "box (IMU)"));
  EXPECT_EQ(read_all(*source).size(), 4U);
}

TEST(Rawlog, ASensorThatAppearsLateJoinsTheRig) {
  const TemporaryFolder folder;
  {
    RawlogMaker maker(folder / "a.rawlog");
    for (int i = 0; i < 2500; ++i) maker.add(made_imu(0.01 * i));
    maker.add(made_velodyne(26));
  }
  const auto source = open(folder / "a.rawlog");
  EXPECT_EQ(source->info().rig.find("top"), nullptr);
  read_all(*source);
  EXPECT_NE(source->info().rig.find("top"), nullptr);
  source->rewind();
  EXPECT_EQ(read_all(*source).size(), 2501U);
  EXPECT_THAT(source->info().rig.sensors, SizeIs(2));
}

TEST(Rawlog, FactsAndReferenceComeFromTheSidecar) {
  const TemporaryFolder folder;
  {
    RawlogMaker maker(folder / "a.rawlog");
    maker.add(made_velodyne(0));
  }
  files::write_text(folder / "gt.tum", "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0.1 0.995\n");
  files::write_text(folder / "calib.txt", "Tr: 1 0 0 5 0 1 0 0 0 0 1 0\n");
  files::write_text(folder / "a.traverse.yaml",
                    "motion_compensated: true\nbody_frame: car\ncalibration: calib.txt\n"
                    "lidar: {vertical_correction_deg: 0.5}\n"
                    "reference: {file: gt.tum, frame: lidar}\n");
  const auto source = open(folder / "a.rawlog");
  EXPECT_TRUE(source->info().motion_compensated);
  EXPECT_EQ(source->info().rig.body_frame, "car");
  EXPECT_EQ(source->info().rig.find("top")->lidar->vertical_correction_deg, 0.5);
  // The lidar is at (1, 0, 2) of the body, the camera 5 m behind it.
  EXPECT_TRUE(source->info().T_body_camera->translation.isApprox(Eigen::Vector3d(-4, 0, 2)));
  ASSERT_TRUE(source->reference());
  const geometry::Pose3 X = source->info().rig.find("top")->T_body_sensor;
  const double angle = 2 * std::atan2(0.1, 0.995);
  geometry::Pose3 lidar_pose =
      geometry::exp_se3((geometry::Twist() << 0, 0, angle, 0, 0, 0).finished());
  lidar_pose.translation.x() = 1;
  EXPECT_LT(
      (source->reference()->T_map_body.pose(1).matrix() - (X * lidar_pose * X.inverse()).matrix())
          .norm(),
      1e-12);
  files::write_text(folder / "poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n");
  EXPECT_THAT(opening_error(folder / "a.rawlog", {"reference.file=poses.txt"}),
              HasSubstr("expected poses with stamps (TUM or EuRoC), found poses without"));
}

TEST(Rawlog, WrongStatementsAboutItsLidarAreAnErrorNotSkippedScans) {
  const TemporaryFolder folder;
  {
    RawlogMaker maker(folder / "a.rawlog");
    maker.add(made_velodyne(0));
    maker.add(made_velodyne(0.1, 6, "second"));
  }
  EXPECT_THAT(opening_error(folder / "a.rawlog", {"sensor=none"}),
              HasSubstr("expected a sensor profile"));
  EXPECT_THAT(opening_error(folder / "a.rawlog", {"lidar.rings=-1"}),
              HasSubstr("--recording lidar.rings=-1"));
  const auto source = open(folder / "a.rawlog", {"sensor=hdl64e_kitti"});
  EXPECT_EQ(source->info().rig.find("second")->lidar->rings, 64);
  EXPECT_EQ(fact_value(*source, "second: lidar"), "HDL-64E (KITTI)");
}

TEST(Rawlog, NothingOfUseIsAnErrorThatSaysWhatThereIs) {
  const TemporaryFolder folder;
  {
    RawlogMaker maker(folder / "a.rawlog");
    CObservationBeaconRanges beacons;
    beacons.timestamp = mrpt_time(0);
    maker.add(beacons);
    maker.add(beacons);
  }
  EXPECT_THAT(opening_error(folder / "a.rawlog"),
              HasSubstr("found none of these; 2 x class not used: CObservationBeaconRanges"));
}

TEST(Rawlog, EmptyAndForeignFilesAreRefused) {
  const TemporaryFolder folder;
  files::write_text(folder / "a.rawlog", "");
  EXPECT_THAT(opening_error(folder / "a.rawlog"),
              HasSubstr("expected an MRPT rawlog, which begins with the name of a class, found an "
                        "empty file"));
  files::write_text(folder / "b.rawlog", "just some text, long enough to be a name");
  EXPECT_THAT(opening_error(folder / "b.rawlog"), HasSubstr("found 'just some text, '"));
  files::write_text(folder / "c.rawlog", std::string("\x1f\x8b\x08\x00junkjunkjunkjunk", 20));
  EXPECT_THAT(opening_error(folder / "c.rawlog"), HasSubstr("found damaged compressed data"));
  files::write_text(folder / "d.bin", std::string(1000, '\0'));
  EXPECT_THAT(opening_error(folder / "d.bin"),
              HasSubstr("(MRPT rawlog), found a file that begins with '\\x00"));
}

/// A record of a class that does not exist.
std::string unknown_record() {
  return std::string(
             "\x89"
             "CMadeUp42") +
         "\x01payload\x88";
}

TEST(Rawlog, AnUnknownClassIsNamedAndEndsTheReading) {
  const TemporaryFolder folder;
  {
    RawlogMaker maker(folder / "a.rawlog");
    maker.add(made_imu(0));
    maker.add_bytes(unknown_record());
    maker.add(made_imu(1));
  }
  const auto source = open(folder / "a.rawlog");
  EXPECT_THAT(read_all(*source), SizeIs(1));
  EXPECT_THAT(skipped_in(*source),
              ElementsAre("1 x a record of the class CMadeUp42, which MRPT does not know here: "
                          "the rest of the file is not read"));
  EXPECT_THAT(source->skipped().by_reason().begin()->second.first_places,
              ElementsAre(HasSubstr("record 1, byte ")));
}

/// Replaces a compressed file by its plain bytes.
void gunzip(const fs::path& file) {
  const std::string name = "'" + file.string();
  const std::string command =
      "gzip -dc " + name + "' > " + name + ".plain' && mv " + name + ".plain' " + name + "'";
  if (std::system(command.c_str()) != 0) throw std::runtime_error("gzip failed");
}

TEST(Rawlog, PlainAndCompressedFilesAreTheSame) {
  const TemporaryFolder folder;
  for (const int level : {0, 1, 9}) {
    {
      RawlogMaker maker(folder / "any.name", level);
      maker.add(made_velodyne(0));
    }
    EXPECT_THAT(read_scans(*open(folder / "any.name")), SizeIs(1)) << level;
  }
  gunzip(folder / "any.name");
  EXPECT_EQ(files::read_text(folder / "any.name").substr(1, 35),
            "mrpt::obs::CObservationVelodyneScan");
  EXPECT_THAT(read_scans(*open(folder / "any.name")), SizeIs(1));
}

enum class Form { kPlain, kCompressed };
class CutRawlog : public ::testing::TestWithParam<Form> {};

TEST_P(CutRawlog, GivesWhatIsWholeAndNamesTheCutWhereverItIs) {
  const TemporaryFolder folder;
  const fs::path whole = folder / "whole.rawlog";
  {
    RawlogMaker maker(whole, 1);
    for (int i = 0; i < 20; ++i) maker.add(made_velodyne(0.1 * i, 200));
  }
  if (GetParam() == Form::kPlain) gunzip(whole);
  const std::uintmax_t size = fs::file_size(whole);
  for (std::uintmax_t cut = size - 1; cut > size / 4; cut -= size / 37) {
    const fs::path file = folder / "cut.rawlog";
    fs::copy_file(whole, file, fs::copy_options::overwrite_existing);
    fs::resize_file(file, cut);
    ::testing::internal::CaptureStderr();
    ::testing::internal::CaptureStdout();
    std::unique_ptr<Source> source;
    std::size_t scans = 0;
    std::string error;
    try {
      source = open(file);
      scans = read_scans(*source).size();
    } catch (const files::InputError& first_record_is_cut) {
      error = first_record_is_cut.what();
    }
    const std::string printed =
        ::testing::internal::GetCapturedStderr() + ::testing::internal::GetCapturedStdout();
    EXPECT_EQ(printed, "");
    if (GetParam() == Form::kPlain) {
      EXPECT_EQ(scans, 20 * cut / size) << cut;
    }
    EXPECT_LE(scans, 20U) << cut;  // with the end mark of the compression lost, all data are there
    ASSERT_TRUE(source) << error;
    ASSERT_EQ(source->skipped().by_reason().size(), 1U) << cut;
    const auto& [reason, count] = *source->skipped().by_reason().begin();
    EXPECT_EQ(reason, "the file is cut short: the rest of the file is not read") << cut;
    EXPECT_THAT(count.first_places,
                ElementsAre(HasSubstr("record " + std::to_string(scans) + ", byte ")))
        << cut;
  }
}

INSTANTIATE_TEST_SUITE_P(Forms, CutRawlog, ::testing::Values(Form::kPlain, Form::kCompressed));

TEST(Rawlog, DamagedCompressedDataIsNamed) {
  const TemporaryFolder folder;
  {
    RawlogMaker maker(folder / "a.rawlog", 6);
    for (int i = 0; i < 200; ++i) maker.add(made_velodyne(0.1 * i, 1000));
  }
  // Garbage that decompresses to more garbage: a count in it must not take gigabytes.
  const std::uintmax_t size = fs::file_size(folder / "a.rawlog");
  fs::resize_file(folder / "a.rawlog", size / 2);
  fs::resize_file(folder / "a.rawlog", size);  // zeros from the middle on
  auto source = open(folder / "a.rawlog");
  std::size_t scans = read_scans(*source).size();
  EXPECT_GT(scans, 20U);
  EXPECT_LT(scans, 110U);
  EXPECT_EQ(source->skipped().total(), 1U) << skipped_in(*source).at(0);

  // Garbage that does not.
  std::fstream file(folder / "a.rawlog", std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(static_cast<std::streamoff>(size / 2));
  std::mt19937 random(1);
  for (std::uintmax_t i = size / 2; i < size; ++i) file.put(static_cast<char>(random()));
  file.close();
  source = open(folder / "a.rawlog");
  scans = read_scans(*source).size();
  EXPECT_GT(scans, 20U);
  EXPECT_LT(scans, 100U);
  EXPECT_THAT(skipped_in(*source), ElementsAre(HasSubstr("1 x damaged compressed data: ")));
}

}  // namespace
}  // namespace traverse::dataset
