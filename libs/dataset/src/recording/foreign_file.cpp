#include "traverse/dataset/foreign_file.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <fstream>
#include <string>
#include <system_error>
#include <vector>

namespace traverse::dataset {

namespace {

namespace fs = std::filesystem;
using std::string_view_literals::operator""sv;

constexpr std::size_t kBytesLookedAt = 512;

constexpr std::array kForeign{
    ForeignFormat{"foreign_e57", "E57, a point cloud of a laser scanner",
                  "pdal translate SCAN.e57 SCAN.ply, one file for each scan"},
    ForeignFormat{"foreign_laz", "LAZ, a compressed LAS point cloud",
                  "pdal translate CLOUD.laz CLOUD.ply, one file for each scan"},
    ForeignFormat{"foreign_las", "LAS, a point cloud of a survey",
                  "pdal translate CLOUD.las CLOUD.ply, one file for each scan"},
    ForeignFormat{"foreign_osf", "OSF, a recording of Ouster's SDK",
                  "ouster-cli source DRIVE.osf save --prefix DRIVE .pcd, then open the folder"},
    ForeignFormat{"foreign_lvx2", "LVX2, a recording of Livox Viewer 2",
                  "export PCD files from Livox Viewer 2, one for each frame"},
    ForeignFormat{"foreign_lvx", "LVX, a recording of Livox Viewer",
                  "export PCD files from Livox Viewer, one for each frame"},
    ForeignFormat{"foreign_bag_encrypted", "an encrypted ROS 1 bag",
                  "decrypt it with rosbag where its key is: rosbag decrypt DRIVE.bag"},
    ForeignFormat{"foreign_bag_old", "a ROS bag before version 2.0",
                  "rosbag migrate OLD.bag NEW.bag"},
    ForeignFormat{"foreign_encrypted", "an encrypted file",
                  "decrypt it with the key of whoever made it, and open the result"},
    ForeignFormat{"foreign_lfs_pointer", "a pointer of Git LFS in place of the file",
                  "git lfs pull, in the repository that it is of"},
    ForeignFormat{"foreign_web_page", "a web page, not what was to be downloaded",
                  "download it again, after signing in where the page asks for it"},
    ForeignFormat{"foreign_archive", "an archive or compressed file",
                  "unpack it and open what was in it"},
    ForeignFormat{"foreign_hdf5", "an HDF5 file",
                  "write its scans as PLY files and its other tables as CSV, and open the folder"},
    ForeignFormat{
        "foreign_numpy", "a NumPy array",
        "write it with array.astype('float32').tofile('000000.bin'), one file for each scan"},
    ForeignFormat{"foreign_ulog", "a ULog of PX4",
                  "ulog2csv FLIGHT.ulg, then name files and columns under csv"},
    ForeignFormat{"foreign_image", "a picture", "open the folder that holds the scans"},
};

const ForeignFormat* named(std::string_view code) {
  const auto found = std::find_if(kForeign.begin(), kForeign.end(),
                                  [&](const ForeignFormat& format) { return format.code == code; });
  return found == kForeign.end() ? nullptr : &*found;
}

constexpr std::string_view kEncryptedBag = "foreign_bag_encrypted";

struct Signature {
  std::size_t offset;
  std::string_view bytes;
  std::string_view code;
};

constexpr std::array kSignatures{
    Signature{0, "ASTM-E57"sv, "foreign_e57"},
    Signature{8, "OSF!"sv, "foreign_osf"},
    Signature{0, "#ROSBAG V2.0"sv, kEncryptedBag},
    Signature{0, "#ROSBAG V1"sv, "foreign_bag_old"},
    Signature{0, "#ROSRECORD"sv, "foreign_bag_old"},
    Signature{0, "Salted__"sv, "foreign_encrypted"},
    Signature{0, "-----BEGIN PGP MESSAGE"sv, "foreign_encrypted"},
    Signature{0, "age-encryption.org/"sv, "foreign_encrypted"},
    Signature{0, "version https://git-lfs"sv, "foreign_lfs_pointer"},
    Signature{0, "<!DOCTYPE html"sv, "foreign_web_page"},
    Signature{0, "<!doctype html"sv, "foreign_web_page"},
    Signature{0, "<html"sv, "foreign_web_page"},
    Signature{0, "PK\x03\x04"sv, "foreign_archive"},
    Signature{0, "7z\xbc\xaf\x27\x1c"sv, "foreign_archive"},
    Signature{0, "Rar!\x1a\x07"sv, "foreign_archive"},
    Signature{0, "\xfd\x37zXZ\0"sv, "foreign_archive"},
    Signature{0, "\x28\xb5\x2f\xfd"sv, "foreign_archive"},
    Signature{0, "\x04\x22\x4d\x18"sv, "foreign_archive"},
    Signature{0, "BZh"sv, "foreign_archive"},
    Signature{0, "\x1f\x8b"sv, "foreign_archive"},
    Signature{257, "ustar"sv, "foreign_archive"},
    Signature{0, "\x89HDF\r\n\x1a\n"sv, "foreign_hdf5"},
    Signature{0, "\x93NUMPY"sv, "foreign_numpy"},
    Signature{0, "ULog\x01\x12\x35"sv, "foreign_ulog"},
    Signature{0, "\x89PNG\r\n\x1a\n"sv, "foreign_image"},
    Signature{0, "\xff\xd8\xff"sv, "foreign_image"},
};

/// LAS and LAZ, and Livox's two, differ by one byte further on.
std::string_view code_of(std::string_view start) {
  const auto byte = [&](std::size_t at) {
    return at < start.size() ? static_cast<unsigned char>(start[at]) : 0U;
  };
  constexpr std::size_t kLasPointFormat = 104;  // ASPRS, "LAS specification 1.4", table 3
  constexpr std::size_t kLivoxVersion = 16;     // Livox, "LVX specification", public header
  if (start.starts_with("LASF")) {
    return (byte(kLasPointFormat) & 0xC0U) != 0 ? "foreign_laz" : "foreign_las";
  }
  if (start.starts_with("livox_tech")) {
    return byte(kLivoxVersion) >= 2 ? "foreign_lvx2" : "foreign_lvx";
  }
  for (const Signature& signature : kSignatures) {
    if (start.size() < signature.offset) continue;
    if (!start.substr(signature.offset).starts_with(signature.bytes)) continue;
    const bool is_readable = signature.code == kEncryptedBag &&
                             start.find("encryptor=rosbag/") == std::string_view::npos;
    return is_readable ? std::string_view() : signature.code;
  }
  return {};
}

std::string first_bytes(const fs::path& file) {
  std::string bytes(kBytesLookedAt, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(stream.gcount(), 0)));
  return bytes;
}

std::optional<ForeignFormat> format_of_file(const fs::path& file) {
  const std::string start = first_bytes(file);
  if (const ForeignFormat* format = named(code_of(start))) return *format;
  return std::nullopt;
}

}  // namespace

std::span<const ForeignFormat> foreign_formats() { return kForeign; }

std::optional<ForeignFormat> foreign_format(const fs::path& path) {
  std::error_code failure;
  if (fs::is_regular_file(path, failure)) return format_of_file(path);
  if (!fs::is_directory(path, failure)) return std::nullopt;
  constexpr std::size_t kMostFiles = 1000;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(path, failure)) {
    if (entry.is_regular_file(failure)) files.push_back(entry.path());
    if (files.size() == kMostFiles) break;
  }
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) {
    if (auto format = format_of_file(file)) return format;
  }
  return std::nullopt;
}

}  // namespace traverse::dataset
