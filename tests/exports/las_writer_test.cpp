#include "traverse/exports/las_writer.hpp"

#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "traverse/files/binary_file.hpp"

#include "temporary_folder.hpp"

namespace traverse::exports {
namespace {

/// Values of a file at their places as the specification counts them.
class FileBytes {
 public:
  explicit FileBytes(const std::filesystem::path& file) : bytes_(files::read_bytes(file)) {}
  template <typename T>
  T at(std::size_t offset) const {
    T value{};
    std::memcpy(&value, bytes_.data() + offset, sizeof value);
    return value;
  }
  std::string text(std::size_t offset, std::size_t length) const {
    return {reinterpret_cast<const char*>(bytes_.data()) + offset, length};
  }
  std::size_t size() const { return bytes_.size(); }

 private:
  std::vector<std::byte> bytes_;
};

LasDescription description() {
  LasDescription d;
  d.wkt = R"(LOCAL_CS["here"])";
  d.offset_m = {691000, 5330000, 500};
  d.generated_by = "a test";
  d.year = 2026;
  d.day_of_year = 335;
  return d;
}

TEST(LasWriter, WritesHeaderCoordinateSystemAndPoints) {
  const testing::TemporaryFolder folder;
  LasWriter writer(folder / "map.las", description());
  LasPoint first;
  first.position = {691012.3456, 5329990.001, 520.25};
  first.time_s = 384'035'218.123456;
  first.intensity = 65535;
  first.source = 2;
  first.user_data = 63;
  LasPoint second;
  second.position = {690999, 5330001, 499.5};
  writer.add(first);
  writer.add(second);
  writer.commit();

  const FileBytes file(folder / "map.las");
  EXPECT_EQ(file.text(0, 4), "LASF");
  EXPECT_EQ(file.at<std::uint16_t>(6), 17);  // adjusted standard GPS time, WKT
  EXPECT_EQ(file.at<std::uint8_t>(24), 1);
  EXPECT_EQ(file.at<std::uint8_t>(25), 4);
  EXPECT_EQ(file.at<std::uint16_t>(90), 335);
  EXPECT_EQ(file.at<std::uint16_t>(92), 2026);
  EXPECT_EQ(file.at<std::uint16_t>(94), 375);
  const auto points_at = file.at<std::uint32_t>(96);
  EXPECT_EQ(file.at<std::uint8_t>(104), 6);
  EXPECT_EQ(file.at<std::uint16_t>(105), 30);
  EXPECT_EQ(file.at<std::uint32_t>(107), 0U);  // the number of 32 bits belongs to older formats
  EXPECT_DOUBLE_EQ(file.at<double>(131), 0.001);
  EXPECT_DOUBLE_EQ(file.at<double>(163), 5330000);
  EXPECT_NEAR(file.at<double>(179), 691012.346, 1e-6);  // highest x, then lowest
  EXPECT_NEAR(file.at<double>(187), 690999, 1e-6);
  EXPECT_NEAR(file.at<double>(219), 499.5, 1e-6);  // lowest z
  EXPECT_EQ(file.at<std::uint64_t>(247), 2U);
  EXPECT_EQ(file.at<std::uint64_t>(255), 2U);

  EXPECT_EQ(file.text(377, 15), "LASF_Projection");
  EXPECT_EQ(file.at<std::uint16_t>(393), 2112);
  EXPECT_EQ(file.at<std::uint16_t>(395), description().wkt.size() + 1);
  EXPECT_EQ(file.text(429, points_at - 430), description().wkt);

  ASSERT_EQ(file.size(), points_at + 2 * 30);
  EXPECT_EQ(file.at<std::int32_t>(points_at), 12346);
  EXPECT_EQ(file.at<std::int32_t>(points_at + 4), -9999);
  EXPECT_EQ(file.at<std::int32_t>(points_at + 8), 20250);
  EXPECT_EQ(file.at<std::uint16_t>(points_at + 12), 65535);
  EXPECT_EQ(file.at<std::uint8_t>(points_at + 14), 0x11);  // first of one return
  EXPECT_EQ(file.at<std::uint8_t>(points_at + 17), 63);
  EXPECT_EQ(file.at<std::uint16_t>(points_at + 20), 2);
  EXPECT_DOUBLE_EQ(file.at<double>(points_at + 22), 384'035'218.123456);
}

TEST(LasWriter, WritesMoreThanItsBufferHolds) {
  constexpr int kPoints = 100'000;
  const testing::TemporaryFolder folder;
  LasWriter writer(folder / "map.las", description());
  for (int k = 0; k < kPoints; ++k) {
    LasPoint point;
    point.position = description().offset_m + Eigen::Vector3d(0.001 * k, 0, 0);
    writer.add(point);
  }
  EXPECT_EQ(writer.size(), kPoints);
  writer.commit();
  const FileBytes file(folder / "map.las");
  const auto points_at = file.at<std::uint32_t>(96);
  ASSERT_EQ(file.size(), points_at + kPoints * 30U);
  for (int k = 0; k < kPoints; k += 997) {
    EXPECT_EQ(file.at<std::int32_t>(points_at + static_cast<std::size_t>(k) * 30), k);
  }
}

TEST(LasWriter, RefusesWhatItCannotHoldAndLeavesNothing) {
  const testing::TemporaryFolder folder;
  {
    LasWriter writer(folder / "map.las", description());
    LasPoint far;
    far.position = {3e6, 0, 0};
    EXPECT_THROW(writer.add(far), std::out_of_range);
    far.position.setConstant(std::numeric_limits<double>::quiet_NaN());
    EXPECT_THROW(writer.add(far), std::out_of_range);
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace traverse::exports
