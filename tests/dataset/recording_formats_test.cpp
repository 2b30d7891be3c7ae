#include "traverse/dataset/recording_formats.hpp"

#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/dataset/point_cloud_file.hpp"
#include "traverse/files/atomic_file.hpp"
#include "traverse/files/text_file.hpp"

#include "bags/bag_writers.hpp"
#include "made_recordings.hpp"
#include "packets/made_capture.hpp"
#include "packets/made_velodyne_packet.hpp"
#include "rawlog_maker.hpp"
#include "temporary_folder.hpp"

namespace traverse::dataset {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::ElementsAreArray;
using ::testing::HasSubstr;
using ::testing::Not;
using namespace traverse::testing;

/// The smallest recording of a format, and what must be stated to open it.
struct Made {
  fs::path path;
  std::vector<std::string> statements;
};

Made make(std::string_view format, const fs::path& folder) {
  if (format == "KITTI odometry") {
    make_kitti_folder(folder / "odometry", 2);
    return {folder / "odometry", {}};
  }
  if (format == "KITTI raw") {
    const fs::path data = folder / "raw/velodyne_points/data";
    fs::create_directories(data);
    write_bin(data / "0000000000.bin", made_scan(4, 50));
    return {folder / "raw", {}};
  }
  if (format == "point-cloud folder") {
    fs::create_directories(folder / "clouds");
    PointCloud cloud;
    for (const char* axis : {"x", "y", "z"}) cloud.add(axis, std::vector<float>{1, 2, 3});
    write_ply(folder / "clouds/0.ply", cloud);
    return {folder / "clouds", {}};
  }
  if (format == "CSV folder") {
    fs::create_directories(folder / "tables");
    files::write_text(folder / "tables/wheels.csv", "t,speed\n0,1\n1,1\n");
    return {folder / "tables", {"csv.wheels.file=wheels.csv", "csv.wheels.columns=speed"}};
  }
  if (format == "navigation log") {
    files::write_text(folder / "log.txt", "# a robot\nODOM 0 1 1\nODOM 1 1 1\n");
    return {folder / "log.txt", {}};
  }
  if (format == "packet capture") {
    MadeVelodynePacket packet(10, 0.4, 0);
    packet.fill(20);
    const auto bytes = packet.bytes();
    MadeCapture capture;
    capture.add_datagram({bytes.begin(), bytes.end()}, 1'700'000'000'000'000'000);
    capture.write(folder / "made.pcap");
    return {folder / "made.pcap", {}};
  }
  if (format == "MRPT rawlog") {
    RawlogMaker(folder / "other_name.log").add(made_imu(0));
    return {folder / "other_name.log", {}};
  }
  const std::vector<MadeMessage> messages{
      {"/imu", "sensor_msgs/Imu", 1'000'000'000,
       imu_message(format.starts_with("ROS 1") ? Wire::kRos1 : Wire::kCdr, 1'000'000'000, "imu",
                   {0, 0, 0}, {0, 0, 9.81})}};
  if (format == "ROS 1 bag") {
    write_ros1_bag(folder / "other_name.dat", messages);
    return {folder / "other_name.dat", {}};
  }
  if (format == "ROS 1 bags") {
    fs::create_directories(folder / "bags");
    write_ros1_bag(folder / "bags/0.bag", messages);
    return {folder / "bags", {}};
  }
  if (format == "ROS 2 bag") {
    write_ros2_bag(folder / "bag", messages);
    return {folder / "bag", {}};
  }
  if (format == "ROS 2 database") {
    write_ros2_bag(folder / "bag", messages);
    fs::copy_file(folder / "bag/bag_0.db3", folder / "other_name");
    return {folder / "other_name", {}};
  }
  if (format == "MCAP") {
    write_mcap(folder / "other_name", messages);
    return {folder / "other_name", {}};
  }
  throw std::invalid_argument("no recording of the format " + std::string(format) + " is made");
}

TEST(RecordingFormats, EachIsRecognisedByItsOwnRowAloneAndTellsItsName) {
  for (const RecordingFormat& format : recording_formats()) {
    const TemporaryFolder folder;
    const Made made = make(format.name, folder.path());
    EXPECT_EQ(open(made.path, made.statements)->info().format, format.name);
    for (const RecordingFormat& other : recording_formats()) {
      if (other.is_folder != format.is_folder) continue;
      EXPECT_EQ(other.recognises(made.path), &other == &format)
          << format.name << " by the row of " << other.name;
    }
  }
}

TEST(RecordingFormats, AnUnknownRecordingIsToldAllThatItCouldBe) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "notes");
  files::write_text(folder / "notes/a.txt", "");
  files::write_text(folder / "a.txt", "Dear diary");
  files::write_text(folder / "b.bin", std::string("\x1f\x8b\x08\x00junkjunkjunkjunk", 20));
  files::write_text(folder / "c.txt", "");
  for (const RecordingFormat& format : recording_formats()) {
    const std::string row =
        std::string(format.recognised_by) + " (" + std::string(format.name) + ")";
    EXPECT_THAT(opening_error(folder / (format.is_folder ? "notes" : "a.txt")), HasSubstr(row));
    EXPECT_THAT(opening_error(folder / (format.is_folder ? "a.txt" : "notes")),
                Not(HasSubstr(row)));
  }
  EXPECT_THAT(opening_error(folder / "a.txt"),
              HasSubstr("found a file that begins with 'Dear diary'; `traverse info --formats`"));
  EXPECT_THAT(opening_error(folder / "b.bin"), HasSubstr("found an archive or compressed file"));
  EXPECT_THAT(opening_error(folder / "c.txt"), HasSubstr("found an empty file"));
}

/// A cell of a Markdown table as it is read: without code marks, links by their text.
std::string plain(std::string cell) {
  std::string text;
  for (std::size_t i = 0; i < cell.size(); ++i) {
    if (cell[i] == '`' || cell[i] == '[') continue;
    if (cell[i] == ']' && i + 1 < cell.size() && cell[i + 1] == '(') {
      i = cell.find(')', i);
      continue;
    }
    text += cell[i];
  }
  const auto first = text.find_first_not_of(' ');
  return first == std::string::npos ? ""
                                    : text.substr(first, text.find_last_not_of(' ') + 1 - first);
}

/// The rows below the first table head that begins with `head`.
std::vector<std::vector<std::string>> table_of(const std::string& document,
                                               const std::string& head) {
  std::ifstream stream(std::string(TRAVERSE_SOURCE_DIR) + "/" + document);
  std::vector<std::vector<std::string>> rows;
  bool inside = false;
  for (std::string line; std::getline(stream, line);) {
    if (line.starts_with("| " + head + " |")) {
      inside = true;
      continue;
    }
    if (!inside || line.starts_with("|--")) continue;
    if (!line.starts_with("|")) break;
    std::vector<std::string> cells;
    for (std::size_t at = 1, end = 0; (end = line.find('|', at)) != std::string::npos;
         at = end + 1) {
      cells.push_back(plain(line.substr(at, end - at)));
    }
    rows.push_back(std::move(cells));
  }
  return rows;
}

TEST(RecordingFormats, ReadmeAndDocumentsHaveTheSameRows) {
  std::vector<std::vector<std::string>> expected;
  for (const RecordingFormat& format : recording_formats()) {
    expected.push_back({std::string(format.name), std::string(format.recognised_by),
                        std::string(format.description)});
  }
  EXPECT_THAT(table_of("README.md", "recording"), ElementsAreArray(expected));

  const std::string document =
      files::read_text(std::string(TRAVERSE_SOURCE_DIR) + "/docs/recordings.md");
  const auto summary = table_of("docs/recordings.md", "format");
  ASSERT_EQ(summary.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(summary[i].front(), expected[i].front());
    EXPECT_EQ(summary[i].size(), 6U) << "recognised, deskew, IMU, GNSS, reference";
    EXPECT_EQ(summary[i].at(1), expected[i].at(1));
    EXPECT_THAT(document, HasSubstr("\n## " + expected[i].front() + "\n"));
  }
}

}  // namespace
}  // namespace traverse::dataset
