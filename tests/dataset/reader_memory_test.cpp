#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <functional>
#include <lzf.h>
#include <memory>
#include <string>
#include <sys/wait.h>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationRawDAQ.h>
#include <mrpt/obs/CObservationRotatingScan.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/text_file.hpp"

#include "bags/bag_writers.hpp"
#include "dataset/rawlog_maker.hpp"
#include "temporary_folder.hpp"

namespace traverse::dataset {
namespace {

namespace fs = std::filesystem;
using namespace traverse::testing;
using ::testing::HasSubstr;

/// What the reader may take, whatever a file states: this much, and this much for each byte that is
/// really unpacked.
constexpr double kMostAlways_mb = 100;
constexpr double kMostRatio = 4;

std::string repeated(const std::string& text, std::size_t times) {
  std::string all;
  all.reserve(text.size() * times);
  for (std::size_t i = 0; i < times; ++i) all += text;
  return all;
}

template <typename Number>
std::string raw(Number number) {
  return {reinterpret_cast<const char*>(&number), sizeof number};
}

struct Reading {
  int exit_status = -1;
  double peak_mb = 0;
  std::string outcome;
};

Reading read_in_a_process(const std::string& reader, const fs::path& path) {
  const std::string command =
      fmt::format("'{}' {} '{}' 2>&1", TRAVERSE_READ_ONE_FILE, reader, path.string());
  std::FILE* pipe = ::popen(command.c_str(), "r");
  std::string output;
  std::array<char, 4096> piece;
  while (const std::size_t got = std::fread(piece.data(), 1, piece.size(), pipe)) {
    output.append(piece.data(), got);
  }
  const int status = ::pclose(pipe);
  Reading reading;
  reading.exit_status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  const std::size_t end = std::min(output.find('\n'), output.size());
  reading.peak_mb = std::atof(output.substr(0, end).c_str()) / 1000;
  reading.outcome = output.substr(std::min(end + 1, output.size()));
  return reading;
}

class ReaderMemory : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    fmt::print("{:<52}{:>12}{:>12}{:>9}{:>9}\n", "file", "on disk", "unpacked", "peak MB",
               "bound MB");
  }

  fs::path write(const std::string& name, const std::string& bytes) const {
    files::write_text(folder_ / name, bytes);
    return folder_ / name;
  }

  /// Reads `path` and checks the memory and the outcome. \param what of the file, for the table
  /// \param unpacked bytes; 0: as many as on disk
  void check(const std::string& what, const std::string& reader, const fs::path& path,
             const std::string& outcome, std::uintmax_t unpacked = 0) const {
    std::uintmax_t on_disk = 0;
    if (fs::is_directory(path)) {
      for (const auto& entry : fs::recursive_directory_iterator(path)) {
        if (entry.is_regular_file()) on_disk += entry.file_size();
      }
    } else {
      on_disk = fs::file_size(path);
    }
    unpacked = std::max(unpacked, on_disk);
    const Reading reading = read_in_a_process(reader, path);
    const double bound_mb = kMostAlways_mb + kMostRatio * static_cast<double>(unpacked) * 1e-6;
    fmt::print("{:<52}{:>12}{:>12}{:>9.1f}{:>9.1f}\n", what, on_disk, unpacked, reading.peak_mb,
               bound_mb);
    EXPECT_TRUE(reading.exit_status == 0 || reading.exit_status == 1)
        << what << ": " << reading.exit_status << ", " << reading.outcome;
    EXPECT_THAT(reading.outcome, HasSubstr(outcome)) << what;
#ifndef TRAVERSE_SANITIZED  // shadows and quarantines are not the reader's
    EXPECT_GT(reading.peak_mb, 1) << what;
    EXPECT_LT(reading.peak_mb, bound_mb) << what;
#endif
  }

  TemporaryFolder folder_;
};

std::string pcd(const std::string& fields, std::size_t count, std::size_t bytes,
                const std::string& size, const std::string& data) {
  const auto each = [&](const std::string& value) { return repeated(" " + value, count); };
  return "VERSION 0.7\nFIELDS" + fields + "\nSIZE" + each(std::to_string(bytes)) + "\nTYPE" +
         each("F") + "\nCOUNT" + each("1") + "\n" + size + "DATA " + data;
}

std::string many_fields(std::size_t count) {
  std::string fields = " x y z";
  for (std::size_t i = 3; i < count; ++i) fields += fmt::format(" f{}", i);
  return fields;
}

std::string compressed(const std::string& packed, std::uint32_t full) {
  return "binary_compressed\n" + raw(static_cast<std::uint32_t>(packed.size())) + raw(full) +
         packed;
}

TEST_F(ReaderMemory, Nothing) { check("nothing at all", "nothing", folder_.path(), "nothing"); }

TEST_F(ReaderMemory, PointCloudsThatStateMore) {
  const std::string xyz = " x y z";
  const auto cloud = [&](const char* what, const std::string& bytes, const std::string& outcome,
                         std::uintmax_t unpacked = 0) {
    check(what, "cloud", write("a.pcd", bytes), outcome, unpacked);
  };
  cloud("PCD, compressed, states 4 GB",
        pcd(xyz, 3, 4, "POINTS 357913941\n", compressed(std::string(100, '\0'), 4294967292U)),
        "at most 1073741824 bytes after decompression, found a header that states 4294967292");
  cloud("PCD, compressed, states 1 GB of 100 bytes",
        pcd(xyz, 3, 4, "POINTS 80000000\n", compressed(std::string(100, '\0'), 960000000)),
        "100 bytes, too few");
  cloud("PCD, compressed, states 0.96 GB of 11 MB",
        pcd(xyz, 3, 4, "POINTS 80000000\n", compressed(std::string(11'000'000, '\0'), 960000000)),
        "damaged compressed data");
  const std::string zeros(72'000'000, '\0');
  std::string packed(zeros.size(), '\0');
  packed.resize(lzf_compress(zeros.data(), static_cast<unsigned>(zeros.size()), packed.data(),
                             static_cast<unsigned>(packed.size())));
  cloud("PCD, compressed 80 to 1, whole",
        pcd(xyz, 3, 4, "POINTS 6000000\n", compressed(packed, 72'000'000)), "6000000 points",
        zeros.size());
  cloud("PCD, ascii, 2003 fields, a million points stated",
        pcd(many_fields(2003), 2003, 8, "POINTS 1000000\n", "ascii\n") + repeated("1\n", 1'000'000),
        "expected 1000000 points of 4006 bytes");
  cloud("PCD, ascii, 2003 fields, 500 points, whole",
        pcd(many_fields(2003), 2003, 8, "POINTS 500\n", "ascii\n") +
            repeated(repeated("1 ", 2003) + "\n", 500),
        "500 points");
  cloud("PCD, binary, states 10^9 points", pcd(xyz, 3, 4, "POINTS 1000000000\n", "binary\n"),
        "expected 1000000000 points of 12 bytes");
  cloud("PCD, WIDTH x HEIGHT beyond 64 bits",
        pcd(xyz, 3, 4, "WIDTH 1099511627776\nHEIGHT 1099511627776\n", "binary\n"),
        "WIDTH x HEIGHT up to 1099511627776");
  cloud("PCD, a million fields",
        pcd(many_fields(1'000'000), 1'000'000, 4, "POINTS 1\n", "binary\n"), "at most 4096 fields");
  cloud("PCD, ascii, a line of 8 MB",
        pcd(xyz, 3, 4, "POINTS 1\n", "ascii\n") + repeated("1 ", 4'000'000) + "\n",
        "3 values a point");

  const auto ply = [&](const std::string& format, const std::string& vertex) {
    return "ply\nformat " + format + " 1.0\n" + vertex + "end_header\n";
  };
  std::string properties;
  for (std::size_t i = 0; i < 2003; ++i) properties += fmt::format("property double f{}\n", i);
  cloud("PLY, ascii, 2003 fields, a million points stated",
        ply("ascii", "element vertex 1000000\n" + properties) + repeated("1\n", 1'000'000),
        "expected 1000000 points of 4006 bytes");
  cloud("PLY, binary, states 9 10^18 points",
        ply("binary_little_endian",
            "element vertex 9000000000000000000\nproperty float x\nproperty float y\n"),
        "expected 9000000000000000000 points of 8 bytes");
  cloud("PLY, binary, a list of 4 10^9 before the points",
        ply("binary_little_endian",
            "element face 1\nproperty list uint double i\nelement vertex 1\nproperty float x\n") +
            raw(std::uint32_t{4000000000U}),
        "32000000000 bytes of binary data");
  cloud(
      "PLY, a million properties",
      ply("binary_little_endian", "element vertex 1\n" + repeated("property float x\n", 1'000'000)),
      "at most 4096 elements and properties");
}

TEST_F(ReaderMemory, TextRecordings) {
  const std::string imu = "IMU 1 0 0 0 0 0 9.8\n";
  check("log, 5 million lines that are none", "recording",
        write("a.txt", imu + repeated("a\n", 5'000'000)), "1 measurements; 5000000 x a line");
  check("log, one line of 20 MB", "recording",
        write("b.txt", imu + repeated("1 ", 10'000'000) + "\n"), "lines of at most 1048576 bytes");
  std::string log;
  for (int i = 0; i < 200'000; ++i) {
    log += fmt::format("IMU {:.6f} 0.001234 -0.004321 0.012345 0.123456 -0.234567 9.812345\n",
                       1.7e9 + 0.01 * i);
  }
  check("log, 200 000 IMU lines", "recording", write("c.txt", log), "200000 measurements");
  check("log, stamps of 1e300 and counts of 1e15", "recording",
        write("d.txt", imu + "IMU 1e300 0 0 0 0 0 9.8\n" + repeated("ODOM 1 1e15 -1e15\n", 20'000)),
        "1 x IMU line with no such time");

  const fs::path csv = folder_ / "csv";
  fs::create_directory(csv);
  files::write_text(csv / "traverse.yaml",
                    "csv: {gnss: {file: gnss.csv, time: t, columns: lat lon alt}}\n");
  files::write_text(csv / "gnss.csv", "t,lat,lon,alt\n" + repeated("1e300,1,1,1\n", 300'000));
  check("CSV, 300 000 stamps of 1e300", "recording", csv,
        "since csv.time_unit_s is 1, found '1e300'");
  files::write_text(csv / "gnss.csv", "t,lat,lon,alt" + repeated(",a", 1'000'000) + "\n");
  check("CSV, a million columns", "recording", csv, "lines of at most 1048576 bytes");
  files::write_text(csv / "gnss.csv", "t,lat,lon,alt\n" + repeated("x\n", 3'000'000));
  check("CSV, 3 million rows of one cell", "recording", csv, "3000000 x CSV line with another");
}

TEST_F(ReaderMemory, KittiFolders) {
  const fs::path kitti = folder_ / "kitti";
  make_kitti_folder(kitti, 3);
  files::write_text(kitti / "times.txt", "0\n" + std::string(8'000'000, '\n') + "1\n");
  check("KITTI, times.txt of 8 million lines", "recording", kitti, "at most 1048576 stamps");
  files::write_text(kitti / "times.txt", "0\n0.1\n1e300\n" + std::string(8'000'000, '\n'));
  check("KITTI, times.txt that ends in 8 million blank lines", "recording", kitti,
        "2 measurements");
  files::write_text(kitti / "times.txt", "0\n0.1\n" + std::string(8'000'000, '7'));
  check("KITTI, times.txt with a number of 8 MB", "recording", kitti, "2 measurements");
  files::write_text(kitti / "times.txt", "0\n0.1\n0.2\n");
  files::write_text(kitti / "calib.txt", "Tr: " + repeated("1 ", 4'000'000) + "\n");
  check("KITTI, calib.txt with a line of 8 MB", "recording", kitti, "3 measurements");
  files::write_text(kitti / "velodyne" / "000002.bin", "");
  fs::resize_file(kitti / "velodyne" / "000002.bin", std::uintmax_t{1} << 36);
  const Reading sparse = read_in_a_process("recording", kitti);
  EXPECT_THAT(sparse.outcome, HasSubstr("a file of at most 1073741824 bytes"));
#ifndef TRAVERSE_SANITIZED
  EXPECT_LT(sparse.peak_mb, kMostAlways_mb + 40);
#endif
}

TEST_F(ReaderMemory, Trajectories) {
  check("TUM, 200 000 short lines", "trajectory",
        write("a.tum", repeated("0 0 0 0 0 0 0 1\n", 200'000)), "200000 poses");
  check("TUM, one line of 20 MB", "trajectory", write("b.tum", repeated("1 ", 10'000'000)),
        "lines of at most 1048576 bytes");
  check("TUM, a stamp of 1e300", "trajectory", write("c.tum", "1e300 0 0 0 0 0 0 1\n"),
        "a time in seconds, below 9.2e9");
  check("EuRoC, the least stamp of 64 bits", "trajectory",
        write("d.csv", "-9223372036854775807,0,0,0,1,0,0,0\n-9223372036854775808,0,0,0,1,0,0,0\n"),
        "found -9223372036.854775808");
}

TEST_F(ReaderMemory, Yaml) {
  std::string maps = "a0: &a0 {k: 1}\n";
  std::string lists = "a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n";
  for (int i = 1; i <= 9; ++i) {
    const std::string alias = fmt::format("*a{}", i - 1);
    maps += fmt::format("a{0}: &a{0} {{", i);
    for (int k = 0; k < 10; ++k) maps += fmt::format("{}k{}: {}", k == 0 ? "" : ", ", k, alias);
    maps += "}\n";
    lists += fmt::format("a{0}: &a{0} [{1}{2}]\n", i, alias, repeated(", " + alias, 9));
  }
  check("YAML, mappings of aliases nine levels deep", "yaml", write("a.yaml", maps),
        "aliases written out");
  check("YAML, lists of aliases nine levels deep", "yaml", write("b.yaml", lists),
        "aliases written out");
  check("YAML, a long text repeated by aliases", "yaml",
        write("c.yaml", "a: &a '" + std::string(100'000, 'x') + "'\nb: [*a" +
                            repeated(", *a", 20'000) + "]\n"),
        "bytes of text, aliases written out");
  check("YAML, an alias of what it stands in", "yaml", write("d.yaml", "a: &a [1, *a]\n"),
        "an alias of a value that is complete");
  std::string keys;
  for (int i = 0; i < 60'000; ++i) keys += fmt::format("key_{}: {}\n", i, i);
  check("YAML, 60 000 keys", "yaml", write("e.yaml", keys), "at most 40000 keys and values");
  keys.resize(keys.find("key_19000:"));
  check("YAML, 19 000 keys", "yaml", write("e.yaml", keys), "19000 values");
  check("YAML, 19 000 keys that are no settings", "settings", write("e.yaml", keys),
        "expected a known key");
  keys.clear();
  for (int i = 0; i < 30'000; ++i) keys += fmt::format("- {}\n", i);
  check("YAML, a list of 30 000 numbers", "yaml", write("f.yaml", "a:\n" + keys), "1 values");
  check("YAML, 60 000 keys in brackets", "yaml",
        write("g.yaml", "{" + repeated("a,", 60'000) + "}"), "at most 40000 keys and values");
  check("YAML, 200 000 keys in brackets", "yaml",
        write("h.yaml", "{" + repeated("a,", 200'000) + "}"), "at most 131072 bytes between");
  check("YAML, a list of 3 million numbers", "yaml",
        write("i.yaml", "a: [" + repeated("1,", 3'000'000) + "]\n"), "of at most 1048576 bytes");
  check("YAML, lists 10^5 deep", "yaml", write("j.yaml", "a: " + std::string(100'000, '[')),
        "less deeply nested");
  check("YAML, mappings 10^5 deep", "yaml", write("k.yaml", repeated("{a: ", 100'000)),
        "at most 131072 bytes between");
  check("YAML, mappings 10^4 deep", "yaml", write("l.yaml", repeated("{a: ", 10'000)),
        "less deeply nested");
  check("YAML, lists of lists 10^5 deep", "yaml", write("m.yaml", "a:\n" + repeated("- ", 100'000)),
        "less deeply nested");
  check("YAML, a text of 20 MB", "yaml", write("n.yaml", "a: " + std::string(20'000'000, 'x')),
        "of at most 1048576 bytes");
  check("YAML, a comment of a megabyte", "yaml",
        write("o.yaml", "a: 1\n#" + std::string(1'000'000, 'x') + "\n"), "1 values");
  check("YAML, a tag of a megabyte", "yaml",
        write("p.yaml", "a: !<" + std::string(1'000'000, 'x') + "> 1\n"), "");
}

/// An object as MRPT writes it.
std::string bytes_of(const mrpt::serialization::CSerializable& object) {
  mrpt::io::CMemoryStream stream;
  auto archive = mrpt::serialization::archiveFrom(stream);
  archive << object;
  return {static_cast<const char*>(stream.getRawBufferData()), stream.getTotalBytesCount()};
}

/// The same with each `from` that stands there as four bytes changed.
std::string with_count(const mrpt::serialization::CSerializable& object, std::uint32_t from,
                       std::uint32_t to) {
  std::string bytes = bytes_of(object);
  std::size_t changed = 0;
  for (std::size_t at = bytes.find(raw(from)); at != std::string::npos;
       at = bytes.find(raw(from), at + 4)) {
    bytes.replace(at, 4, raw(to));
    ++changed;
  }
  EXPECT_GT(changed, 0U);
  return bytes;
}

mrpt::obs::CObservationPointCloud::Ptr cloud_of(std::size_t points) {
  auto map = mrpt::maps::CPointsMapXYZI::Create();
  for (std::size_t i = 0; i < points; ++i) map->insertPoint(1, 2, 3);
  auto cloud = mrpt::obs::CObservationPointCloud::Create();
  cloud->sensorLabel = "lidar";
  cloud->timestamp = mrpt_time(1);
  cloud->pointcloud = map;
  return cloud;
}

TEST_F(ReaderMemory, Rawlogs) {
  constexpr std::uint32_t kThere = 1717;
  constexpr std::uint32_t kStated = 200'000'000;
  const auto one = [&](const char* what, const mrpt::serialization::CSerializable& object,
                       const char* outcome = "is damaged") {
    const std::string bytes = bytes_of(made_imu(0)) + with_count(object, kThere, kStated);
    check(what, "recording", write("a.rawlog", bytes), outcome);
  };
  one("rawlog, Velodyne points", made_velodyne(1, kThere));
  one("rawlog, point cloud", *cloud_of(kThere));
  auto packets = made_velodyne(1, 0);
  packets.scan_packets.resize(kThere);
  one("rawlog, Velodyne packets", packets);
  mrpt::obs::CObservation2DRangeScan laser;
  laser.timestamp = mrpt_time(1);
  laser.resizeScan(kThere);
  one("rawlog, 2-D scan", laser);
  mrpt::obs::CObservationRawDAQ daq;
  daq.timestamp = mrpt_time(1);
  daq.AIN_float.resize(kThere);
#ifdef TRAVERSE_SANITIZED  // operator new is the sanitizer's, which gives what is stated
  one("rawlog, raw data", daq, "is cut short");
#else
  one("rawlog, raw data", daq);
#endif
  auto frame = mrpt::obs::CSensoryFrame();
  frame.insert(cloud_of(kThere));
  one("rawlog, point cloud in a frame", frame);

  mrpt::obs::CObservationRotatingScan rotating;
  rotating.timestamp = mrpt_time(1);
  rotating.sensorLabel = "r";
  rotating.rowCount = 17;
  rotating.columnCount = 17;
  rotating.rangeImage.resize(17, 17);
  std::string bytes = with_count(rotating, 17U | 17U << 16U, 0xffffffffU);
  check("rawlog, range image of 65535 x 65535", "recording",
        write("b.rawlog", bytes_of(made_imu(0)) + bytes), "");

  // A scan of 20 million points that are there, all the same: 0.1 MB on disk.
  const auto large = cloud_of(5'000'000);
  {
    RawlogMaker maker(folder_ / "c.rawlog", 9);
    maker.add(*large);
  }
  check("rawlog, compressed 200 to 1, whole", "recording", folder_ / "c.rawlog", "1 measurements",
        5'000'000 * 16);
  const std::string cut = files::read_text(folder_ / "c.rawlog");
  check("rawlog, compressed 200 to 1, cut", "recording",
        write("d.rawlog", cut.substr(0, cut.size() / 8)), "", 5'000'000 * 2);

  mrpt::maps::CSimpleMap map;
  mrpt::obs::CSensoryFrame of_map;
  of_map.insert(cloud_of(kThere));
  map.insert(mrpt::poses::CPose3DPDFGaussian(), of_map);
  check("simple map, point cloud", "map", write("e.simplemap", with_count(map, kThere, kStated)),
        "more than the file holds");
}

/// Bags one after the other, each a chunk of 32 MB that is unpacked at once.
TEST_F(ReaderMemory, BagsOfOneRecordingTakeTheMemoryOfOne) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  constexpr int kScansAFile = 8;
  CloudMessage cloud;
  cloud.fields = {{"x", 0}, {"y", 4}, {"z", 8}};
  cloud.width = 1000;
  cloud.point_step = 4000;  // what stands between its fields takes no room among the points
  cloud.row_step = cloud.point_step * cloud.width;
  cloud.data.assign(cloud.row_step, '\1');
  std::int64_t ns = 1'700'000'000 * kSecond;
  const auto write_bags = [&](const std::string& name, int files) {
    fs::create_directories(folder_ / name);
    for (int file = 0; file < files; ++file) {
      std::vector<MadeMessage> messages;
      for (int i = 0; i < kScansAFile; ++i, ns += kSecond / 10) {
        messages.push_back({"/points", "sensor_msgs/PointCloud2", ns,
                            cloud_message(Wire::kRos1, ns, "lidar", cloud)});
      }
      write_ros1_bag(folder_ / name / fmt::format("{}.bag", file), messages,
                     {"lz4", kScansAFile, false, true, true});
    }
    return read_in_a_process("recording", folder_ / name);
  };
  const Reading one = write_bags("one", 1);
  const Reading four = write_bags("four", 4);
  fmt::print("bags of a chunk of 32 MB: {:.1f} MB, four of them {:.1f} MB\n", one.peak_mb,
             four.peak_mb);
  EXPECT_THAT(one.outcome, HasSubstr("8 measurements"));
  EXPECT_THAT(four.outcome, HasSubstr("32 measurements"));
#ifndef TRAVERSE_SANITIZED
  EXPECT_LT(four.peak_mb, one.peak_mb + 50);
#endif
}

}  // namespace
}  // namespace traverse::dataset
