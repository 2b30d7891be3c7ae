#include "traverse/dataset/foreign_file.hpp"

#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/files/atomic_file.hpp"

#include "dataset/made_recordings.hpp"
#include "temporary_folder.hpp"

namespace traverse::dataset {
namespace {

using ::testing::HasSubstr;
using namespace traverse::testing;  // made recordings
using namespace std::string_literals;

std::string padded(std::string bytes, std::size_t at = 0, char byte = '\0') {
  bytes.resize(300, '\0');
  if (at > 0) bytes[at] = byte;
  return bytes;
}

TEST(ForeignFile, IsToldByItsFirstBytes) {
  const std::vector<std::pair<std::string, std::string>> files{
      {padded("ASTM-E57"), "foreign_e57"},
      {padded("LASF", 104, '\x83'), "foreign_laz"},
      {padded("LASF", 104, '\x03'), "foreign_las"},
      {padded("\x10\0\0\0\x08\0\0\0OSF!"s), "foreign_osf"},
      {padded("livox_tech", 16, '\x02'), "foreign_lvx2"},
      {padded("livox_tech", 16, '\x01'), "foreign_lvx"},
      {padded("#ROSBAG V2.0\nencryptor=rosbag/AesCbcEncryptor"), "foreign_bag_encrypted"},
      {padded("#ROSBAG V1.2\n"), "foreign_bag_old"},
      {padded("Salted__"), "foreign_encrypted"},
      {padded("-----BEGIN PGP MESSAGE-----"), "foreign_encrypted"},
      {padded("age-encryption.org/v1"), "foreign_encrypted"},
      {"version https://git-lfs.github.com/spec/v1\noid sha256:0\n", "foreign_lfs_pointer"},
      {"<!DOCTYPE html><html></html>", "foreign_web_page"},
      {"<!doctype html><html></html>", "foreign_web_page"},
      {"<html><body></body></html>", "foreign_web_page"},
      {padded("#ROSRECORD V1.1\n"), "foreign_bag_old"},
      {padded("PK\x03\x04"), "foreign_archive"},
      {padded("7z\xbc\xaf\x27\x1c"), "foreign_archive"},
      {padded("Rar!\x1a\x07"), "foreign_archive"},
      {padded("\xfd\x37zXZ"), "foreign_archive"},
      {padded("\x04\x22\x4d\x18"), "foreign_archive"},
      {padded("BZh9"), "foreign_archive"},
      {padded("\x1f\x8b\x08"), "foreign_archive"},
      {std::string(257, '\1') + "ustar" + std::string(100, '\0'), "foreign_archive"},
      {padded("\x28\xb5\x2f\xfd"), "foreign_archive"},
      {padded("\x89HDF\r\n\x1a\n"), "foreign_hdf5"},
      {padded("\x93NUMPY"), "foreign_numpy"},
      {padded("ULog\x01\x12\x35"), "foreign_ulog"},
      {padded("\x89PNG\r\n\x1a\n"), "foreign_image"},
      {padded("\xff\xd8\xff"), "foreign_image"},
  };
  std::set<std::string_view> tried;
  for (const auto& [bytes, code] : files) {
    const TemporaryFolder folder;
    std::filesystem::create_directories(folder / "drive");
    files::write_text(folder / "drive/x.dat", bytes);
    const auto of_file = foreign_format(folder / "drive/x.dat");
    ASSERT_TRUE(of_file) << code;
    EXPECT_EQ(of_file->code, code);
    const auto of_folder = foreign_format(folder / "drive");
    ASSERT_TRUE(of_folder) << code;
    EXPECT_EQ(of_folder->code, code);
    EXPECT_THAT(opening_error(folder / "drive/x.dat"), HasSubstr(of_file->action)) << code;
    EXPECT_THAT(opening_error(folder / "drive"), HasSubstr(of_file->name)) << code;
    tried.insert(of_file->code);
  }
  for (const ForeignFormat& format : foreign_formats()) {
    EXPECT_TRUE(tried.contains(format.code)) << format.code << " is not tried here";
  }
}

TEST(ForeignFile, IsNoneWhereNothingIsKnown) {
  const TemporaryFolder folder;
  files::write_text(folder / "a", "anything");
  files::write_text(folder / "b", "");
  EXPECT_FALSE(foreign_format(folder / "a"));
  EXPECT_FALSE(foreign_format(folder / "b"));
  EXPECT_FALSE(foreign_format(folder / "none"));
}

TEST(ForeignFile, EachHasACodeANameAndAnAction) {
  std::set<std::string_view> codes;
  for (const ForeignFormat& format : foreign_formats()) {
    EXPECT_TRUE(format.code.starts_with("foreign_"));
    EXPECT_TRUE(codes.insert(format.code).second) << format.code;
    EXPECT_FALSE(format.name.empty() || format.action.empty()) << format.code;
  }
}

}  // namespace
}  // namespace traverse::dataset
