#include "traverse/dataset/point_cloud_file.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <lzf.h>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/dataset/ply_blocks.hpp"
#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/files/text_file.hpp"

#include "temporary_folder.hpp"

namespace traverse::dataset {
namespace {

using files::InputError;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

template <typename Number>
const std::vector<Number>& values(const PointCloud& cloud, std::string_view name) {
  const FieldValues* field = cloud.find(name);
  if (field == nullptr) throw std::out_of_range(std::string(name));
  return std::get<std::vector<Number>>(*field);
}

PointCloud read_from_text(const std::string& text) {
  const TemporaryFolder folder;
  files::write_text(folder / "cloud", text);
  return read_point_cloud(folder / "cloud");
}

std::string message_of(const std::string& text) {
  try {
    read_from_text(text);
  } catch (const InputError& error) {
    const std::string message = error.what();
    return message.substr(message.find("cloud") + 5);
  }
  return "no error";
}

/// The bytes of numbers one after the other, most significant first if asked.
template <typename... Number>
std::string bytes(bool big_endian, Number... numbers) {
  std::string all;
  const auto append = [&](auto number) {
    std::array<char, sizeof number> raw;
    std::memcpy(raw.data(), &number, sizeof number);
    if (big_endian) std::reverse(raw.begin(), raw.end());
    all.append(raw.data(), raw.size());
  };
  (append(numbers), ...);
  return all;
}

/// Every type that a format holds, with the values that rounding or a wrong sign would change.
PointCloud example_cloud(bool with_64_bit_integers) {
  const float not_a_number = std::numeric_limits<float>::quiet_NaN();
  PointCloud cloud;
  cloud.add("x", std::vector<float>{0.1F, -1e-20F, 3.4e38F});
  cloud.add("y", std::vector<float>{not_a_number, 0, -0.0F});
  cloud.add("z", std::vector<double>{1.0 / 3, -2, 5e-324});
  cloud.add("ring", std::vector<std::uint16_t>{0, 65535, 7});
  cloud.add("a", std::vector<std::int8_t>{-128, 127, 0});
  cloud.add("class", std::vector<std::uint8_t>{255, 1, 2});
  cloud.add("b", std::vector<std::int16_t>{-32768, 1, 2});
  cloud.add("c", std::vector<std::int32_t>{-2147483647, 1, 2});
  cloud.add("d", std::vector<std::uint32_t>{4294967295U, 1, 2});
  if (with_64_bit_integers) {
    cloud.add("e", std::vector<std::int64_t>{-9007199254740993, 1, 2});
    cloud.add("f", std::vector<std::uint64_t>{18446744073709551615U, 1, 2});
  }
  return cloud;
}

/// Equal bit by bit, so that NaN equals NaN and -0 differs from 0.
void expect_same(const PointCloud& a, const PointCloud& b) {
  ASSERT_EQ(a.fields().size(), b.fields().size());
  for (std::size_t i = 0; i < a.fields().size(); ++i) {
    EXPECT_EQ(a.fields()[i].name, b.fields()[i].name);
    const FieldValues& expected = a.fields()[i].values;
    const FieldValues& actual = b.fields()[i].values;
    ASSERT_EQ(expected.index(), actual.index()) << a.fields()[i].name;
    std::visit(
        [&](const auto& held) {
          const auto& other = std::get<std::decay_t<decltype(held)>>(actual);
          ASSERT_EQ(held.size(), other.size());
          EXPECT_EQ(std::memcmp(held.data(), other.data(), held.size() * sizeof(held[0])), 0)
              << a.fields()[i].name;
        },
        expected);
  }
}

class PointCloudRoundTrip : public ::testing::TestWithParam<PointEncoding> {};

TEST_P(PointCloudRoundTrip, PcdKeepsEveryBitOfEveryType) {
  const TemporaryFolder folder;
  const PointCloud cloud = example_cloud(true);
  write_pcd(folder / "a.pcd", cloud, GetParam());
  expect_same(cloud, read_point_cloud(folder / "a.pcd"));
}

TEST_P(PointCloudRoundTrip, PlyKeepsEveryBitOfEveryType) {
  const TemporaryFolder folder;
  const PointCloud cloud = example_cloud(false);
  write_ply(folder / "a.ply", cloud, GetParam());
  expect_same(cloud, read_point_cloud(folder / "a.ply"));
}

TEST_P(PointCloudRoundTrip, ACloudWithoutPointsStaysOne) {
  const TemporaryFolder folder;
  PointCloud cloud;
  cloud.add("x", std::vector<float>{});
  write_pcd(folder / "a", cloud, GetParam());
  EXPECT_EQ(read_point_cloud(folder / "a").size(), 0U);
  write_ply(folder / "a", cloud, GetParam());
  EXPECT_EQ(read_point_cloud(folder / "a").size(), 0U);
}

INSTANTIATE_TEST_SUITE_P(Encodings, PointCloudRoundTrip,
                         ::testing::Values(PointEncoding::kAscii, PointEncoding::kBinary),
                         [](const auto& encoding) {
                           return encoding.param == PointEncoding::kAscii ? "Ascii" : "Binary";
                         });

TEST(PointCloudFile, MorePointsThanTheWriterHandlesAtOnce) {
  const TemporaryFolder folder;
  std::vector<std::uint32_t> numbers(40'000);
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<std::uint32_t>(i);
  PointCloud cloud;
  cloud.add("class", std::vector<std::uint8_t>(numbers.size(), 3));
  cloud.add("number", numbers);
  write_ply(folder / "a.ply", cloud);
  EXPECT_EQ(values<std::uint32_t>(read_point_cloud(folder / "a.ply"), "number"), numbers);
}

TEST(Pcd, ReadsAnyFieldOrderAndPassesOverPaddingAndHistograms) {
  const std::string header =
      "# comment\nVERSION .7\nFIELDS intensity _ x histogram y z\nSIZE 1 1 4 4 4 8\n"
      "TYPE U U F F F F\nCOUNT 1 3 1 2 1 1\nWIDTH 1\nHEIGHT 2\nVIEWPOINT 0 0 0 1 0 0 0\n"
      "POINTS 2\n";
  const std::string binary =
      bytes(false, std::uint8_t{200}, '_', '_', '_', 1.5F, 9.F, 9.F, 2.5F, 3.5) +
      bytes(false, std::uint8_t{201}, '_', '_', '_', 4.5F, 9.F, 9.F, 5.5F, 6.5);
  for (const std::string& text :
       {header + "DATA binary\n" + binary,
        header + "DATA ascii\n200 0 0 0 1.5 9 9 2.5 3.5\n\n201 0 0 0 4.5 9 9 5.5 6.5"}) {
    const PointCloud cloud = read_from_text(text);
    EXPECT_EQ(cloud.fields().size(), 4U);
    EXPECT_THAT(values<std::uint8_t>(cloud, "intensity"), ElementsAre(200, 201));
    EXPECT_THAT(values<float>(cloud, "x"), ElementsAre(1.5F, 4.5F));
    EXPECT_THAT(values<double>(cloud, "z"), ElementsAre(3.5, 6.5));
  }
}

std::string compressed_pcd(const std::string& field_after_field) {
  std::string packed(field_after_field.size() + 100, '\0');
  const unsigned int packed_size =
      lzf_compress(field_after_field.data(), static_cast<unsigned int>(field_after_field.size()),
                   packed.data(), static_cast<unsigned int>(packed.size()));
  packed.resize(packed_size);
  return "VERSION 0.7\nFIELDS x ring\nSIZE 4 2\nTYPE F U\nCOUNT 1 1\nWIDTH 40\nHEIGHT 1\n"
         "POINTS 40\nDATA binary_compressed\n" +
         bytes(false, packed_size, static_cast<std::uint32_t>(field_after_field.size())) + packed;
}

TEST(Pcd, ReadsCompressedDataFieldAfterField) {
  std::string data;
  for (int i = 0; i < 40; ++i) data += bytes(false, static_cast<float>(i));
  for (int i = 0; i < 40; ++i) data += bytes(false, static_cast<std::uint16_t>(1000 + i));
  const std::string file = compressed_pcd(data);
  const PointCloud cloud = read_from_text(file);
  EXPECT_EQ(values<float>(cloud, "x").at(39), 39);
  EXPECT_EQ(values<std::uint16_t>(cloud, "ring").at(0), 1000);

  EXPECT_THAT(message_of(file.substr(0, file.size() - 3)), HasSubstr("bytes of binary data"));
  std::string damaged = file;
  const std::string data_line = "binary_compressed\n";
  damaged[damaged.find(data_line) + data_line.size() + 8] = '\xff';  // refers before the start
  EXPECT_THAT(message_of(damaged), HasSubstr("damaged compressed data"));
  EXPECT_THAT(message_of(compressed_pcd(data.substr(0, 100))),
              HasSubstr("expected 40 points of 6 bytes, found 100 bytes"));
}

TEST(Pcd, NamesWhatIsWrongAndWhere) {
  const std::string header = "VERSION .7\nFIELDS x\nSIZE 4\nTYPE F\nCOUNT 1\nPOINTS 2\n";
  EXPECT_EQ(message_of(header + "DATA binary\n1234"),
            ": expected 2 points of 4 bytes, found 4 bytes");
  EXPECT_EQ(message_of(header + "DATA ascii\n1\nx\n"),
            ", line 9: expected a number of the field's type, found 'x'");
  EXPECT_EQ(message_of(header + "DATA ascii\n1 2\n3 4"),
            ", line 8: expected 1 values a point, found 2");
  EXPECT_EQ(message_of(header + "DATA ascii\n12345\n"),
            ", line 8: expected 2 points, found the end after 1");
  EXPECT_EQ(message_of(header + "DATA zip\n"),
            ", line 7: expected DATA ascii, binary or binary_compressed, found 'zip'");
  EXPECT_EQ(message_of("VERSION .7\nFIELDS x y\nSIZE 4\n"),
            ", line 3: expected SIZE values for 2 fields, found 1");
  EXPECT_EQ(message_of("VERSION .7\nFIELDS x\nSIZE 3\nTYPE F\nPOINTS 1\nDATA binary\n123"),
            ", key x: expected TYPE and SIZE of a number, found F 3");
  EXPECT_THAT(message_of("VERSION .7\nFIELDS x\nPOINTS -1\n"),
              HasSubstr("line 3: expected a whole"));
  EXPECT_THAT(message_of("VERSION .7\nFIELDS x\n"), HasSubstr("the end of the file"));
}

TEST(Pcd, AHeaderThatClaimsTooMuchTakesNoMemory) {
  EXPECT_THAT(message_of("FIELDS x\nSIZE 4\nTYPE F\nPOINTS 1099511627776\nDATA binary\n1234"),
              HasSubstr("found 4 bytes"));
  EXPECT_THAT(message_of("FIELDS x\nSIZE 4\nTYPE F\nPOINTS 1099511627776\nDATA ascii\n1234"),
              HasSubstr("found 5 bytes"));
}

TEST(Ply, ReadsBothByteOrdersAfterAnElementWithLists) {
  for (const bool big_endian : {false, true}) {
    const std::string order = big_endian ? "big" : "little";
    const std::string header = "ply\r\nformat binary_" + order +
                               "_endian 1.0\r\ncomment c\r\nobj_info o\r\n"
                               "element face 2\r\nproperty list uchar int vertex_indices\r\n"
                               "property float32 q\r\n"
                               "element camera 1\r\nproperty double d\r\n"
                               "element vertex 2\r\nproperty double x\r\nproperty uint16 ring\r\n"
                               "property int time\r\nend_header\r\n";
    const std::string data = bytes(big_endian, std::uint8_t{2}, 7, 8, 1.F) +
                             bytes(big_endian, std::uint8_t{0}, 2.F) + bytes(big_endian, 3.0) +
                             bytes(big_endian, 0.1, std::uint16_t{258}, -5) +
                             bytes(big_endian, 0.2, std::uint16_t{772}, 1 << 20);
    const PointCloud cloud = read_from_text(header + data);
    EXPECT_THAT(values<double>(cloud, "x"), ElementsAre(0.1, 0.2)) << order;
    EXPECT_THAT(values<std::uint16_t>(cloud, "ring"), ElementsAre(258, 772)) << order;
    EXPECT_THAT(values<std::int32_t>(cloud, "time"), ElementsAre(-5, 1 << 20)) << order;
  }
}

TEST(Ply, ReadsAsciiAfterAnElementWithLists) {
  const PointCloud cloud = read_from_text(
      "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int i\nelement vertex 2\n"
      "property float x\nproperty uchar ring\nend_header\n3 0 1 2\n1.5 7\nnan 8\n");
  EXPECT_EQ(values<float>(cloud, "x")[0], 1.5F);
  EXPECT_TRUE(std::isnan(values<float>(cloud, "x")[1]));
  EXPECT_THAT(values<std::uint8_t>(cloud, "ring"), ElementsAre(7, 8));
}

TEST(Ply, NamesWhatIsWrongAndWhere) {
  const std::string begin = "ply\nformat binary_little_endian 1.0\n";
  EXPECT_EQ(message_of(begin + "element vertex 3\nproperty float x\nend_header\n12345678"),
            ": expected 3 points of 4 bytes, found 8 bytes");
  EXPECT_EQ(message_of(begin + "element vertex x\n"),
            ", line 3: expected element NAME COUNT, found another");
  EXPECT_EQ(message_of(begin + "element vertex 1\nproperty real x\n"),
            ", line 4: expected a PLY type, found 'real'");
  EXPECT_EQ(message_of("ply\nformat binary 1.0\n"),
            ", line 2: expected format ascii, binary_little_endian or binary_big_endian 1.0, "
            "found another");
  EXPECT_EQ(message_of(begin + "end_header\n"), ": expected an element 'vertex', found none");
  EXPECT_EQ(message_of(begin + "property float x\n"),
            ", line 3: expected a line of the PLY header, found 'property float x'");
  EXPECT_EQ(message_of(begin), ", line 2: expected end_header, found the end of the file");
  EXPECT_EQ(message_of(begin + "element vertex 1\nproperty list uchar int x\nend_header\n"),
            ": expected points without lists, found a list");
  EXPECT_THAT(message_of(begin + "element face 4000000000\nproperty int i\nelement vertex 1\n"
                                 "property float x\nend_header\n1234"),
              HasSubstr("expected 4000000000 records of 'face'"));
  EXPECT_THAT(message_of(begin +
                         "element face 1\nproperty list int int i\nelement vertex 0\n"
                         "property float x\nend_header\n" +
                         bytes(false, -1)),
              HasSubstr("the length of a list"));
}

TEST(Ply, RefusesToWriteWhatTheFormatDoesNotHave) {
  const TemporaryFolder folder;
  EXPECT_THROW(write_ply(folder / "a.ply", example_cloud(true)), std::invalid_argument);
  EXPECT_FALSE(std::filesystem::exists(folder / "a.ply"));
}

TEST(PointCloudFile, WritesTheHeadersThatOtherProgramsExpect) {
  const TemporaryFolder folder;
  PointCloud cloud;
  cloud.add("x", std::vector<float>{1});
  cloud.add("class", std::vector<std::uint8_t>{2});
  write_pcd(folder / "a.pcd", cloud, PointEncoding::kAscii);
  EXPECT_EQ(files::read_text(folder / "a.pcd"),
            "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x class\nSIZE 4 1\n"
            "TYPE F U\nCOUNT 1 1\nWIDTH 1\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 1\n"
            "DATA ascii\n1 2\n");
  write_ply(folder / "a.ply", cloud);
  EXPECT_EQ(files::read_text(folder / "a.ply"),
            "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\n"
            "property uchar class\nend_header\n" +
                bytes(false, 1.F, std::uint8_t{2}));
}

TEST(PointCloudFile, RefusesForeignAndEmptyFiles) {
  EXPECT_EQ(message_of(""),
            ", line 1: expected the beginning of a PCD or PLY file, found an empty file");
  EXPECT_THAT(message_of("\x7f"
                         "ELF\x02"),
              HasSubstr("found '\\x7fELF\\x02'"));
  EXPECT_THROW(read_point_cloud("/nonexistent.pcd"), InputError);
}

TEST(PointCloud, KeepsItsFieldsEquallyLong) {
  PointCloud cloud;
  cloud.add("x", std::vector<float>{1, 2});
  EXPECT_THROW(cloud.add("y", std::vector<float>{1}), std::invalid_argument);
  EXPECT_EQ(cloud.size(), 2U);
  EXPECT_THAT(to_floats(*cloud.find("x")), ElementsAre(1, 2));
  EXPECT_EQ(cloud.find("y"), nullptr);
}

TEST(PlyBlocks, TogetherAreTheFile) {
  constexpr std::size_t kPoints = 150'000;  // two whole blocks and a part
  const TemporaryFolder folder;
  PointCloud cloud;
  std::vector<float> x(kPoints);
  std::vector<std::uint16_t> ring(kPoints);
  for (std::size_t i = 0; i < kPoints; ++i) {
    x[i] = 0.5F * static_cast<float>(i);
    ring[i] = static_cast<std::uint16_t>(i % 64);
  }
  cloud.add("x", x);
  cloud.add("ring", ring);
  write_ply(folder / "cloud.ply", cloud);
  PlyBlocks blocks(folder / "cloud.ply");
  EXPECT_EQ(blocks.size(), kPoints);
  std::vector<float> read_x;
  std::vector<std::uint16_t> read_ring;
  std::size_t count = 0;
  while (const auto block = blocks.next()) {
    const auto& block_x = values<float>(*block, "x");
    const auto& block_ring = values<std::uint16_t>(*block, "ring");
    read_x.insert(read_x.end(), block_x.begin(), block_x.end());
    read_ring.insert(read_ring.end(), block_ring.begin(), block_ring.end());
    ++count;
  }
  EXPECT_EQ(count, 3U);
  EXPECT_EQ(read_x, x);
  EXPECT_EQ(read_ring, ring);
}

TEST(PlyBlocks, SayWhatTheyCannotRead) {
  const TemporaryFolder folder;
  const auto message = [&](const std::string& text) {
    files::write_text(folder / "cloud.ply", text);
    try {
      const PlyBlocks blocks(folder / "cloud.ply");
      return std::string("it was read");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
  };
  const std::string binary = "ply\nformat binary_little_endian 1.0\n";
  EXPECT_THAT(message("ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nend_header\n"),
              HasSubstr("expected a binary PLY file"));
  EXPECT_THAT(message(binary + "element vertex 3\nproperty float x\nend_header\n12345678"),
              HasSubstr("3 points of 4 bytes"));
  EXPECT_THAT(message(binary + "element face 1\nproperty list uchar int v\nend_header\n"),
              HasSubstr("before any other element"));
  EXPECT_THROW(PlyBlocks(folder / "none.ply"), InputError);
}

}  // namespace
}  // namespace traverse::dataset
